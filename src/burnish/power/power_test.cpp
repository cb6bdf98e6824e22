// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/power/power.h>

namespace burnish {
namespace {

using testing::HasSubstr;

double real_exponent(Pcg32& random, double lo, double hi) {
  return lo * std::pow(hi / lo, random.uniform());
}

TEST(QuadraticCoefficient, HasThePapersValues) {
  EXPECT_EQ(quadratic_coefficient(1), 0);
  EXPECT_NEAR(quadratic_coefficient(2), 1, 1e-15);
  EXPECT_NEAR(quadratic_coefficient(10), 7.357622, 5e-7);
  EXPECT_NEAR(quadratic_coefficient(100), 78.192739, 5e-7);
  EXPECT_NEAR(quadratic_coefficient(512), 402.412385, 5e-7);
  EXPECT_NEAR(quadratic_coefficient(1000), 786.438568, 5e-7);
}

TEST(QuadraticCoefficient, EqualsEquationSevenAsPrinted) {
  Pcg32 random(1);
  for (int i = 0; i < 1000; ++i) {
    const double e = 1 + real_exponent(random, 1e-3, 1023);
    const double t = std::cos(std::atan(1 / std::sqrt(e - 1)));
    const double printed = (std::pow(t, e - 1) - 1) / (t - 1);
    EXPECT_NEAR(quadratic_coefficient(e) / printed, 1, 1e-11 * e) << e;
  }
}

TEST(QuadraticCoefficient, MakesTheParabolaMeetThePowerAtTheInflection) {
  Pcg32 random(2);
  for (int i = 0; i < 1000; ++i) {
    const double e = real_exponent(random, 1.01, 1024);
    const double x = std::atan(1 / std::sqrt(e - 1)), c = std::cos(x);
    EXPECT_NEAR(power(PowerMethod::quadratic_raw, c, e), std::pow(c, e), 1e-13) << e;
    // Second derivative of cos(x)^e: e cos^(e-2) ((e - 1) sin^2 - cos^2)
    EXPECT_NEAR((e - 1) * std::sin(x) * std::sin(x) - c * c, 0, 1e-12);
  }
}

TEST(QuadraticCoefficient, IsAffineWithinFifteenHundredthsOfTheInverse) {
  for (double e = 2; e <= 1024; e *= 1.003)
    EXPECT_NEAR(quadratic_coefficient(e), quadratic_coefficient_affine(e), 0.15 / e) << e;
  EXPECT_NEAR(quadratic_coefficient_affine(1000) - quadratic_coefficient_affine(999), 0.7869387, 5e-8);
}

TEST(PaperQuadratic, HasTheStatedRelativeErrorsAboveLevel056) {
  const auto error = [](double e) { return max_relative_error(PowerMethod::quadratic_raw, e, 0.56); };
  EXPECT_NEAR(error(3), 0.010, 5e-4);
  EXPECT_NEAR(error(10), 0.025, 5e-4);
  EXPECT_NEAR(error(100), 0.031, 5e-4);
  EXPECT_NEAR(error(1000), 0.03157, 5e-6);
  double previous = 0;
  for (int e = 1; e <= 512; e += e < 32 ? 1 : 32) {
    EXPECT_LE(error(e), 0.04);  // the paper's claim
    if (e > 2) {
      EXPECT_GT(error(e), previous);
    }
    previous = error(e);
  }
}

TEST(ClampedQuadratic, LosesTheStatedTail) {
  const auto kept = [](double e) { return power_integral(PowerMethod::quadratic, e) * (e + 1); };
  EXPECT_NEAR(max_absolute_error(PowerMethod::quadratic, 1000), 0.28, 5e-3);
  EXPECT_NEAR(kept(1000), 0.64, 5e-3);
  EXPECT_NEAR(max_absolute_error(PowerMethod::quadratic, 10), 0.232, 1e-3);
  EXPECT_NEAR(kept(10), 0.71, 5e-3);
}

TEST(TwoPiece, KeepsTheEnergyItsPriceSuggests) {
  EXPECT_NEAR(power_integral(PowerMethod::two_piece, 1024) * 1025, 0.986, 2e-3);
}

TEST(TwoPiecePaper, IsThePapersParabolaAboveLevel056) {
  Pcg32 random(3);
  for (int i = 0; i < 300; ++i) {
    const double e = real_exponent(random, 2, 1024), edge = std::pow(0.56, 1 / e);
    const double c = edge + (1 - edge) * random.uniform();
    EXPECT_EQ(power(PowerMethod::two_piece_paper, c, e), power(PowerMethod::quadratic_raw, c, e));
  }
  EXPECT_LE(max_relative_error(PowerMethod::two_piece_paper, 1024, 0.56), 0.0316);
}

TEST(W8, HasTheStatedAffineCoefficient) {
  for (double e : {5.0, 77.7, 1024.0})
    EXPECT_DOUBLE_EQ(power_coefficients(PowerMethod::w8, e).k[0], 0.114994 * e + 0.0766);
  const PowerCost& cost = power_info(PowerMethod::w8).cost;
  EXPECT_EQ(cost.multiplies, 4);  // the linear form and three squarings
  EXPECT_EQ(power_info(PowerMethod::quadratic).cost.multiplies, 2);
  EXPECT_EQ(power_info(PowerMethod::two_piece).cost.multiplies, 2);
}

class EveryMember : public testing::TestWithParam<PowerInfo> {};

TEST_P(EveryMember, IsOneAtTheCentre) {
  Pcg32 random(4);
  for (int i = 0; i < 100; ++i) {
    const double e = real_exponent(random, GetParam().min_exponent(), GetParam().max_exponent());
    EXPECT_NEAR(power(GetParam().method, 1, e), 1, 1e-12) << e;
  }
}

TEST_P(EveryMember, KeepsItsBoundAtRandomRealExponents) {
  Pcg32 random(5);
  for (const PowerBound& bound : GetParam().bounds)
    for (int i = 0; i < 3000; ++i) {
      const double e = real_exponent(random, bound.min_exponent, bound.max_exponent);
      const double c = i % 2 ? random.uniform() : std::max(0.0, 1 - 8 / e * random.uniform());
      EXPECT_NEAR(power(GetParam().method, c, e), std::pow(c, e), bound.bound + 1e-13)
          << "exponent " << e << " cosine " << c;
    }
}

TEST_P(EveryMember, HasBoundsNoLooserThanOneTwentieth) {
  if (GetParam().method == PowerMethod::exact) {
    EXPECT_EQ(GetParam().bounds[0].bound, 0);
    return;
  }
  for (const PowerBound& bound : GetParam().bounds) {
    double met = 0;
    for (double e = bound.min_exponent; e <= bound.max_exponent; e *= 1.25)
      met = std::max(met, max_absolute_error(GetParam().method, e));
    met = std::max(met, max_absolute_error(GetParam().method, bound.max_exponent));
    // The proof of near_exact adds the errors of its two parts.
    EXPECT_GT(met, (GetParam().method == PowerMethod::near_exact ? 0.9 : 0.95) * bound.bound)
        << bound.min_exponent;
  }
}

TEST_P(EveryMember, IsWithinZeroAndOneUnlessRaw) {
  if (GetParam().method == PowerMethod::quadratic_raw) GTEST_SKIP() << "the paper's parabola is negative";
  Pcg32 random(6);
  for (int i = 0; i < 2000; ++i) {
    const double e = real_exponent(random, GetParam().min_exponent(), GetParam().max_exponent());
    const double value = power(GetParam().method, random.uniform(), e);
    EXPECT_GE(value, 0);
    EXPECT_LE(value, 1 + 1e-12);
  }
}

TEST_P(EveryMember, KeepsTheEnergyOnceNormalized) {
  for (double e : {4.0, 17.3, 1000.0}) {
    const double scale = power_normalization(GetParam().method, e);
    // A plain Riemann sum over the lobe, independent of the quadrature in use.
    const PowerCoefficients k = power_coefficients(GetParam().method, e);
    constexpr int kSteps = 200000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += power(k, (i + 0.5) / kSteps) / kSteps;
    EXPECT_NEAR(scale * sum * (e + 1), 1, 1e-4) << e;
  }
}

TEST_P(EveryMember, RefusesExponentsOutsideItsRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double e : {GetParam().min_exponent() * 0.99, 1025.0, -1.0, nan})
    EXPECT_THROW(power_coefficients(GetParam().method, e), Error) << e;
}

INSTANTIATE_TEST_SUITE_P(Power, EveryMember,
                         testing::ValuesIn(power_methods().begin(), power_methods().end()),
                         [](const auto& member) { return std::string(member.param.name); });

TEST(Power, IsExactAtTheSpecialExponents) {
  for (double c = 0; c <= 1; c += 0.01) {
    EXPECT_NEAR(power(PowerMethod::quadratic, c, 1), c, 1e-15);
    EXPECT_NEAR(power(PowerMethod::quadratic, c, 2), c * c, 1e-15);
    EXPECT_NEAR(power(PowerMethod::lyon, c, 3), c * c * c, 1e-14);
    EXPECT_NEAR(power(PowerMethod::rational, c, 1), c, 1e-15);
    EXPECT_NEAR(power(PowerMethod::rational2, c, 2), c * c, 1e-14);
    EXPECT_NEAR(power(PowerMethod::rational4, c, 4), c * c * c * c, 1e-14);
  }
}

TEST(Power, ClosedFormsOfTheEnergyHold) {
  for (double e : {2.0, 9.5, 800.0}) {
    const double a = quadratic_coefficient(e);
    EXPECT_NEAR(power_integral(PowerMethod::quadratic, e), (3 * a - 1) / (6 * a * a), 1e-7 / e);
    const double k = power_coefficients(PowerMethod::w8, e).k[0];
    const double below = std::pow(std::max(0.0, 1 - k), 9);
    EXPECT_NEAR(power_integral(PowerMethod::w8, e), (1 - below) / (9 * k), 1e-7 / e);
    EXPECT_NEAR(power_integral(PowerMethod::gaussian, e), -std::expm1(-e) / e, 1e-9 / e);
    EXPECT_NEAR(power_integral(PowerMethod::exact, e), 1 / (e + 1), 1e-9 / e);
  }
}

TEST(Power, UnknownMethodsAreNamedWithTheKnownOnes) {
  try {
    power_method("pow");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("cubic2"));
    EXPECT_THAT(error.what(), HasSubstr("found 'pow'"));
  }
  for (const PowerInfo& info : power_methods()) EXPECT_EQ(power_method(info.name), info.method);
}

}  // namespace
}  // namespace burnish
