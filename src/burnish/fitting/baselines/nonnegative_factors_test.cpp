// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/fitting/baselines/low_rank.h>
#include <burnish/math/random.h>
#include <burnish/testing/matrices.h>

namespace burnish {
namespace {

using fixtures::random_matrix;
using fixtures::sum_of_squares;

// The updates as the paper writes them, in double precision. [Lee 2001, eq. 4]
LowRank plain_updates(const Matrix& m, const std::vector<double>& weights, std::size_t terms,
                      int iterations) {
  double mean = 0;
  for (const double x : m.values) mean += x / static_cast<double>(m.values.size());
  LowRank f{terms, std::vector<double>(m.rows * terms), std::vector<double>(m.columns * terms)};
  Pcg32 random(1);
  for (std::vector<double>* side : {&f.u, &f.v})
    for (double& x : *side) x = std::sqrt(mean / static_cast<double>(terms)) * (0.5 + random.uniform());
  const auto update = [&](bool of_u) {
    std::vector<double>& near = of_u ? f.u : f.v;
    std::vector<double> wanted(near.size()), found(near.size());
    for (std::size_t r = 0; r < m.rows; ++r)
      for (std::size_t c = 0; c < m.columns; ++c) {
        double fitted = 0;
        for (std::size_t k = 0; k < terms; ++k) fitted += f.u[r * terms + k] * f.v[c * terms + k];
        for (std::size_t k = 0; k < terms; ++k) {
          const std::size_t at = (of_u ? r : c) * terms + k;
          const double other = of_u ? f.v[c * terms + k] : f.u[r * terms + k];
          wanted[at] += weights[r * m.columns + c] * m(r, c) * other;
          found[at] += weights[r * m.columns + c] * fitted * other;
        }
      }
    for (std::size_t i = 0; i < near.size(); ++i) near[i] *= wanted[i] / found[i];
  };
  for (int i = 0; i < iterations; ++i) {
    update(true);
    update(false);
  }
  return f;
}

TEST(NonnegativeFactors, TakeThePapersUpdatesWhicheverSideIsLonger) {
  for (const auto& [rows, columns] : {std::pair<std::size_t, std::size_t>{11, 33}, {33, 11}, {18, 18}})
    for (const std::size_t terms : {1u, 2u, 3u, 4u, 5u, 9u}) {
      const Matrix m = random_matrix(rows, columns, 6, 0, 9);
      Pcg32 random(10);
      std::vector<double> weights(m.values.size());
      for (double& w : weights) w = 0.1 + random.uniform();
      const LowRank expected = plain_updates(m, weights, terms, 8),
                    found = nonnegative_factors(m, weights, terms, 8, 1);
      ASSERT_EQ(found.terms, terms);
      for (std::size_t i = 0; i < expected.u.size(); ++i)
        EXPECT_NEAR(found.u[i], expected.u[i], 2e-4 * (0.1 + expected.u[i])) << rows << " " << terms;
      for (std::size_t i = 0; i < expected.v.size(); ++i)
        EXPECT_NEAR(found.v[i], expected.v[i], 2e-4 * (0.1 + expected.v[i])) << rows << " " << terms;
    }
}

TEST(NonnegativeFactors, EndWhereTheyStandStill) {
  const Matrix m = random_matrix(12, 20, 1, 0.2, 11);
  const std::vector<double> weights(m.values.size(), 1.0);
  const LowRank settled = nonnegative_factors(m, weights, 1, 100, 1);
  EXPECT_EQ(nonnegative_factors(m, weights, 1, 1'000'000'000, 1).u, settled.u);
  EXPECT_LT(squared_error(m, settled), 1e-10 * sum_of_squares(m));
}

TEST(NonnegativeFactors, AreNotNegativeAndNeverGetWorse) {
  const Matrix m = random_matrix(16, 20, 5, 0, 5);
  Pcg32 random(6);
  std::vector<double> weights(m.values.size());
  for (double& w : weights) w = random.uniform();
  double last = std::numeric_limits<double>::infinity();
  for (const int iterations : {1, 3, 10, 30, 100}) {
    const LowRank f = nonnegative_factors(m, weights, 3, iterations, 1);
    for (const double x : f.u) EXPECT_GE(x, 0);
    for (const double x : f.v) EXPECT_GE(x, 0);
    const double error = squared_error(m, f, weights);
    EXPECT_LT(error, last);
    last = error;
  }
}

TEST(NonnegativeFactors, ApproachAPositiveMatrixOfTheirRank) {
  const Matrix m = random_matrix(16, 20, 2, 0, 7);
  const std::vector<double> weights(m.values.size(), 1.0);
  EXPECT_LT(squared_error(m, nonnegative_factors(m, weights, 2, 3000, 1)), 1e-4 * sum_of_squares(m));
}

TEST(NonnegativeFactors, IgnoreEntriesWithoutWeight) {
  Matrix m = random_matrix(10, 10, 1, 0.2, 8);
  const Matrix clean = m;
  std::vector<double> weights(m.values.size(), 1.0);
  for (std::size_t i = 0; i < m.values.size(); i += 7) {
    m.values[i] = 100;
    weights[i] = 0;
  }
  EXPECT_LT(squared_error(clean, nonnegative_factors(m, weights, 1, 200, 1)), 1e-12 * sum_of_squares(clean));
}

}  // namespace
}  // namespace burnish
