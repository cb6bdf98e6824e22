// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/baselines/neural_brdf.h>
#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {
namespace {

using Weights = std::vector<float>;

Weights random_weights(std::uint64_t seed) {
  Pcg32 random(seed);
  Weights weights(NeuralBrdf::kWeights);
  for (float& w : weights) w = static_cast<float>(random.uniform() - 0.45);
  return weights;
}

// The definition, in the angles of the half and difference vectors.
std::vector<double> network(const Weights& weights, const HalfDiff& a) {
  std::vector<double> x{std::sin(a.theta_h),
                        0,
                        std::cos(a.theta_h),
                        std::sin(a.theta_d) * std::cos(a.phi_d),
                        std::sin(a.theta_d) * std::sin(a.phi_d),
                        std::cos(a.theta_d)};
  std::size_t at = 0;
  for (const std::size_t outputs : {21u, 21u, 3u}) {
    std::vector<double> y(outputs);
    for (std::size_t o = 0; o < outputs; ++o) {
      y[o] = weights[at + x.size() * outputs + o];
      for (std::size_t i = 0; i < x.size(); ++i) y[o] += weights[at + i * outputs + o] * x[i];
      if (outputs != 3) y[o] = std::max(y[o], 0.0);
    }
    at += (x.size() + 1) * outputs;
    x = y;
  }
  for (double& value : x) value = std::max(0.0, std::exp(value) - 1);
  return x;
}

TEST(NeuralBrdf, EvaluatesTheNetworkOfItsDefinition) {
  const Weights weights = random_weights(1);
  const NeuralBrdf brdf(weights);
  std::vector<double> f(3);
  for (const auto& [wi, wo] : draw_pairs(500, 2, false)) {
    ASSERT_TRUE(brdf.eval(wi, wo, f));
    const std::vector<double> expected = network(weights, to_half_diff(wi, wo));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(f[c], expected[c], 1e-9 * (1 + expected[c]));
  }
}

TEST(NeuralBrdf, IsFiniteAndNotNegativeForTheLargestWeights) {
  std::vector<double> f(3);
  for (const float sign : {1.0f, -1.0f}) {
    const NeuralBrdf brdf(Weights(NeuralBrdf::kWeights, sign * NeuralBrdf::kMaxWeight));
    for (const Vec3 wi : {Vec3{0, 0, 1}, Vec3{1, 0, 1e-9}, Vec3{0.6, 0, 0.8}})
      for (const Vec3 wo : {Vec3{0, 0, 1}, Vec3{-1, 0, 1e-9}, Vec3{0, 0.6, 0.8}}) {
        ASSERT_TRUE(brdf.eval(wi, wo, f));
        for (const double value : f) EXPECT_TRUE(std::isfinite(value) && value >= 0);
      }
  }
}

TEST(NeuralBrdf, IsIsotropicAndBlackBelowTheHorizon) {
  const NeuralBrdf brdf(random_weights(3));
  std::vector<double> f(3), turned(3);
  Pcg32 random(4);
  for (const auto& [wi, wo] : draw_pairs(200, 5, false)) {
    const double phi = kTwoPi * random.uniform(), c = std::cos(phi), s = std::sin(phi);
    const auto turn = [&](Vec3 w) { return Vec3{c * w.x - s * w.y, s * w.x + c * w.y, w.z}; };
    brdf.eval(wi, wo, f);
    brdf.eval(turn(wi), turn(wo), turned);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(f[k], turned[k], 1e-9 * (1 + f[k]));
    EXPECT_TRUE(brdf.eval({wi.x, wi.y, -wi.z}, wo, f));
    EXPECT_EQ(f, std::vector<double>(3));
  }
}

TEST(NeuralBrdf, RefusesOtherWeights) {
  EXPECT_THROW(NeuralBrdf(Weights(674)), Error);
  EXPECT_THROW(NeuralBrdf(Weights(676)), Error);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2e6f}) {
    Weights weights(NeuralBrdf::kWeights);
    weights[100] = bad;
    EXPECT_THROW(NeuralBrdf{weights}, Error);
  }
}

}  // namespace
}  // namespace burnish
