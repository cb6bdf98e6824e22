// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/baselines/np_decoder.h>
#include <burnish/error.h>
#include <burnish/testing/np_model.h>

namespace burnish {
namespace {

using Inputs = NpDecoder::Inputs;
using Outputs = NpDecoder::Outputs;

std::vector<Inputs> random_inputs(std::size_t count) {
  Pcg32 random(3);
  std::vector<Inputs> inputs(count);
  for (Inputs& all : inputs)
    for (float& input : all) input = static_cast<float>(random.uniform());
  return inputs;
}

// The definition.
std::vector<double> network(const std::vector<float>& weights, const Inputs& inputs) {
  std::vector<double> x(inputs.begin(), inputs.end());
  const float* kernel = weights.data();
  for (std::size_t layer = 0; layer + 1 < NpDecoder::kUnits.size(); ++layer) {
    const std::size_t outputs = NpDecoder::kUnits[layer + 1];
    const float* bias = kernel + x.size() * outputs;
    std::vector<double> y(bias, bias + outputs);
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t o = 0; o < outputs; ++o) y[o] += x[i] * kernel[i * outputs + o];
    for (double& value : y) value = std::max(value, 0.0);
    kernel = bias + outputs;
    x = y;
  }
  return x;
}

TEST(NpDecoder, EvaluatesTheNetworkOfItsDefinition) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const std::vector<float> weights = random_np_weights(seed);
    const std::vector<Inputs> inputs = random_inputs(20);
    std::vector<Outputs> found(inputs.size());
    NpDecoder(weights).decode(inputs, found);
    std::vector<std::vector<double>> expected;
    double largest = 0;
    for (const Inputs& one : inputs) {
      expected.push_back(network(weights, one));
      largest = std::max(largest, std::ranges::max(expected.back()));
    }
    ASSERT_GT(largest, 0.01);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      for (std::size_t c = 0; c < NpDecoder::kOutputs; ++c)
        EXPECT_NEAR(found[i][c], expected[i][c], 1e-4 * largest);
  }
}

TEST(NpDecoder, GivesTheSameBitsAloneAsAmongOthers) {
  const NpDecoder decoder(random_np_weights(4));
  const std::vector<Inputs> inputs = random_inputs(67);
  std::vector<Outputs> together(inputs.size());
  decoder.decode(inputs, together);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    Outputs alone;
    decoder.decode({&inputs[i], 1}, {&alone, 1});
    EXPECT_EQ(alone, together[i]) << i;
  }
  decoder.decode({}, {});
}

TEST(NpDecoder, IsFiniteForTheLargestWeightsAndInputs) {
  constexpr float kMax = NpDecoder::kMaxWeight;
  Inputs inputs;
  inputs.fill(kMax);
  for (const float sign : {1.0f, -1.0f}) {
    Outputs outputs;
    NpDecoder(std::vector<float>(NpDecoder::kWeights, sign * kMax)).decode({&inputs, 1}, {&outputs, 1});
    for (const float value : outputs) EXPECT_TRUE(std::isfinite(value) && value >= 0) << value;
  }
}

TEST(NpDecoder, CountsItsWeights) {
  std::size_t products = 0, biases = 0;
  for (std::size_t layer = 0; layer + 1 < NpDecoder::kUnits.size(); ++layer) {
    products += NpDecoder::kUnits[layer] * NpDecoder::kUnits[layer + 1];
    biases += NpDecoder::kUnits[layer + 1];
  }
  EXPECT_EQ(products, NpDecoder::kProducts);
  EXPECT_EQ(products + biases, NpDecoder::kWeights);
}

TEST(NpDecoder, RefusesOtherWeights) {
  std::vector<float> weights(NpDecoder::kWeights);
  EXPECT_THROW(NpDecoder(std::span(weights).first(weights.size() - 1)), Error);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity(), 101.0f}) {
    weights[500'000] = bad;
    EXPECT_THROW(NpDecoder{weights}, Error);
  }
}

}  // namespace
}  // namespace burnish
