// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// A material encoded in the weights of a small network: the six coordinates of the half vector at phi_h = 0
/// and of the difference vector, two hidden layers of 21 units that cut off negative values, and three
/// outputs x that stand for f_r = exp(x) - 1, negative ones for 0. Isotropic, three channels (linear
/// Rec. 709), not reciprocal by construction. Published networks were trained with light and view exchanged
/// now and then: score them symmetrized. Source: [Sztrajman 2021].
class NeuralBrdf {
 public:
  static constexpr std::size_t kInputs = 6, kHidden = 21, kOutputs = 3;
  /// Kernels [input][output] and biases of the three layers, in their order: 675.
  static constexpr std::size_t kWeights =
      (kInputs + 1) * kHidden + (kHidden + 1) * kHidden + (kHidden + 1) * kOutputs;
  /// Weights beyond this are no encoding; within it no sum overflows.
  static constexpr float kMaxWeight = 1e6f;

  /// Throws Error unless there are kWeights finite weights within kMaxWeight of 0.
  explicit NeuralBrdf(std::span<const float> weights);

  static constexpr std::size_t channels() noexcept { return kOutputs; }
  static constexpr bool isotropic() noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  std::span<const float> weights() const noexcept { return weights_; }
  /// Returns the size as half floats, which the published weights bear without a visible loss.
  static constexpr std::size_t bytes() noexcept { return 2 * kWeights; }

 private:
  std::array<float, kWeights> weights_;
};

static_assert(Brdf<NeuralBrdf>);

}  // namespace burnish
