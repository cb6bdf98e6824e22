// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/rgl_table.h>
#include <burnish/testing/directions.h>
#include <burnish/testing/sampling.h>

namespace burnish {
namespace {

constexpr double kNdf = 0.7, kSigma = 0.4;

/// A table with uniform distributions whose spectra are value(slice's phi_i index, theta_i index).
RglData uniform_data(std::vector<float> phi_i, const std::function<float(int, int)>& value) {
  RglData data;
  data.channels = 1;
  data.phi_i = std::move(phi_i);
  data.theta_i = {0, 0.5f, 1.0f, 1.5f};
  data.ndf = {2, 2, std::vector<float>(4, static_cast<float>(kNdf))};
  data.sigma = {2, 2, std::vector<float>(4, static_cast<float>(kSigma))};
  const int phis = static_cast<int>(data.phi_i.size()), thetas = static_cast<int>(data.theta_i.size());
  data.vndf = {3, 3, std::vector<float>(static_cast<std::size_t>(9 * phis * thetas), 1)};
  data.luminance = data.spectra = {2, 2, {}};
  for (int p = 0; p < phis; ++p)
    for (int t = 0; t < thetas; ++t) data.spectra.values.insert(data.spectra.values.end(), 4, value(p, t));
  data.luminance.values = data.spectra.values;
  return data;
}

/// Spectra that differ at every node.
RglData random_data(std::vector<float> phi_i, std::uint64_t seed) {
  RglData data = uniform_data(std::move(phi_i), [](int, int) { return 0.0f; });
  Pcg32 random(seed);
  for (RglGrid* grid : {&data.ndf, &data.sigma, &data.vndf, &data.spectra})
    for (float& value : grid->values) value = static_cast<float>(0.1 + random.uniform());
  return data;
}

double value_of(const RglTable& table, Vec3 wi, Vec3 wo) {
  double f = -1;
  EXPECT_TRUE(table.eval(wi, wo, {&f, 1}));
  return f;
}

float pi_times(double factor) {
  return static_cast<float>(kPi * factor);
}

Vec3 rotated(Vec3 w, double angle) {
  return {w.x * std::cos(angle) - w.y * std::sin(angle), w.x * std::sin(angle) + w.y * std::cos(angle), w.z};
}

TEST(RglTable, UniformTablesGiveTheFormulaInterpolatedInTheta) {
  RglData data = uniform_data({0}, [](int, int t) { return static_cast<float>(1 + t); });
  for (bool jacobian : {true, false}) {
    data.jacobian = jacobian;
    const RglTable table(data);
    for (double theta : {0.0, 0.25, 0.5, 0.8, 1.3, 1.5, 1.55}) {
      const Vec3 wi = spherical_direction(theta, 0.3), wo = spherical_direction(0.6, 2);
      const double spectra = 1 + std::min(theta / 0.5, 3.0);
      const double expected = spectra / wo.z * (jacobian ? kNdf / (4 * kSigma) : 1);
      EXPECT_NEAR(value_of(table, wi, wo) / expected, 1, 1e-6) << theta;
    }
  }
}

TEST(RglTable, IsotropicTablesDoNotFeelRotation) {
  const RglTable table(random_data({0}, 1));
  EXPECT_TRUE(table.isotropic());
  EXPECT_TRUE(RglTable(random_data({0, 1}, 1)).isotropic());
  Pcg32 random(2);
  for (int i = 0; i < 500; ++i) {
    const Vec3 wi = random_upper_direction(random), wo = random_upper_direction(random);
    const double turn = random.uniform() * kTwoPi, f = value_of(table, wi, wo);
    EXPECT_NEAR(value_of(table, rotated(wi, turn), rotated(wo, turn)) / f, 1, 1e-9);
  }
}

TEST(RglTable, MirrorDirectionsDoNotFeelRounding) {
  Pcg32 random(3);
  for (const auto& phi_i : {std::vector<float>{0}, std::vector<float>{pi_times(-1), 0, pi_times(1)}}) {
    const RglTable table(random_data(phi_i, 2));
    for (int i = 0; i < 200; ++i) {
      // the half vector is the normal, where rows of all azimuths end
      const Vec3 wi = spherical_direction(1.4 * random.uniform(), kTwoPi * random.uniform()), wo = mirror(wi);
      const auto rounded = [&](Vec3 w) {
        for (double* x : {&w.x, &w.y}) *x += 3e-16 * (random.uniform() - 0.5);
        return w;
      };
      EXPECT_NEAR(value_of(table, rounded(wi), rounded(wo)) / value_of(table, wi, wo), 1, 1e-6);
    }
  }
}

TEST(RglTable, AnisotropicTablesInterpolateInPhi) {
  // Nodes at -pi, -pi/2, 0, pi/2, pi with the values 1, 2, 3, 2, 1.
  const auto value = [](int p, int) { return static_cast<float>(3 - std::abs(p - 2)); };
  const RglTable table(uniform_data({pi_times(-1), pi_times(-0.5), 0, pi_times(0.5), pi_times(1)}, value));
  EXPECT_EQ(table.reduction(), 1);
  const Vec3 wo = spherical_direction(0.4, 1);
  const double scale = kNdf / (4 * kSigma) / wo.z;
  for (double turns = -1; turns <= 1; turns += 0.0625) {
    const double phi = turns * kPi;
    EXPECT_NEAR(value_of(table, spherical_direction(0.7, phi), wo) / scale, 3 - 2 * std::abs(turns), 1e-5);
  }
}

TEST(RglTable, TheCircleClosesWhereTheLastNodeIsMissing) {
  const auto value = [](int p, int) { return static_cast<float>(p + 1); };
  const RglTable table(uniform_data({pi_times(-1), pi_times(-0.5), 0, pi_times(0.5)}, value));
  EXPECT_EQ(table.reduction(), 1);
  const Vec3 wo = spherical_direction(0.4, 1);
  const double scale = kNdf / (4 * kSigma) / wo.z;
  EXPECT_NEAR(value_of(table, spherical_direction(0.7, 0.75 * kPi), wo) / scale, 2.5, 1e-5);  // 4 and 1
  EXPECT_NEAR(value_of(table, spherical_direction(0.7, kPi - 1e-9), wo) / scale, 1, 1e-5);
}

TEST(RglTable, HalfCirclesAreCompletedByRotation) {
  const RglTable table(random_data({pi_times(-1), pi_times(-0.6), pi_times(-0.3), 0}, 3));
  EXPECT_EQ(table.reduction(), 2);
  Pcg32 random(4);
  for (int i = 0; i < 500; ++i) {
    const Vec3 wi = random_upper_direction(random), wo = random_upper_direction(random);
    EXPECT_NEAR(value_of(table, mirror(wi), mirror(wo)) / value_of(table, wi, wo), 1, 1e-9);
  }
  // The stored half is the lower one: there the last node, phi_i = 0, is reached without rotation.
  const auto value = [](int p, int) { return static_cast<float>(p + 1); };
  const RglTable steps(uniform_data({pi_times(-1), pi_times(-0.5), 0}, value));
  const Vec3 wo = spherical_direction(0.4, 1);
  const double scale = kNdf / (4 * kSigma) / wo.z;
  EXPECT_NEAR(value_of(steps, spherical_direction(0.7, -0.001), wo) / scale, 3, 1e-2);
  EXPECT_NEAR(value_of(steps, spherical_direction(0.7, -0.5 * kPi), wo) / scale, 2, 1e-5);
  EXPECT_NEAR(value_of(steps, spherical_direction(0.7, 0.001), wo) / scale, 1, 1e-2);
  EXPECT_NEAR(value_of(steps, spherical_direction(0.7, 0.5 * kPi), wo) / scale, 2, 1e-5);
}

TEST(RglTable, QuarterCirclesAreCompletedByMirrors) {
  for (double first : {-1.0, -0.5, 0.0, 0.5}) {
    const RglTable table(random_data({pi_times(first), pi_times(first + 0.2), pi_times(first + 0.5)}, 5));
    EXPECT_EQ(table.reduction(), 4);
    Pcg32 random(6);
    for (int i = 0; i < 200; ++i) {
      const Vec3 wi = random_upper_direction(random), wo = random_upper_direction(random);
      const double f = value_of(table, wi, wo);
      EXPECT_NEAR(value_of(table, {-wi.x, wi.y, wi.z}, {-wo.x, wo.y, wo.z}) / f, 1, 1e-9);
      EXPECT_NEAR(value_of(table, {wi.x, -wi.y, wi.z}, {wo.x, -wo.y, wo.z}) / f, 1, 1e-9);
    }
    // Within the stored quarter nothing is mirrored.
    const auto value = [](int p, int) { return static_cast<float>(p + 1); };
    const RglTable steps(
        uniform_data({pi_times(first), pi_times(first + 0.25), pi_times(first + 0.5)}, value));
    const Vec3 wo = spherical_direction(0.4, 1);
    EXPECT_NEAR(
        value_of(steps, spherical_direction(0.7, (first + 0.125) * kPi), wo) / (kNdf / (4 * kSigma) / wo.z),
        1.5, 1e-5);
  }
}

TEST(RglTable, CornersAreFiniteAndBelowTheHorizonIsBlack) {
  for (const auto& phi_i : {std::vector<float>{0},
                            {pi_times(-1), pi_times(-0.5), 0},
                            {pi_times(-1), pi_times(-0.75), pi_times(-0.5)}}) {
    RglData data = random_data(phi_i, 7);
    data.sigma.values.assign(4, 0);  // nothing divides by it
    const RglTable table(data);
    const Vec3 n{0, 0, 1}, x{1, 0, 0}, grazing = normalize({0.3, -1, 1e-300}), low = normalize({1, 0, -0.1});
    for (Vec3 wi : {n, grazing, normalize({-1, 0, 1e-12}), normalize({-1, -0.0, 1})})
      for (Vec3 wo : {n, grazing, normalize({1, 0, 1e-12}), normalize({1, 0, 1})}) {
        const double f = value_of(table, wi, wo);
        EXPECT_TRUE(std::isfinite(f) && f >= 0) << f;
      }
    for (Vec3 w : {x, low}) {
      EXPECT_EQ(value_of(table, n, w), 0);
      EXPECT_EQ(value_of(table, w, n), 0);
    }
  }
}

TEST(RglTable, NodesAreReadBackAtTheirDirections) {
  RglData data = random_data({0}, 8);
  data.spectra = {5, 4, {}};
  for (int i = 0; i < 4 * 5 * 4; ++i) data.spectra.values.push_back(static_cast<float>(1 + i % 17));
  data.luminance = data.spectra;
  const RglTable table(data);
  int above = 0;
  for (int t = 0; t < 4; ++t)
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 5; ++column) {
        const auto [wi, wo] = table.node_directions(0, t, row, column);
        EXPECT_NEAR(theta_of(wi), static_cast<double>(data.theta_i[static_cast<std::size_t>(t)]), 1e-6);
        EXPECT_NEAR(length(wo), 1, 1e-12);
        if (t == 0 || column == 0 || wo.z < 1e-3) continue;  // on the normal the rows fall together
        ++above;
        const Vec3 h = half_vector(wi, wo);
        const double ndf = rgl_lookup(data.ndf, rgl_square(theta_of(h), std::atan2(h.y, h.x)));
        const double sigma = rgl_lookup(data.sigma, rgl_square(theta_of(wi), 0));
        const auto node = static_cast<std::size_t>((t * 4 + row) * 5 + column);
        EXPECT_NEAR(value_of(table, wi, wo) * wo.z * 4 * sigma / ndf,
                    static_cast<double>(data.spectra.values[node]), 1e-3);
      }
  EXPECT_GT(above, 15);
}

TEST(RglTable, InterpolatesNegativeNodesAndCutsTheResult) {
  const auto table_of = [](float second) {
    return RglTable(uniform_data({0}, [=](int, int t) { return t == 1 ? second : 1.0f; }));
  };
  const RglTable negative = table_of(-1), zero = table_of(0);
  const Vec3 wo = spherical_direction(0.2, 0);
  int cut = 0, positive = 0;
  for (double theta = 0; theta < 1; theta += 0.05) {
    const Vec3 wi = spherical_direction(theta, 0);
    double raw, f;
    ASSERT_TRUE(negative.eval_raw(wi, wo, {&raw, 1}));
    ASSERT_TRUE(negative.eval(wi, wo, {&f, 1}));
    EXPECT_EQ(f, std::max(raw, 0.0));
    cut += raw < 0;
    // beside the node it is below what a node of zero would leave
    positive += raw > 0 && f < 0.999 * value_of(zero, wi, wo);
  }
  EXPECT_GT(cut, 2);
  EXPECT_GT(positive, 2);
}

TEST(RglTable, ImpossibleDataThrow) {
  const auto throws = [](const std::function<void(RglData&)>& change, std::vector<float> phi_i = {0}) {
    RglData data = random_data(std::move(phi_i), 9);
    change(data);
    EXPECT_THROW(RglTable{std::move(data)}, Error);
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  throws([](RglData& d) { d.channels = 0; });
  throws([](RglData& d) { d.channels = 2; });
  throws([](RglData& d) { d.lambda_nm = {500, 600}; });
  throws([](RglData& d) { d.lambda_nm = {-500}; });
  throws([](RglData& d) { d.theta_i = {}; });
  throws([](RglData& d) { d.theta_i[1] = d.theta_i[0]; });
  throws([](RglData& d) { d.theta_i[3] = 0.9f; });
  throws([](RglData& d) { d.theta_i[3] = 1.6f; });
  throws([](RglData& d) { d.theta_i[0] = -0.1f; });
  throws([=](RglData& d) { d.theta_i[2] = kNan; });
  throws([=](RglData& d) { d.phi_i[0] = kInf; });
  throws([](RglData& d) { d.ndf.values.pop_back(); });
  throws([](RglData& d) { d.ndf = {1, 4, {1, 1, 1, 1}}; });
  throws([](RglData& d) { d.ndf.values[0] = -1; });
  throws([=](RglData& d) { d.sigma.values[0] = kNan; });
  throws([](RglData& d) { d.sigma.values.clear(); });
  throws([=](RglData& d) { d.vndf.values[5] = kInf; });
  throws([](RglData& d) { d.vndf.values[5] = -1; });
  throws([](RglData& d) { d.vndf.height = 2; });
  throws([](RglData& d) { std::fill_n(d.vndf.values.begin(), 9, 0.0f); });
  throws([=](RglData& d) { d.spectra.values[3] = kNan; });
  throws([](RglData& d) { d.spectra.values.push_back(1); });
  throws([=](RglData& d) { d.luminance.values[3] = kInf; });
  throws([](RglData&) {}, {-1, 0, 1});                                             // a third of the circle
  throws([](RglData&) {}, {-4, 0, 4});                                             // more than the circle
  throws([](RglData&) {}, {0.1f, 0.8f, 0.1f + pi_times(0.5)});                     // no quarter between axes
  throws([](RglData&) {}, {0, std::numeric_limits<float>::denorm_min(), 1e-30f});  // nearly nothing
}

TEST(RglTable, DrawsByItsDensity) {
  std::uint64_t seed = 0;
  for (const auto& phi_i : {std::vector<float>{0},
                            {0, pi_times(1)},
                            {0, pi_times(0.25), pi_times(0.5)},
                            {pi_times(-1), pi_times(0), pi_times(1)}}) {
    RglData data = random_data(phi_i, ++seed);
    Pcg32 random(seed);
    for (float& value : data.luminance.values) value = static_cast<float>(0.1 + random.uniform());
    for (std::size_t i = 0; i < data.vndf.values.size(); i += 3) data.vndf.values[i] = 0;  // no pole at h = n
    const RglTable table(data);
    for (const double theta : {0.0, 0.4, 1.2, 1.5}) {
      const DrawTest test = test_draws(RglSampler{&table}, spherical_direction(theta, 2), 20'000, ++seed);
      EXPECT_GT(test.p_value, level_of_each(0.01, 16)) << theta;
      EXPECT_LT(test.integral, 1.002);
    }
  }
}

TEST(RglTable, TellsTheDensityThatItDrawsBy) {
  const RglTable table(random_data({0, pi_times(0.5), pi_times(1)}, 5));
  Pcg32 random(6);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 wi = random_upper_direction(random);
    const double x = random.uniform();
    const DrawnDirection drawn = table.sample_wo(wi, {x, random.uniform()});
    if (drawn.pdf == 0) continue;
    EXPECT_NEAR(table.pdf_wo(wi, drawn.wi) / drawn.pdf, 1, 1e-3);
  }
}

TEST(RglTable, DrawsFromDarkAndNegativeLuminanceToo) {
  RglData data = uniform_data({0}, [](int, int t) { return t == 1 ? 0.0f : -1.0f + static_cast<float>(t); });
  const RglTable table(data);
  for (const double theta : {0.0, 0.5, 1.5})
    EXPECT_GT(table.sample_wo(spherical_direction(theta, 1), {0.3, 0.4}).pdf, 0);
}

}  // namespace
}  // namespace burnish
