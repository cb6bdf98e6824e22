// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/half_diff_table.h>

namespace burnish {
namespace {

/// Linear in the table's own coordinates, so that trilinear interpolation is exact; reciprocal if slope_phi
/// is 0.
struct LinearInTable {
  double slope_phi = 0;

  std::size_t channels() const noexcept { return 3; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    const HalfDiff angles = to_half_diff(wi, wo);
    f[0] = 0.2 + std::sqrt(angles.theta_h / kHalfPi);
    f[1] = 0.1 + angles.theta_d;
    f[2] = 3 + slope_phi * angles.phi_d + f[0];
    return true;
  }
};

/// Smooth, reciprocal, with a period of pi in phi_d.
struct SmoothReciprocal {
  std::size_t channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    const HalfDiff angles = to_half_diff(wi, wo);
    f[0] = std::exp(-4 * angles.theta_h) * (2 + std::cos(2 * angles.phi_d) * std::sin(angles.theta_d));
    return true;
  }
};

struct Anisotropic {
  std::size_t channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return false; }
  bool eval(Vec3, Vec3, std::span<double> f) const noexcept {
    f[0] = 1;
    return true;
  }
};

bool within_centres(const HalfDiffTable& table, const HalfDiff& angles) {
  const HalfDiff first = table.centre(0, 0, 0),
                 last = table.centre(table.theta_h_count - 1, table.theta_d_count - 1, table.phi_d_count - 1);
  return angles.theta_h > first.theta_h && angles.theta_h < last.theta_h && angles.theta_d > first.theta_d &&
         angles.theta_d < last.theta_d;
}

TEST(HalfDiffTable, ReproducesItsEntriesAtCellCentres) {
  const SmoothReciprocal source;
  const HalfDiffTable table = tabulate_half_diff(source, 12, 9, 10, false);
  const NearestHalfDiff nearest{&table};
  double interpolated, picked, truth;
  for (int h = 0; h < 12; ++h)
    for (int d = 0; d < 9; ++d)
      for (int p = 0; p < 10; ++p) {
        const auto [wi, wo] = from_half_diff(table.centre(h, d, p));
        EXPECT_EQ(table.above_horizon(h, d, p), wi.z > 0 && wo.z > 0);
        if (!table.above_horizon(h, d, p)) continue;
        source.eval(wi, wo, {&truth, 1});
        ASSERT_TRUE(table.eval(wi, wo, {&interpolated, 1}));
        ASSERT_TRUE(nearest.eval(wi, wo, {&picked, 1}));
        EXPECT_NEAR(interpolated, truth, 1e-6 * truth);
        EXPECT_NEAR(picked, truth, 1e-6 * truth);
      }
}

TEST(HalfDiffTable, InterpolatesLinearFunctionsExactly) {
  const LinearInTable source;
  // Every neighbour must exist, so holes below the horizon are filled with the function's continuation.
  HalfDiffTable table = tabulate_half_diff(source, 30, 30, 36, false);
  for (int h = 0; h < 30; ++h)
    for (int d = 0; d < 30; ++d)
      for (int p = 0; p < 36; ++p) {
        const HalfDiff angles = table.centre(h, d, p);
        float* entry = &table.values[table.offset(h, d, p)];
        entry[0] = static_cast<float>(0.2 + std::sqrt(angles.theta_h / kHalfPi));
        entry[1] = static_cast<float>(0.1 + angles.theta_d);
        entry[2] = entry[0] + 3;
      }
  std::array<double, 3> f, truth;
  for (const auto& [wi, wo] : draw_pairs(5000, 1, false)) {
    if (!within_centres(table, to_half_diff(wi, wo))) continue;
    ASSERT_TRUE(table.eval(wi, wo, f));
    source.eval(wi, wo, truth);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(f[c], truth[c], 1e-6);
  }
}

TEST(HalfDiffTable, InterpolatesPhiDOverTheFullCircleWhereAsked) {
  const LinearInTable source{0.5};
  const HalfDiffTable table = tabulate_half_diff(source, 10, 10, 72, true);
  std::array<double, 3> f, truth;
  for (const double phi_d : {0.3, 2.0, 3.5, 6.0}) {
    const auto [wi, wo] = from_half_diff({0.2, 0, 0.5, phi_d});
    ASSERT_TRUE(table.eval(wi, wo, f));
    source.eval(wi, wo, truth);
    EXPECT_NEAR(f[2], truth[2], 1e-5);
  }
}

