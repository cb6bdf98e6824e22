// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/factors/table_gradient.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

// Returns the sum over channels of weight times f.
double weighted(const FactoredBrdf& brdf, const DirectionPair& pair, std::span<const double> weight) {
  std::array<double, SymmetrizedBrdf::kMaxChannels> f;
  brdf.eval(pair.wi, pair.wo, std::span(f).first(brdf.channels()));
  double sum = 0;
  for (std::size_t c = 0; c < brdf.channels(); ++c) sum += weight[c] * f[c];
  return sum;
}

TEST(TableGradient, IsTheDifferenceQuotientForEveryShapeOfTable) {
  for (const std::size_t channels : {std::size_t{1}, std::size_t{3}}) {
    const FactoredBrdf brdf = random_model(kEverything, kEverySize, channels, TableFormat::single);
    const std::array<double, 3> weight{0.7, -0.4, 1.3};
    const auto used = std::span(weight).first(channels);
    for (const DirectionPair& pair : draw_pairs(20, 5, false)) {
      auto gradient = zero_table_gradient(brdf);
      add_table_gradient(brdf, pair.wi, pair.wo, used, gradient);
      for (std::size_t t = 0; t < brdf.tables().size(); ++t) {
        double largest = 0;
        for (const double slope : gradient[t]) largest = std::max(largest, std::abs(slope));
        for (std::size_t i = 0; i < gradient[t].size(); ++i) {
          // Only values that the lookups touch have a derivative; of the rest, a few are asked.
          if (gradient[t][i] == 0 && i % 97 != 0) continue;
          const auto with = [&](float value) {
            std::vector<Table> tables(brdf.tables().begin(), brdf.tables().end());
            tables[t].values[i] = value;
            return FactoredBrdf(channels, tables, {brdf.lobes().begin(), brdf.lobes().end()});
          };
          const float value = brdf.tables()[t].values[i], low = 0.999f * value, high = 1.001f * value;
          const double quotient = (weighted(with(high), pair, used) - weighted(with(low), pair, used)) /
                                  (static_cast<double>(high) - low);
          // A table that is used twice is a square at most, whose central quotient is exact but for rounding.
          EXPECT_NEAR(gradient[t][i], quotient, 1e-6 * std::max(largest, 1e-12))
              << brdf.tables()[t].name << " value " << i;
        }
      }
    }
  }
}

TEST(TableGradient, OfLogarithmsAddsUpToTheValueTimesTheUsesOfTheTable) {
  // f is homogeneous in each table: doubling a table that each lobe uses twice makes it four times as large.
  const FactoredBrdf brdf = random_model("p(wo) q(h) p(wi)", {"q=9x9"}, 3, TableFormat::single);
  const std::array<double, 3> weight{1, 2, 3};
  for (const DirectionPair& pair : draw_pairs(200, 6, false)) {
    auto gradient = zero_table_gradient(brdf);
    add_table_gradient(brdf, pair.wi, pair.wo, weight, gradient);
    const double f = weighted(brdf, pair, weight);
    for (std::size_t t = 0; t < 2; ++t) {
      double sum = 0;
      for (std::size_t i = 0; i < gradient[t].size(); ++i) sum += gradient[t][i] * brdf.tables()[t].values[i];
      EXPECT_NEAR(sum, (brdf.tables()[t].name == "p" ? 2 : 1) * f, 1e-12 * f);
    }
  }
}

TEST(TableGradient, IsNothingBelowTheHorizon) {
  const FactoredBrdf brdf = random_model(kEverything, kEverySize, 1, TableFormat::half);
  auto gradient = zero_table_gradient(brdf);
  const double one = 1;
  add_table_gradient(brdf, {0, 0, 1}, {0.6, 0, -0.8}, {&one, 1}, gradient);
  add_table_gradient(brdf, {1, 0, 0}, {0, 0, 1}, {&one, 1}, gradient);
  EXPECT_EQ(gradient, zero_table_gradient(brdf));
}

}  // namespace
}  // namespace burnish
