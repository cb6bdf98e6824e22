// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/math/quadrature.h>

namespace burnish {
namespace {

template <int N>
void expect_exact_for_polynomials() {
  for (int degree = 0; degree < 2 * N; ++degree) {
    const double integral = integrate<N>(0, 2, [&](double x) { return std::pow(x, degree); });
    const double exact = std::pow(2, degree + 1) / (degree + 1);
    EXPECT_NEAR(integral, exact, 1e-12 * exact) << N << " nodes, degree " << degree;
  }
}

TEST(GaussLegendre, IsExactForPolynomialsUpToItsDegree) {
  expect_exact_for_polynomials<1>();
  expect_exact_for_polynomials<5>();
  expect_exact_for_polynomials<24>();
}

TEST(GaussLegendre, GivesNothingForEmptyIntervals) {
  EXPECT_EQ(integrate<4>(1, 1, [](double) { return 1.0; }), 0);
  EXPECT_EQ(integrate<4>(2, 1, [](double) { return 1.0; }), 0);
}

}  // namespace
}  // namespace burnish