TEST(HalfDiffTable, WrapsPhiDByReciprocity) {
  const HalfDiffTable table = tabulate_half_diff(SmoothReciprocal{}, 30, 30, 60, false);
  double f, swapped;
  for (const auto& [wi, wo] : draw_pairs(2000, 2, false)) {
    ASSERT_EQ(table.eval(wi, wo, {&f, 1}), table.eval(wo, wi, {&swapped, 1}));
    EXPECT_NEAR(f, swapped, 1e-9);
  }
  // Just below and above the wrap.
  const auto below = from_half_diff({0.3, 0, 0.4, kPi - 1e-7}),
             above = from_half_diff({0.3, 0, 0.4, kPi + 1e-7});
  table.eval(below.wi, below.wo, {&f, 1});
  table.eval(above.wi, above.wo, {&swapped, 1});
  EXPECT_NEAR(f, swapped, 1e-6);
}

// The error of linear interpolation falls with the square of the step, the nearest entry's with the step.
TEST(HalfDiffTable, ConvergesQuadraticallyToASmoothSource) {
  const SmoothReciprocal source;
  std::array<double, 2> linear{}, nearest{};
  for (const int fine : {0, 1}) {
    const int n = fine ? 60 : 30;
    const HalfDiffTable table = tabulate_half_diff(source, n, n, 2 * n, false);
    const NearestHalfDiff baseline{&table};
    std::size_t count = 0;
    for (const auto& [wi, wo] : draw_pairs(4000, 3, false)) {
      const HalfDiff angles = to_half_diff(wi, wo);
      if (angles.theta_h < 0.05 || angles.theta_h > 0.7 || angles.theta_d < 0.05 || angles.theta_d > 0.7)
        continue;
      double truth, f;
      source.eval(wi, wo, {&truth, 1});
      table.eval(wi, wo, {&f, 1});
      linear[static_cast<std::size_t>(fine)] += std::abs(f - truth);
      baseline.eval(wi, wo, {&f, 1});
      nearest[static_cast<std::size_t>(fine)] += std::abs(f - truth);
      ++count;
    }
    ASSERT_GT(count, 500u);
  }
  EXPECT_GT(linear[0] / linear[1], 3);
  EXPECT_LT(nearest[0] / nearest[1], 3);
  EXPECT_LT(linear[1], 0.1 * nearest[1]);
}

TEST(HalfDiffTable, GivesHolesNoWeight) {
  HalfDiffTable table{2, 2, 2, false, 1, {}};
  const float hole = std::numeric_limits<float>::quiet_NaN();
  table.values = {hole, hole, hole, hole, hole, hole, 5, hole};
  double f;
  const auto [wi, wo] = from_half_diff({0.4, 0, 0.7, 1.0});
  EXPECT_TRUE(table.eval(wi, wo, {&f, 1}));
  EXPECT_DOUBLE_EQ(f, 5);
  table.values[6] = hole;
  EXPECT_FALSE(table.eval(wi, wo, {&f, 1}));
  EXPECT_EQ(f, 0);
  EXPECT_FALSE(NearestHalfDiff{&table}.eval(wi, wo, {&f, 1}));
}

TEST(HalfDiffTable, IsZeroBelowTheHorizonAndFiniteAtCorners) {
  const HalfDiffTable table = tabulate_half_diff(SmoothReciprocal{}, 9, 9, 18, false);
  double f = 1;
  EXPECT_TRUE(table.eval({0, 0, -1}, {0, 0, 1}, {&f, 1}));
  EXPECT_EQ(f, 0);
  for (const double theta : {0.0, 1e-9, 1.5707})
    for (const double other : {0.0, 1.5707})
      for (const double phi : {0.0, kPi, -1e-18}) {
        table.eval(spherical_direction(theta, 0), spherical_direction(other, phi), {&f, 1});
        EXPECT_TRUE(std::isfinite(f));
        EXPECT_GE(f, 0);
      }
}

TEST(HalfDiffTable, RefusesAnAnisotropicSource) {
  EXPECT_THROW(tabulate_half_diff(Anisotropic{}, 3, 3, 3, false), Error);
  EXPECT_THROW(tabulate_half_diff(SmoothReciprocal{}, 0, 3, 3, false), Error);
}

}  // namespace
}  // namespace burnish
