// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/capture/texels/nonnegative.h>
#include <burnish/math/random.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {
namespace {

// The conditions of Karush, Kuhn and Tucker hold: slopes along free unknowns vanish, and those along unknowns at 0
// lead up.
TEST(SolveNonnegative, FindsTheLeastAtTheBounds) {
  Pcg32 random(5);
  std::size_t at_bound = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const std::size_t n = 1 + random.next() % kMaxSurfaceLobes, rows = n + 3;
    std::vector<double> m(rows * n), a(n * n), b(n), w(n);
    for (double& value : m) value = random.uniform();
    for (std::size_t i = 0; i < n; ++i) {
      b[i] = 2 * random.uniform() - 0.7;
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t r = 0; r < rows; ++r) a[i * n + j] += m[r * n + i] * m[r * n + j];
      a[i * n + i] += 1e-3;
    }
    solve_nonnegative(a, b, w);
    for (std::size_t i = 0; i < n; ++i) {
      double slope = -b[i];
      for (std::size_t j = 0; j < n; ++j) slope += a[i * n + j] * w[j];
      EXPECT_GE(w[i], 0);
      EXPECT_GE(slope, -1e-8) << trial;
      if (w[i] > 0) {
        EXPECT_NEAR(slope, 0, 1e-8) << trial;
      }
      at_bound += w[i] == 0;
    }
    // The solution is the same from any start.
    std::vector<double> near(n);
    for (double& value : near) value = random.next() % 3 == 0 ? 0 : 2 * random.uniform();
    solve_nonnegative(a, b, near, true);
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(near[i], w[i], 1e-6) << trial;
  }
  EXPECT_GT(at_bound, 500u);
}

TEST(SolveNonnegative, GivesZerosForWhatIsNotFinite) {
  std::array<double, 1> w{7};
  solve_nonnegative(std::array{1.0}, std::array<double, 1>{NAN}, w);
  EXPECT_EQ(w[0], 0);
}

}  // namespace
}  // namespace burnish
