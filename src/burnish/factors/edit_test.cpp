// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/edit.h>
#include <burnish/fitting/fit.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/albedo.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/testing/files.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

FactoredBrdf model() {
  return random_model(kEverything, kEverySize, 3, TableFormat::half);
}

TEST(Edit, ChangesNothingByDefault) {
  EXPECT_EQ(edited(model(), {}), model());
}

TEST(Edit, KeepsReciprocity) {
  EXPECT_TRUE(edited(model(), {.hue = {1}, .roughness = 1.5}).reciprocal());
}

// The mean of directional albedos for light from within 60 degrees of the normal, one a channel.
std::vector<double> mean_albedo(const FactoredBrdf& model) {
  const int count = 25;
  std::vector<double> mean(model.channels());
  for (int i = 0; i < count; ++i) {
    const Vec3 wi = spherical_direction(std::acos(std::sqrt(1 - 0.75 * (i + 0.5) / count)), i);
    const DirectionalAlbedo at = directional_albedo(model, wi);
    for (std::size_t c = 0; c < mean.size(); ++c) mean[c] += at.albedo[c] / count;
  }
  return mean;
}

double mean_of(const std::vector<double>& rgb) {
  return (rgb[0] + rgb[1] + rgb[2]) / 3;
}

// A highlight and a Lambertian part whose scales say nothing of their colours: the highlight's table is 1 in every
// channel somewhere, in green and blue over all of its wide lobe, in red at one node beyond it.
FactoredBrdf unequal() {
  Table table{.name = "q", .layout = {.width = 33}, .channels = 3};
  for (int x = 0; x < 33; ++x) {
    const float wide = std::exp(-0.02F * static_cast<float>(x * x));
    table.values.insert(table.values.end(), {x == 32 ? 1 : 0x1p-19F * wide, wide, wide});
  }
  return {3,
          {table},
          {{.scale = {0x1p19 * 0.12, 0.03, 0.04}, .factors = {{.projection = kProjectHalf}}},
           {.scale = {0.03, 0.06, 0.02}, .factors = {}}}};
}

FactoredBrdf lobe_of(const FactoredBrdf& model, std::size_t l) {
  return {model.channels(), {model.tables().begin(), model.tables().end()}, {model.lobes()[l]}};
}

TEST(Edit, TurnsTheColourThatALobeReflects) {
  const FactoredBrdf before = unequal(), after = edited(before, {.hue = {2 * kPi / 3}});
  for (std::size_t l = 0; l < 2; ++l) {
    // a third of a turn hands each channel's colour to the next
    const std::vector<double> was = mean_albedo(lobe_of(before, l)), is = mean_albedo(lobe_of(after, l));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(is[c] / was[(c + 2) % 3], 1, 0.02) << l;
  }
}

TEST(Edit, KeepsTheMeanOfTheColour) {
  const FactoredBrdf before = unequal();
  const double mean = mean_of(mean_albedo(before));
  for (const double deg : {-170, -54, 10, 54, 120, 180, 300}) {
    const FactoredBrdf after = edited(before, {.hue = {radians(deg)}});
    EXPECT_NEAR(mean_of(mean_albedo(after)) / mean, 1, 0.02) << deg;
    for (const Lobe& lobe : after.lobes())
      for (const double s : lobe.scale) EXPECT_GE(s, 0) << deg;
  }
}

TEST(Edit, ComesBackAfterAWholeTurn) {
  const FactoredBrdf before = unequal(), after = edited(before, {.hue = {2 * kPi}});
  for (std::size_t l = 0; l < 2; ++l)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(after.lobes()[l].scale[c] / before.lobes()[l].scale[c], 1, 1e-12);
}

