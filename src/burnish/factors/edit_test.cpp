#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/factors/edit.h>
#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>
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
  EXPECT_TRUE(edited(model(), {.hue = 1, .roughness = 1.5}).reciprocal());
}

TEST(Edit, TurnsColoursAboutGrey) {
  const FactoredBrdf grey = random_model("a(theta_d)", {"a=5,shared"}, 3, TableFormat::single);
  const FactoredBrdf red(3, {grey.tables()[0]}, {{.scale = {3, 1, 1}, .factors = grey.lobes()[0].factors}});
  const FactoredBrdf green = edited(red, {.hue = 2 * kPi / 3}), back = edited(red, {.hue = 2 * kPi});
  const auto scale = [](const FactoredBrdf& f) { return f.lobes()[0].scale; };
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(scale(green)[c], scale(red)[(c + 2) % 3], 1e-5);
    EXPECT_NEAR(scale(back)[c], scale(red)[c], 1e-5);
  }
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
  EXPECT_THROW(edited(random_model("a(wi) a(wo)", {}, 1, TableFormat::half), {.hue = 1}), Error);
}

}  // namespace
}  // namespace burnish
