// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/reflectance/angle_table.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {
namespace {

/// A table of g(axis angles), one channel.
template <class F>
void fill(AngleTable& table, const F& g) {
  table.values.clear();
  for (const double a : table.axes[0].nodes)
    for (const double b : table.axes[1].nodes)
      for (const double c : table.axes[2].nodes)
        for (const double d : table.axes[3].nodes) table.values.push_back(static_cast<float>(g(a, b, c, d)));
}

AngleTable normal_table(std::size_t rotations) {
  AngleTable table;
  table.axes = {make_axis(cell_centres(rotations, kTwoPi), kTwoPi), make_axis(cell_centres(9, kHalfPi)),
                make_axis(cell_centres(18, kHalfPi)), make_axis(cell_centres(24, kTwoPi), kTwoPi)};
  return table;
}

TEST(AngleAxis, FindsNeighboursAndWeights) {
  const AngleAxis axis = make_axis({0, 1, 3});
  EXPECT_EQ(neighbours(axis, 1.5).index, (std::array<std::size_t, 2>{1, 2}));
  EXPECT_DOUBLE_EQ(neighbours(axis, 1.5).fraction, 0.25);
  EXPECT_EQ(neighbours(axis, 0).fraction, 0);
  EXPECT_DOUBLE_EQ(neighbours(axis, 3).fraction, 1);
  EXPECT_TRUE(neighbours(axis, -0.5).inside);
  EXPECT_FALSE(neighbours(axis, -0.51).inside);
  EXPECT_TRUE(neighbours(axis, 4).inside);
  EXPECT_FALSE(neighbours(axis, 4.01).inside);
  EXPECT_TRUE(neighbours(make_axis({2}), -77).inside);
}

TEST(AngleAxis, WrapsAClosedCircle) {
  const AngleAxis axis = make_axis({0.5, 2.5, 4.5}, 6);
  EXPECT_TRUE(axis.closed);
  for (const double turns : {-12.0, 0.0, 6.0}) {
    const AxisNeighbours across = neighbours(axis, 6 + turns);
    EXPECT_EQ(across.index, (std::array<std::size_t, 2>{2, 0}));
    EXPECT_DOUBLE_EQ(across.fraction, 0.75);
    EXPECT_DOUBLE_EQ(neighbours(axis, 0.1 + turns).fraction, 0.8);
  }
}

TEST(AngleAxis, KnowsNothingInAnOpenGap) {
  const AngleAxis axis = make_axis({0, 1, 2}, 6);
  EXPECT_FALSE(axis.closed);
  EXPECT_TRUE(neighbours(axis, 2.4).inside);
  EXPECT_FALSE(neighbours(axis, 4).inside);
  EXPECT_TRUE(neighbours(axis, -0.4).inside);
  EXPECT_EQ(neighbours(axis, 5.6).index[0], 0u);
}

TEST(AngleTable, InterpolatesLinearFunctionsOfTheAnglesExactly) {
  AngleTable table = normal_table(1);
  fill(table, [](double, double b, double c, double) { return 1 + 2 * b + 3 * c; });
  double f;
  for (const auto& [wi, wo] : draw_pairs(2000, 1, false)) {
    const double b = theta_of(wi), c = theta_of(wo);
    ASSERT_TRUE(table.eval(wi, wo, {&f, 1}));
    if (b < 0.1 || b > 1.48 || c < 0.1 || c > 1.48) continue;
    EXPECT_NEAR(f, 1 + 2 * b + 3 * c, 1e-5);
  }
  EXPECT_TRUE(table.isotropic());
}

TEST(AngleTable, FollowsBothAzimuths) {
  AngleTable table = normal_table(36);
  const auto g = [](double a, double, double, double d) { return 2 + std::cos(a) + std::sin(d); };
  fill(table, g);
  EXPECT_FALSE(table.isotropic());
  double f;
  for (const auto& [wi, wo] : draw_pairs(2000, 2, false)) {
    ASSERT_TRUE(table.eval(wi, wo, {&f, 1}));
    // Half of the second derivative times the squares of half the steps, 10 and 15 degrees.
    EXPECT_NEAR(f, g(phi_of(wi), 0, 0, phi_of(wo) - phi_of(wi)),
                0.5 * (0.0873 * 0.0873 + 0.131 * 0.131) + 1e-5);
  }
}

TEST(AngleTable, FoldsAzimuthsWhereSymmetric) {
  AngleTable table;
  table.folded = true;
  table.axes = {make_axis({0}), make_axis({0.5}), make_axis({0.5}), make_axis(cell_centres(30, kPi))};
  fill(table, [](double, double, double, double d) { return d; });
  double f, mirrored;
  const Vec3 wi = spherical_direction(0.5, 1);
  for (const double turn : {0.2, 1.0, 3.0}) {
    table.eval(wi, spherical_direction(0.5, 1 + turn), {&f, 1});
    table.eval(wi, spherical_direction(0.5, 1 - turn), {&mirrored, 1});
    EXPECT_NEAR(f, turn, 1e-6);
    EXPECT_NEAR(mirrored, turn, 1e-6);
  }
}

TEST(AngleTable, MeasuresTheSpecularFrameFromTheMirrorDirection) {
  AngleTable table;
  table.frame = AngleTable::Frame::specular;
  std::vector<double> circle, radial;
  for (int k = 0; k < 36; ++k) circle.push_back(radians(10 * k));
  for (int k = 0; k <= 18; ++k) radial.push_back(radians(10 * k));
  table.axes = {make_axis({0}), make_axis({radians(10), radians(80)}), make_axis(circle, kTwoPi),
                make_axis(radial)};
  fill(table, [](double, double, double, double d) { return d; });
  double f;
  for (const auto& [wi, wo] : draw_pairs(500, 3, false))
    if (table.eval(wi, wo, {&f, 1})) {
      EXPECT_NEAR(f, angle_between(mirror(wi), wo), 1e-6);
    }
  const double theta = radians(30), phi = 0.7;
  EXPECT_LT(length(around_specular(theta, phi, 2, 0) - spherical_direction(theta, phi + kPi)), 1e-15);
  // Azimuth 0 goes to the normal, half a turn to the horizon, a quarter turn to the side where phi grows...
  // of -phi_i.
  EXPECT_LT(length(around_specular(theta, phi, 0, theta) - Vec3{0, 0, 1}), 1e-15);
  EXPECT_NEAR(around_specular(theta, phi, kPi, radians(60)).z, 0, 1e-15);
  const Vec3 side = around_specular(theta, 0, kHalfPi, 0.1);
  EXPECT_NEAR(side.y, std::sin(0.1), 1e-15);
  // Its azimuth is read back.
  fill(table, [](double, double, double c, double) { return std::cos(c); });
  ASSERT_TRUE(
      table.eval(spherical_direction(theta, 0), around_specular(theta, 0, radians(50), 0.3), {&f, 1}));
  EXPECT_NEAR(f, std::cos(radians(50)), 1e-6);
}

TEST(AngleTable, GivesHolesNoWeight) {
  AngleTable table;
  table.axes = {make_axis({0}), make_axis({0.5}), make_axis({0.4, 0.6}), make_axis({0, kPi}, 0)};
  table.folded = true;
  const float hole = std::numeric_limits<float>::quiet_NaN();
  table.values = {hole, hole, hole, 7};
  double f;
  const Vec3 wi = spherical_direction(0.5, 0);
  EXPECT_TRUE(table.eval(wi, spherical_direction(0.5, 1), {&f, 1}));
  EXPECT_DOUBLE_EQ(f, 7);
  EXPECT_FALSE(table.eval(wi, spherical_direction(0.4, 1), {&f, 1}));
  EXPECT_EQ(f, 0);
  EXPECT_TRUE(table.eval(wi, {0, 0, -1}, {&f, 1}));
  EXPECT_EQ(f, 0);
}

TEST(AngleTable, KnowsNothingAtAHoleWhoseNeighbourHasOnlyRoundingsWeight) {
  AngleTable table;
  table.axes = {make_axis({0}), make_axis({0.5}), make_axis({0.4, 0.6}), make_axis({0})};
  table.values = {std::numeric_limits<float>::quiet_NaN(), 7};
  double f = 1;
  const Vec3 wi = spherical_direction(0.5, 0);
  for (const double rounding : {-1e-15, 0.0, 1e-15, 1e-11}) {
    EXPECT_FALSE(table.eval(wi, spherical_direction(0.4 + rounding, 0), {&f, 1}));
    EXPECT_EQ(f, 0);
  }
  EXPECT_TRUE(table.eval(wi, spherical_direction(0.4 + 1e-6, 0), {&f, 1}));
  EXPECT_DOUBLE_EQ(f, 7);
}

// Lopsided about the plane of incidence and anisotropic.
struct Lopsided {
  std::size_t channels() const noexcept { return 2; }
  bool isotropic() const noexcept { return false; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    f[0] = 2 + wi.x * wo.y - wi.y * wo.x;
    f[1] = 2 + wi.x;
    return wo.x < 0.9;
  }
};

TEST(AngleTable, TabulatesASourceAtItsNodes) {
  for (const auto frame : {AngleTable::Frame::normal, AngleTable::Frame::specular})
    for (const bool folded : {false, true}) {
      AngleTable layout;
      layout.frame = frame;
      layout.folded = folded;
      const AngleAxis azimuth = folded ? make_axis({0, 1, 2, kPi}) : make_axis({0, 1.5, 3, 4.5}, kTwoPi);
      layout.axes = {make_axis({0, 2, 4}, kTwoPi), make_axis({0, 0.5, 1.2}), make_axis({0.1, 0.7, 1.3}),
                     make_axis({0.1, 0.7, 1.3})};
      layout.axes[frame == AngleTable::Frame::normal ? 3 : 2] = azimuth;
      const AngleTable table = tabulate_angles(Lopsided{}, layout);
      ASSERT_EQ(table.values.size(), 2 * entry_count(table));
      int known = 0;
      for (std::size_t entry = 0; entry < entry_count(table); ++entry) {
        const auto [wi, wo] = node_directions(table, node_of_entry(table, entry));
        std::array<double, 2> expected, f;
        const bool above = wi.z > 0 && wo.z > 0, there = above && Lopsided{}.eval(wi, wo, expected);
        if (!there) continue;  // a folded table may know the other side
        ++known;
        EXPECT_NEAR(table.values[2 * entry + 1], expected[1], 1e-6);
        if (!folded) {
          EXPECT_NEAR(table.values[2 * entry], expected[0], 1e-6);
        }
        ASSERT_TRUE(table.eval(wi, wo, f));
        if (wi.z < 1) {  // at the normal every azimuth is the same direction
          EXPECT_NEAR(f[0], table.values[2 * entry], 1e-6);
          EXPECT_NEAR(f[1], table.values[2 * entry + 1], 1e-6);
        }
      }
      EXPECT_GT(known, 30);
    }
}

}  // namespace
}  // namespace burnish
