// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/power/cosine.h>
#include <burnish/power/fixed_point.h>
#include <burnish/power/fixed_point_blinn.h>
#include <burnish/testing/directions.h>

namespace burnish {
namespace {

UnitConfig exact_config(int output_bits, int cosine_bits, UnitInput input = UnitInput::cosine) {
  return {.input = input, .cosine_bits = cosine_bits, .output_bits = output_bits};
}

TEST(FixedPoint, ExactUnitIsWithinOneUnitOfTheLastPlaceForEveryWidth) {
  for (int output_bits = 8; output_bits <= 12; ++output_bits) {
    const UnitError e = measure_unit_error(SpecularUnit(exact_config(output_bits, 15)), 1, 1000, 3, 27);
    EXPECT_LT(e.max_error, 0.81) << output_bits;
    EXPECT_GT(e.correct, 0.997) << output_bits;
    EXPECT_EQ(e.falls, 0U) << output_bits;
  }
}

TEST(FixedPoint, RoundingTheCosineCostsWhatItsSlopeTellsAndTheVersineSparesIt) {
  // half a step of the input times the steepest slope, and the unit's own error
  const double half_step = 255 * 1000 / std::ldexp(1.0, 16);
  const double cosine = measure_rounded_input_error(SpecularUnit(UnitConfig{}), 1000, 1 << 16);
  EXPECT_GT(cosine, half_step - 0.81);
  EXPECT_LT(cosine, half_step + 0.81);
  const UnitConfig versine = {.input = UnitInput::versine, .cosine_bits = 20};
  EXPECT_LT(measure_rounded_input_error(SpecularUnit(versine), 1000, 1 << 16), 1);
}

TEST(FixedPoint, ExactUnitIsWithinOneUnitOfTheLastPlaceForVersines) {
  for (const auto& [output_bits, cosine_bits] : {std::pair{8, 20}, {8, 10}, {10, 22}, {12, 24}}) {
    const UnitConfig config = exact_config(output_bits, std::max(cosine_bits, 12), UnitInput::versine);
    const std::uint32_t step = config.cosine_bits > 15 ? (1U << (config.cosine_bits - 15)) - 1 : 1;
    const UnitError e = measure_unit_error(SpecularUnit(config), 1, 1000, step, 37);
    EXPECT_LT(e.max_error, 0.81) << output_bits;
    EXPECT_EQ(e.falls, 0U) << output_bits;
  }
}

// The definitions' distance is the formats': coefficients, products cut to four guard bits, the output
// itself.
TEST(FixedPoint, UnitsComputeTheirDefinitions) {
  for (const UnitInfo& info : unit_methods()) {
    const SpecularUnit unit({.method = info.method});
    // rows of two_piece share coefficients among exponents
    const double steps = info.method == UnitMethod::two_piece ? 2.5 : 1.5;
    for (const std::uint32_t exponent : {5U, 8U, 15U, 31U, 60U, 200U, 999U}) {
      const PowerCoefficients k = power_coefficients(info.definition, exponent);
      for (std::uint32_t input = 0; input <= 32768; input += 5)
        ASSERT_NEAR(unit.value(exponent, input), 255 * power(k, unit.cosine(input)), steps)
            << info.name << " exponent " << exponent << " input " << input;
    }
  }
}

TEST(FixedPoint, UnitsAreFullAtTheCentreZeroAtTheRimAndDoNotFall) {
  for (const UnitInfo& info : unit_methods()) {
    const SpecularUnit unit({.method = info.method});
    for (std::uint32_t exponent = 1; exponent <= 1023; exponent += exponent < 20 ? 1 : 61) {
      EXPECT_EQ(unit.value(exponent, 32768), 255U) << info.name << exponent;
      if (static_cast<int>(exponent) >= info.zero_from) {
        EXPECT_EQ(unit.value(exponent, 0), 0U) << info.name << exponent;
      }
      std::uint32_t before = 0;
      if (static_cast<int>(exponent) < info.monotone_from) continue;
      for (std::uint32_t input = 0; input <= 32768; input += 3) {
        const std::uint32_t value = unit.value(exponent, input);
        ASSERT_GE(value, before) << info.name << " exponent " << exponent << " input " << input;
        before = value;
      }
    }
  }
}

TEST(FixedPoint, LiteralFormRipplesAtSmallExponentsAndTheFactorisedDoesNot) {
  EXPECT_GT(measure_unit_error(SpecularUnit({.method = UnitMethod::paper_literal}), 2, 2).falls, 0U);
  EXPECT_EQ(measure_unit_error(SpecularUnit({.method = UnitMethod::paper}), 2, 3).falls, 0U);
}

// Half a step of c moves c^e by e / 2^16 at the centre: 3.9 of 255 for e = 1000.
TEST(FixedPoint, RoundedCosinesCostMoreThanRoundedVersines) {
  constexpr int kExponent = 1000;
  const SpecularUnit cosines(exact_config(8, 15)), versines(exact_config(8, 20, UnitInput::versine));
  double cosine_error = 0, versine_error = 0;
  for (double c = 0.985; c <= 1; c += 1e-7) {
    const double exact = 255 * std::pow(c, kExponent);
    cosine_error = std::max(cosine_error, std::abs(cosines.value(kExponent, cosines.input(c)) - exact));
    versine_error = std::max(versine_error, std::abs(versines.value(kExponent, versines.input(c)) - exact));
  }
  EXPECT_NEAR(cosine_error, 3.9 + 0.6, 0.6);
  EXPECT_LT(versine_error, 0.81 + 0.13);
}

TEST(FixedPoint, InputsAboveOneCountAsOne) {
  for (const UnitInput input : {UnitInput::cosine, UnitInput::versine})
    for (const UnitInfo& info : unit_methods()) {
      const SpecularUnit unit({.method = info.method, .input = input});
      EXPECT_EQ(unit.value(77, 32769), unit.value(77, 32768));
      EXPECT_EQ(unit.value(77, 65535), unit.value(77, 32768));
    }
}

TEST(FixedPoint, DepthChangesNoValue) {
  const SpecularUnit shallow({.depth = 3}), deep({.depth = 20});
  EXPECT_EQ(shallow.config().depth, 3);
  EXPECT_EQ(deep.value(123, 32000), shallow.value(123, 32000));
}

TEST(FixedPoint, ScaleRoundsToTheNearestStep) {
  for (std::uint64_t z = 0; z <= 4096; ++z)
    EXPECT_NEAR(unit_scale(z, 12, 8), 255.0 * z / 4096, 0.5 + 1.0 / 16);
}

TEST(FixedPoint, TableWordsFitTheirWidth) {
  for (const UnitInfo& info : unit_methods())
    for (const int output_bits : {8, 10, 12})
      for (const UnitTable& table :
           SpecularUnit({.method = info.method, .cosine_bits = 17, .output_bits = output_bits}).tables())
        for (const std::uint64_t word : table.words)
          ASSERT_EQ(word >> table.width, 0U) << info.name << table.name;
}

TEST(FixedPoint, FieldsOutsideTheirDomainThrow) {
  EXPECT_THROW(SpecularUnit({.output_bits = 7}), Error);
  EXPECT_THROW(SpecularUnit({.output_bits = 13}), Error);
  EXPECT_THROW(SpecularUnit({.cosine_bits = 11}), Error);
  EXPECT_THROW(SpecularUnit({.cosine_bits = 21}), Error);
  EXPECT_THROW(SpecularUnit({.depth = 2}), Error);
  EXPECT_THROW(SpecularUnit({.depth = 21}), Error);
  EXPECT_THROW(SpecularUnit({.coefficient_bits = 12}), Error);
  EXPECT_THROW(SpecularUnit({.method = UnitMethod::paper, .coefficient_bits = 11}), Error);
  EXPECT_THROW(SpecularUnit({.method = UnitMethod::paper, .cosine_bits = 25}), Error);
  EXPECT_THROW(unit_method("cubic2"), Error);
  EXPECT_THROW(BlinnFront(11), Error);
  EXPECT_THROW(BlinnFront(25), Error);
}

Vec3 real(const FixedVec3& v) {
  return 1.0 / 65536 * Vec3{static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

TEST(FixedPointBlinn, VersineIsThatOfTheGivenWords) {
  Pcg32 random(5);
  for (const int bits : {12, 20, 24}) {
    const BlinnFront front(bits);
    for (int i = 0; i < 20000; ++i) {
      const FixedVec3 l = fixed_vec3(random_direction(random)), v = fixed_vec3(random_direction(random));
      const Vec3 h = real(l) + real(v);
      if (length(h) < 0.5) continue;
      Vec3 normal = random_direction(random);
      if (i % 2) normal = 1 / length(h) * h + 0.1 * random.uniform() * normal;
      const FixedVec3 n = fixed_vec3((0.5 + 0.5 * random.uniform()) / length(normal) * normal);
      const double cosine = dot(real(n), h) / (length(real(n)) * length(h));
      ASSERT_NEAR(std::ldexp(front.versine(n, l, v), -bits), 1 - std::max(0.0, cosine),
                  std::ldexp(0.5, -bits) + 0x1p-22);
    }
  }
}

TEST(FixedPointBlinn, CornersFollowTheDefinition) {
  const BlinnFront front(20);
  const FixedVec3 z = {0, 0, 65536}, down = {0, 0, -65536}, x = {65536, 0, 0}, back = {-65536, 0, 0};
  EXPECT_EQ(front.versine(z, z, z), 0U);
  EXPECT_EQ(front.versine(z, x, back), 0U) << "opposite directions: blinn_cosine is 1";
  EXPECT_EQ(front.versine(down, z, z), 1U << 20);
  EXPECT_EQ(front.versine(x, z, z), 1U << 20) << "grazing";
  EXPECT_NEAR(front.versine(z, x, z), (1 - std::sqrt(0.5)) * (1 << 20), 1);
}

}  // namespace
}  // namespace burnish
