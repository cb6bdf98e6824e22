// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include <burnish/shaders/half_range.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

/// Tables that fall by a factor e^span each and a scale that makes up for it.
FactoredBrdf steep(double span, TableFormat format, double scale) {
  const FactoredBrdf brdf =
      random_model("p(wo) q(h) p(wi) r(theta_d)", {"p=8", "q=9", "r=5"}, 3, format, span);
  std::vector<Lobe> lobes(brdf.lobes().begin(), brdf.lobes().end());
  for (Lobe& lobe : lobes) std::ranges::fill(lobe.scale, scale);
  return {3, {brdf.tables().begin(), brdf.tables().end()}, std::move(lobes)};
}

TEST(HalfRange, ExponentsTakeTheScaleAsFarAsTheyGo) {
  for (const double scale : {0x1p-3, 1.0, 0x1p10, 0x1p30}) {
    const FactoredBrdf brdf = steep(9, TableFormat::half, scale);
    const std::vector<int> exponents = table_exponents(brdf);
    ASSERT_EQ(exponents.size(), 3u);
    double rest = std::log2(scale);
    for (const FactorUse& use : brdf.lobes()[0].factors) rest -= exponents[use.table];
    for (const int exponent : exponents) {
      EXPECT_GE(exponent, 0);
      EXPECT_LE(exponent, 15);
    }
    // each of the four is rounded; below 1 a scale stays, since exponents are not negative
    EXPECT_NEAR(rest, std::min(std::log2(scale), 0.0), 2) << scale;
  }
  const std::vector<int> none = table_exponents(steep(2, TableFormat::unorm8, 0x1p10));
  EXPECT_EQ(none, std::vector<int>(3));
}

/// Two tables that rise by 2^13 and two that fall by as much, or by what their format holds: only all together they
/// are a reflectance.
FactoredBrdf crossing(TableFormat format) {
  Pcg32 random(3);
  return model_of({"m", "a(h) b(h) c(h) d(h)", {"a=9", "b=9", "c=9", "d=9"}, 3}, format, random,
                  [](std::size_t table, const TableLayout& layout, int x, int, std::size_t) {
                    return (table < 2 ? 9.0 : -9.0) * x / (layout.width - 1);
                  });
}

// Every factor once, and constants that make up for what the scale has too much: products stay in the range of halves
// all along, where one rising table after the other would leave it.
TEST(HalfRange, OrdersEveryFactorOnceWithinHalfFloats) {
  for (const TableFormat format : {TableFormat::half, TableFormat::unorm8}) {
    const FactoredBrdf brdf = crossing(format);
    const double scale = std::ranges::max(brdf.lobes()[0].scale);
    const std::vector<int> exponents = table_exponents(brdf);
    const HalfProduct product = half_product(brdf, 0, exponents);
    const auto factors = brdf.ordered_factors(0);
    std::vector<int> order = product.order;
    const auto constants = std::ranges::count(order, HalfProduct::kConstant);
    std::erase(order, HalfProduct::kConstant);
    std::ranges::sort(order);
    std::vector<int> each(factors.size());
    std::iota(each.begin(), each.end(), 0);
    EXPECT_EQ(order, each) << scale;
    EXPECT_EQ(constants > 0, format == TableFormat::unorm8);  // whose exponents are 0

    double first = std::log2(scale) - static_cast<double>(constants) * product.exponent;
    for (const FactorUse& use : factors) first -= exponents[use.table];
    std::size_t followed = 0;
    for (const auto& [wi, wo] : corner_and_random_pairs(2000)) {
      if (wi.z <= 0 || wo.z <= 0) continue;
      double f[3];
      brdf.eval(wi, wo, f);
      if (f[0] < 1e-3 || f[0] > 3e4) continue;
      ++followed;
      double log = first;
      for (const int k : product.order) {
        if (k == HalfProduct::kConstant) {
          log += product.exponent;
        } else {
          const FactorUse& use = factors[static_cast<std::size_t>(k)];
          const FactoredBrdf alone(3, {brdf.tables().begin(), brdf.tables().end()},
                                   {{.scale = {1, 1, 1}, .factors = {use}}});
          double factor[3];
          alone.eval(wi, wo, factor);
          log += std::log2(factor[0]) + exponents[use.table];
        }
        EXPECT_LT(log, 16) << scale;   // the largest half is 65504
        EXPECT_GT(log, -14) << scale;  // the smallest that keeps its digits is 2^-14
      }
      EXPECT_NEAR(log, std::log2(f[0]), 1e-9);
    }
    EXPECT_GT(followed, 20u) << scale;
  }
}

}  // namespace
}  // namespace burnish