TEST(Edit, PalesWhatWouldLeaveTheRange) {
  const auto turned = [](std::vector<double> albedo, double deg) {
    for (double& a : albedo) a /= kPi;
    std::vector<double> scale =
        edited({3, {}, {{.scale = albedo, .factors = {}}}}, {.hue = {radians(deg)}}).lobes()[0].scale;
    for (double& s : scale) s *= kPi;
    return scale;
  };
  using testing::DoubleNear, testing::ElementsAre;
  const auto near = [](double v) { return DoubleNear(v, 0.005); };
  EXPECT_THAT(turned({0.6, 0, 0}, 60), ElementsAre(near(0.3), near(0.3), near(0)));
  EXPECT_THAT(turned({0.9, 0.9, 0}, 60), ElementsAre(near(0.4), near(1), near(0.4)));
  EXPECT_THAT(turned({0, 0, 0}, 60), ElementsAre(0, 0, 0));
}

TEST(Edit, TurnsEachLobeByItsOwn) {
  const FactoredBrdf before = unequal();
  EXPECT_EQ(edited(before, {.hue = {0, 0}}), before);
  const FactoredBrdf after = edited(before, {.hue = {0, 1}}), all = edited(before, {.hue = {1}});
  EXPECT_EQ(after.lobes()[0], before.lobes()[0]);
  EXPECT_EQ(after.lobes()[1], all.lobes()[1]);
}

TEST(Edit, TurnsAMeasuredPaint) {
  BURNISH_NEEDS_DATA();
  const FactoredBrdf before =
      std::get<FactoredBrdf>(fit(open_source((data_folder() / "cornell/cayman.brdf").string(), {}), {}).brdf);
  const double mean = mean_of(mean_albedo(before));
  for (const double deg : {-54, 54, 180}) {
    const FactoredBrdf after = edited(before, {.hue = {radians(deg)}});
    EXPECT_NEAR(mean_of(mean_albedo(after)) / mean, 1, 0.05) << deg;
    for (const AlbedoAt& at : albedo_curve(after, std::array{0.0, 0.5}))
      for (const double a : at.albedo.albedo) EXPECT_LT(a, 0.15) << deg;  // before at most 0.085
  }
  EXPECT_NEAR(mean_of(mean_albedo(edited(before, {.hue = {kTwoPi}}))) / mean, 1, 1e-9);
}

// A table of exp(-t / 0.2), t = tan(theta_h / 2), which between nodes is a line in its logarithm.
TEST(Edit, WidensHighlights) {
  for (const TableShape shape : {TableShape::line, TableShape::disk}) {
    const int side = 65;
    Table table{.name = "q", .layout = {.shape = shape, .width = side}, .channels = 1};
    if (shape == TableShape::disk) table.layout.height = side;
    for (int y = 0; y < table.layout.height; ++y)
      for (int x = 0; x < side; ++x)
        table.values.push_back(
            static_cast<float>(std::exp(-tan_half_theta(node_direction(table.layout, x, y)) / 0.2)));
    const FactoredBrdf before(1, {table}, {{.scale = {1}, .factors = {{.projection = kProjectHalf}}}});
    const FactoredBrdf after = edited(before, {.roughness = 2});
    for (const double theta_h : {0.0, 0.2, 0.5, 0.9}) {
      const auto [wi, wo] =
          from_half_diff({.theta_h = theta_h, .phi_h = 0.7, .theta_d = 0.3, .phi_d = kHalfPi});
      double f = 0;
      after.eval(wi, wo, {&f, 1});
      EXPECT_NEAR(f / std::exp(-std::tan(theta_h / 2) / 0.4), 1, 0.03) << to_string(shape);
    }
  }
}

TEST(Edit, RefusesWhatIsOutOfRange) {
  EXPECT_THROW(edited(model(), {.roughness = 0.01}), Error);
  EXPECT_THROW(edited(model(), {.roughness = std::nan("")}), Error);
  EXPECT_THROW(edited(model(), {.hue = {std::nan("")}}), Error);
  EXPECT_THROW(edited(unequal(), {.hue = {1, 2, 3}}), Error);
  EXPECT_THROW(edited(random_model("a(wi) a(wo)", {}, 1, TableFormat::half), {.hue = {1}}), Error);
}

}  // namespace
}  // namespace burnish
