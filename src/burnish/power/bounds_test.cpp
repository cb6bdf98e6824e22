// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/math/random.h>
#include <burnish/power/bounds.h>
#include <burnish/power/dual.h>

namespace burnish {
namespace {

TEST(Interval, ContainsTheResultsOfItsMembers) {
  Pcg32 random(1);
  const auto draw = [&] {
    const double a = 4 * random.uniform() - 2, b = 4 * random.uniform() - 2;
    return Interval(std::min(a, b), std::max(a, b));
  };
  for (int i = 0; i < 20000; ++i) {
    const Interval a = draw(), b = draw();
    const double x = a.lo + random.uniform() * a.width(), y = b.lo + random.uniform() * b.width();
    const auto in = [](double v, Interval r) { return v >= r.lo && v <= r.hi; };
    EXPECT_TRUE(in(x + y, a + b) && in(x - y, a - b) && in(x * y, a * b));
    EXPECT_TRUE(in(x * x, square(a)) && in(std::exp(x), exp(a)) && in(std::max(x, y), max(a, b)));
    if (b.lo > 0 || b.hi < 0) {
      EXPECT_TRUE(in(x / y, a / b));
    }
  }
}

TEST(Interval, IsWiderThanTheRoundedResult) {
  const Interval third = Interval(1.0) / Interval(3.0);
  EXPECT_LT(third.lo, 1.0 / 3);
  EXPECT_GT(third.hi, 1.0 / 3);
  EXPECT_LT(third.width(), 1e-15);
}

TEST(Dual, DerivativesContainDifferenceQuotients) {
  const auto f = [](const Dual& x, const Dual& y) {
    return sqrt(x * y + 1.0) / exp2(mul_add(x, y, neg_mul_add(x, x, y))) + max(x - y, Dual(0.1));
  };
  Pcg32 random(2);
  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform(), y = random.uniform(), h = 1e-3;
    const Dual box = f({{x, x + h}, 1.0, 0.0}, {{y, y + h}, 0.0, 1.0});
    const auto at = [&](double a, double b) { return f({a, 1.0, 0.0}, {b, 0.0, 1.0}).value.mid(); };
    const double slack = 1e-9;
    EXPECT_GE((at(x + h, y) - at(x, y)) / h, box.d0.lo - slack);
    EXPECT_LE((at(x + h, y) - at(x, y)) / h, box.d0.hi + slack);
    EXPECT_GE((at(x, y + h) - at(x, y)) / h, box.d1.lo - slack);
    EXPECT_LE((at(x, y + h) - at(x, y)) / h, box.d1.hi + slack);
  }
}

class ProvedMember : public testing::TestWithParam<PowerInfo> {};

TEST_P(ProvedMember, KeepsEveryStatedBoundForAllCosinesAndRealExponents) {
  for (const PowerBound& bound : GetParam().bounds) {
    const BoundProof proof = prove_power_bound(GetParam().method, bound);
    EXPECT_TRUE(proof.proved) << bound.min_exponent << " after " << proof.boxes << " boxes, met "
                              << proof.attained;
  }
}

TEST_P(ProvedMember, IsRefutedWithATighterBound) {
  if (GetParam().method == PowerMethod::near_exact)
    GTEST_SKIP() << "its proof composes two one-dimensional ones";
  for (PowerBound bound : GetParam().bounds) {
    bound.bound *= 0.9;
    const BoundProof proof = prove_power_bound(GetParam().method, bound, 30'000);
    EXPECT_FALSE(proof.proved) << bound.min_exponent;
  }
}

TEST_P(ProvedMember, RisesWithTheCosineWhereStated) {
  if (!GetParam().monotone_from) {
    EXPECT_EQ(GetParam().method, PowerMethod::quadratic_raw);
    EXPECT_FALSE(prove_power_monotone(GetParam().method, 4, kMaxExponent, 100'000).proved);
    return;
  }
  const BoundProof proof = prove_power_monotone(GetParam().method, *GetParam().monotone_from, kMaxExponent);
  EXPECT_TRUE(proof.proved) << proof.boxes << " boxes, largest derivative " << proof.attained;
}

std::vector<PowerInfo> approximations() {
  std::vector<PowerInfo> result(power_methods().begin() + 1, power_methods().end());
  return result;
}

INSTANTIATE_TEST_SUITE_P(Power, ProvedMember, testing::ValuesIn(approximations()),
                         [](const auto& member) { return std::string(member.param.name); });

TEST(ExactPower, IsProvedWithinAnUlpForEveryFloatCosine) {
  const double ulps = proved_exact_ulps();
  EXPECT_LT(ulps, kExactUlps);
  EXPECT_GT(ulps, 0.5);
}

TEST(QuadraticCoefficient, IsProvedAffineWithoutATable) {
  EXPECT_TRUE(prove_affine_coefficient(2, 1024, 0.15).proved);
  EXPECT_FALSE(prove_affine_coefficient(2, 1024, 0.14).proved);
}

}  // namespace
}  // namespace burnish
