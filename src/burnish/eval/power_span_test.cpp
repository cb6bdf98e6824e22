// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/eval/power_span.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/power/cosine.h>

namespace burnish {
namespace {

// Cosines over [0, 1], dense near 1 where large exponents matter; corners come first.
std::vector<float> test_cosines(double exponent, std::size_t count, Pcg32& random) {
  std::vector<float> c{1, 0, 0x1p-149f, 0x1p-126f, 0x1p-24f, 1 - 0x1p-24f, 0.5f, 2.0f / 3};
  while (c.size() < count) {
    const double u = random.uniform();
    c.push_back(
        static_cast<float>(random.next() % 2 ? u : std::max(0.0, 1 - 12 * u / std::max(exponent, 12.0))));
  }
  return c;
}

double allowance(PowerMethod method, float c, double e, bool per_value = false) {
  const double scale = method == PowerMethod::quadratic_raw ? 1 + e * (1 - c) : 1;
  return power_span_rounding(method, per_value) * scale;
}

class PowerSpan : public testing::TestWithParam<PowerInfo> {};

TEST_P(PowerSpan, EqualsTheDefinitionOnEveryTarget) {
  const PowerMethod method = GetParam().method;
  for (const std::string& target : simd_targets()) {
    const SimdTargetLimit limit(target);
    Pcg32 random(1);
    for (double from_one : {1.0, 4.0, 10.0, 33.3, 250.0, 1024.0}) {
      const double e = std::max(from_one, GetParam().min_exponent());
      const std::vector<float> c = test_cosines(e, 1003, random);
      std::vector<float> out(c.size());
      power_span(method, c, e, out);
      const PowerCoefficients k = power_coefficients(method, e);
      for (std::size_t i = 0; i < c.size(); ++i)
        ASSERT_NEAR(out[i], power(k, c[i]), allowance(method, c[i], e))
            << target << " e " << e << " c " << c[i];
    }
  }
}

TEST_P(PowerSpan, EqualsTheDefinitionWithOneExponentAValue) {
  const PowerMethod method = GetParam().method;
  for (const std::string& target : simd_targets()) {
    const SimdTargetLimit limit(target);
    Pcg32 random(2);
    const std::vector<float> c = test_cosines(100, 3001, random);
    std::vector<float> e(c.size()), out(c.size());
    for (float& x : e) {
      const double lo = GetParam().min_exponent();
      x = static_cast<float>(lo * std::pow(1024 / lo, random.uniform()));
      x = std::clamp(x, static_cast<float>(lo), 1024.0f);
    }
    e[0] = static_cast<float>(GetParam().min_exponent());
    e[1] = 1024;
    power_span(method, c, e, out);
    for (std::size_t i = 0; i < c.size(); ++i)
      ASSERT_NEAR(out[i], power(method, c[i], e[i]), allowance(method, c[i], e[i], true))
          << target << " e " << e[i] << " c " << c[i];
  }
}

TEST_P(PowerSpan, KeepsTheProvedBoundAgainstTheTruePower) {
  Pcg32 random(3);
  for (const PowerBound& bound : GetParam().bounds) {
    for (double e :
         {bound.min_exponent, std::sqrt(bound.min_exponent * bound.max_exponent), bound.max_exponent}) {
      const std::vector<float> c = test_cosines(e, 2000, random);
      std::vector<float> out(c.size());
      power_span(GetParam().method, c, e, out);
      for (std::size_t i = 0; i < c.size(); ++i)
        ASSERT_NEAR(out[i], std::pow(static_cast<double>(c[i]), e),
                    bound.bound + allowance(GetParam().method, c[i], e));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Members, PowerSpan,
                         testing::ValuesIn(power_methods().begin(), power_methods().end()),
                         [](const auto& member) { return std::string(member.param.name); });

// Returns the distance from c^e in units of the last place of a float of its size, down to the smallest denormal.
double ulps_off(float found, float c, double e) {
  const long double power = std::pow(static_cast<long double>(c), static_cast<long double>(e));
  int exponent = 0;
  std::frexp(power, &exponent);
  return static_cast<double>(std::abs(found - power)) / std::ldexp(1.0, std::max(exponent - 24, -149));
}

TEST(ExactPowerSpan, IsWithinItsUlpsOnEveryTarget) {
  Pcg32 random(6);
  for (const std::string& target : simd_targets()) {
    const SimdTargetLimit limit(target);
    for (double e : {1.0, 1.37, 2.0, 16.0, 50.0, 333.3, 1024.0}) {
      std::vector<float> c = test_cosines(e, 40000, random);
      for (std::size_t i = 100; i < 400; ++i)
        c[i] = static_cast<float>(std::exp2(-149 * random.uniform() / e));
      for (std::size_t i = 400; i < 700; ++i) c[i] = static_cast<float>(i) * 0x1p-149f;
      std::vector<float> out(c.size());
      power_span(PowerMethod::exact, c, e, out);
      for (std::size_t i = 0; i < c.size(); ++i)
        ASSERT_LE(ulps_off(out[i], c[i], e), kExactUlps) << target << " e " << e << " c " << c[i];
      const auto float_e = static_cast<float>(e);
      power_span(PowerMethod::exact, c, std::vector<float>(c.size(), float_e), out);
      for (std::size_t i = 0; i < c.size(); ++i)
        ASSERT_LE(ulps_off(out[i], c[i], float_e), kExactUlps) << target << " e " << e << " c " << c[i];
    }
  }
}

TEST(PowerSpans, AnyLengthAndPlaceGivesTheSameValues) {
  Pcg32 random(4);
  const std::vector<float> c = test_cosines(20, 67, random);
  const std::vector<float> e(c.size(), 20.0f);
  std::vector<float> whole(c.size());
  for (PowerMethod method : {PowerMethod::cubic2, PowerMethod::near_exact}) {
    power_span(method, c, 20, whole);
    for (std::size_t begin : {0u, 1u, 5u})
      for (std::size_t count = 0; begin + count <= c.size(); ++count) {
        std::vector<float> part(c.begin() + static_cast<std::ptrdiff_t>(begin),
                                c.begin() + static_cast<std::ptrdiff_t>(begin + count));
        power_span(method, part, 20, part);  // in place
        for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(part[i], whole[begin + i]);
      }
  }
}

TEST(PowerSpans, RefuseWrongLengthsAndExponents) {
  std::vector<float> three(3), two(2);
  EXPECT_THROW(power_span(PowerMethod::w8, three, 10, two), Error);
  EXPECT_THROW(power_span(PowerMethod::w8, three, three, two), Error);
  EXPECT_THROW(power_span(PowerMethod::w8, three, two, three), Error);
  EXPECT_THROW(power_span(PowerMethod::cubic4, three, 2, three), Error);
  EXPECT_THROW(shade_blinn_phong({}, {three, three, two}, three), Error);
  EXPECT_THROW(SimdTargetLimit("MMX"), Error);
}

TEST(PowerSpans, ThereIsAWideTargetAndAFallback) {
  EXPECT_GE(simd_targets().size(), 2u);
}

// Normals with lengths from 0.2 to 2.2, some turned away; the first is that of the mirror direction.
struct Normals {
  std::vector<float> x, y, z;
  void add(const Vec3& n) {
    x.push_back(static_cast<float>(n.x));
    y.push_back(static_cast<float>(n.y));
    z.push_back(static_cast<float>(n.z));
  }
  Vec3 unit(std::size_t i) const { return normalize({x[i], y[i], z[i]}); }
};
Normals test_normals(const BlinnPhongShading& material) {
  Pcg32 random(5);
  Normals normals;
  normals.add(half_vector(material.wi, material.wo));
  for (int i = 1; i < 501; ++i) {
    const double length = 0.2 + 2 * random.uniform();
    normals.add(length * spherical_direction(1.9 * random.uniform(), kTwoPi * random.uniform()));
  }
  return normals;
}

TEST(BlinnPhong, ShadesAsThePlainFormula) {
  BlinnPhongShading material{0.3f, 0.7f, {}, spherical_direction(0.6, 0.2), spherical_direction(0.3, 2.0)};
  const Normals normals = test_normals(material);
  std::vector<float> out(normals.x.size());
  for (const std::string& target : simd_targets()) {
    const SimdTargetLimit limit(target);
    shade_blinn_phong(material, {normals.x, normals.y, normals.z}, out);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const Vec3 n = normals.unit(i);
      const double c = std::clamp(blinn_cosine(material.wi, material.wo, n), 0.0, 1.0);
      ASSERT_NEAR(out[i], 0.3 * std::max(0.0, dot(n, material.wi)) + 0.7 * c, 2e-6) << target;
    }
  }
}

TEST_P(PowerSpan, ShadesAHighlightOfAnyWeight) {
  BlinnPhongShading material{0.25f, 0, {}, spherical_direction(0.6, 0.2), spherical_direction(0.3, 2.0)};
  const Normals normals = test_normals(material);
  std::vector<float> out(normals.x.size());
  for (const std::string& target : simd_targets()) {
    const SimdTargetLimit limit(target);
    for (double e :
         {std::max(GetParam().min_exponent(), 1.5), std::max(GetParam().min_exponent(), 5.3), 80.5, 1024.0})
      for (float weight : {0.0f, 0.01f, 0.7f, 40.0f}) {
        material.specular = weight;
        material.power = power_coefficients(GetParam().method, e);
        shade_blinn_phong(material, {normals.x, normals.y, normals.z}, out);
        for (std::size_t i = 0; i < out.size(); ++i) {
          const Vec3 n = normals.unit(i);
          const double c = std::clamp(blinn_cosine(material.wi, material.wo, n), 0.0, 1.0);
          const double expected =
              0.25 * std::max(0.0, dot(n, material.wi)) + weight * power(*material.power, c);
          // The cosine's rounding is a few units of 2^-24; the power's slope of at most e multiplies it.
          const double rounding = 8 * 0x1p-24 * e + allowance(GetParam().method, static_cast<float>(c), e);
          ASSERT_NEAR(out[i], expected, 1e-6 + weight * rounding)
              << target << " e " << e << " weight " << weight;
        }
      }
  }
}

}  // namespace
}  // namespace burnish
