// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <burnish/baselines/neural_brdf.h>
#include <burnish/error.h>
#include <burnish/parameterization/projection.h>

namespace burnish {

namespace {

// kernel^T x + bias; the kernel row by row, then the bias.
template <std::size_t Inputs, std::size_t Outputs>
std::array<double, Outputs> affine(const float*& weights, const std::array<double, Inputs>& x) noexcept {
  std::array<double, Outputs> y;
  const float* const bias = weights + Inputs * Outputs;
  for (std::size_t o = 0; o < Outputs; ++o) y[o] = bias[o];
  for (std::size_t i = 0; i < Inputs; ++i)
    for (std::size_t o = 0; o < Outputs; ++o) y[o] += x[i] * *weights++;
  weights += Outputs;
  return y;
}

template <std::size_t Count>
void cut_off_negatives(std::array<double, Count>& x) noexcept {
  for (double& value : x) value = std::max(value, 0.0);
}

}  // namespace

NeuralBrdf::NeuralBrdf(std::span<const float> weights) : weights_{} {
  if (weights.size() != kWeights)
    throw Error(fmt::format("neural encoding: expected {} weights, found {}", kWeights, weights.size()));
  for (std::size_t i = 0; i < kWeights; ++i)
    if (!(std::abs(weights[i]) <= kMaxWeight))
      throw Error(fmt::format("neural encoding: weight {}: expected a number within {} of 0, found {}", i + 1,
                              kMaxWeight, weights[i]));
  std::ranges::copy(weights, weights_.begin());
}

bool NeuralBrdf::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  if (wi.z <= 0 || wo.z <= 0) {
    std::ranges::fill(f, 0.0);
    return true;
  }

  // the network's inputs: half and difference vector, turned so that h lies over +x
  constexpr double kMaxExponent = 700;  // exp(700) is still finite
  const Vec3 h = half_vector(wi, wo), d = project(kProjectDifference, wi, wo);
  const float* weights = weights_.data();
  auto first = affine<kInputs, kHidden>(weights, {std::sqrt(h.x * h.x + h.y * h.y), 0, h.z, d.x, d.y, d.z});
  cut_off_negatives(first);
  auto second = affine<kHidden, kHidden>(weights, first);
  cut_off_negatives(second);

  // it was trained on log(1 + f)
  const auto x = affine<kHidden, kOutputs>(weights, second);
  for (std::size_t c = 0; c < kOutputs; ++c) f[c] = std::max(0.0, std::expm1(std::min(x[c], kMaxExponent)));
  return true;
}

}  // namespace burnish
