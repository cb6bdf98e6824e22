// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/baselines/np_brdf.h>
#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/np_model.h>

namespace burnish {
namespace {

using enum NpBrdf::Value;

constexpr NpBrdf::Code kCode = {0.5f, -0.3f, 0.1f, 1.2f, -0.7f, 0.4f, 0.9f};

NpBrdf some_brdf(NpBrdf::Value value = reflectance) {
  return {random_np_decoder(1), kCode, value};
}

// The definition, by the angles.
std::vector<double> value_of(const NpDecoder& decoder, const HalfDiff& a) {
  NpDecoder::Inputs inputs{static_cast<float>((1 + std::cos(2 * a.phi_d)) / 2),
                           static_cast<float>((1 + std::sin(2 * a.phi_d)) / 2),
                           static_cast<float>(a.theta_h / kHalfPi), static_cast<float>(a.theta_d / kHalfPi)};
  std::copy(kCode.begin(), kCode.end(), inputs.begin() + 4);
  NpDecoder::Outputs outputs;
  decoder.decode({&inputs, 1}, {&outputs, 1});
  std::vector<double> f;
  for (const float y : outputs)
    f.push_back(std::exp(std::exp(std::exp(std::exp(0.15 * static_cast<double>(y)) - 1) - 1) - 1) - 1);
  return f;
}

TEST(NpBrdf, DecodesTheAnglesOfHalfAndDifferenceVector) {
  const auto decoder = random_np_decoder(1);
  const NpBrdf brdf(decoder, kCode, reflectance), with_a_cosine(decoder, kCode, with_cosine);
  std::vector<double> f(3);
  double largest = 0;
  for (const auto& [wi, wo] : draw_pairs(60, 2, false)) {
    const std::vector<double> expected = value_of(*decoder, to_half_diff(wi, wo));
    ASSERT_TRUE(brdf.eval(wi, wo, f));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(f[c], expected[c], 1e-5 * (1 + expected[c]));
    const double cosine = std::max((wi.z + wo.z) / 2, NpBrdf::kMinCosine);
    ASSERT_TRUE(with_a_cosine.eval(wi, wo, f));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(f[c] * cosine, expected[c], 1e-5 * (1 + expected[c]));
    largest = std::max(largest, expected[0]);
  }
  EXPECT_GT(largest, 0.01);
}

TEST(NpBrdf, GivesTheSameBitsAloneAsInASpan) {
  const NpBrdf brdf = some_brdf();
  std::vector<DirectionPair> pairs = draw_pairs(300, 3, false);
  for (std::size_t i = 0; i < pairs.size(); i += 7) pairs[i].wo.z *= -1;
  std::vector<double> values(3 * pairs.size()), f(3);
  std::vector<std::uint8_t> known(pairs.size());
  BrdfRef(brdf).eval(pairs, values, known);
  for (std::size_t i = 0; i < pairs.size(); i += 5) {
    EXPECT_TRUE(known[i]);
    EXPECT_TRUE(brdf.eval(pairs[i].wi, pairs[i].wo, f));
    for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(values[3 * i + c], f[c]) << i;
    if (i % 7 == 0) {
      EXPECT_EQ(f, std::vector<double>(3));
    }
  }
}

TEST(NpBrdf, IsReciprocalToTheLastBit) {
  for (const NpBrdf::Value value : {reflectance, with_cosine}) {
    const NpBrdf brdf = some_brdf(value);
    const SymmetrizedBrdf symmetrized(brdf);
    std::vector<DirectionPair> pairs = draw_pairs(500, 4, false);
    std::vector<double> f(3 * pairs.size()), exchanged(f.size());
    std::vector<std::uint8_t> known(pairs.size());
    brdf.eval(pairs, f, known);
    BrdfRef(symmetrized).eval(pairs, exchanged, known);
    EXPECT_EQ(f, exchanged);
    for (DirectionPair& pair : pairs) std::swap(pair.wi, pair.wo);
    brdf.eval(pairs, exchanged, known);
    EXPECT_EQ(f, exchanged);
  }
}

TEST(NpBrdf, IsFiniteAtTheCorners) {
  NpBrdf::Code code;
  code.fill(NpDecoder::kMaxWeight);
  const auto largest =
      std::make_shared<const NpDecoder>(std::vector<float>(NpDecoder::kWeights, NpDecoder::kMaxWeight));
  std::vector<double> f(3);
  for (const NpBrdf& brdf : {some_brdf(), some_brdf(with_cosine), NpBrdf(largest, code, with_cosine)})
    for (const Vec3 wi : {Vec3{0, 0, 1}, Vec3{1, 0, 1e-9}, Vec3{0.6, 0, 0.8}})
      for (const Vec3 wo : {Vec3{0, 0, 1}, Vec3{-1, 0, 1e-9}, Vec3{0.6, 0, 0.8}, Vec3{-0.6, 0, 0.8}}) {
        ASSERT_TRUE(brdf.eval(wi, wo, f));
        for (const double value : f) EXPECT_TRUE(std::isfinite(value) && value >= 0) << value;
      }
}

TEST(NpBrdf, RefusesNumbersThatAreNoCode) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), 1000.0f}) {
    NpBrdf::Code code = kCode;
    code[3] = bad;
    EXPECT_THROW(NpBrdf(random_np_decoder(1), code, reflectance), Error);
  }
}

}  // namespace
}  // namespace burnish
