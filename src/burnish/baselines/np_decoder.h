// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace burnish {

/// The network that the materials of a Neural Processes model share: units 11, six times 400, 3, each layer
/// an affine map that cuts off negative values. It turns four numbers of the directions and seven of the
/// material into a colour; NpBrdf says what they mean. Source: [Zheng 2021].
class NpDecoder {
 public:
  static constexpr std::array<std::size_t, 8> kUnits = {11, 400, 400, 400, 400, 400, 400, 3};
  static constexpr std::size_t kInputs = kUnits.front(), kOutputs = kUnits.back();
  /// Multiply-adds of one evaluation, and weights: kernels and biases.
  static constexpr std::size_t kProducts = 805'600, kWeights = 808'003;
  /// Weights beyond this are no decoder; within it, and with inputs within it, no sum overflows.
  static constexpr float kMaxWeight = 100;

  using Inputs = std::array<float, kInputs>;
  using Outputs = std::array<float, kOutputs>;

  /// Layer by layer the kernel [input][output] and then the biases. Throws Error unless there are kWeights
  /// finite weights within kMaxWeight of 0.
  explicit NpDecoder(std::span<const float> weights);

  /// outputs[i] of inputs[i], >= 0. In floats, on the widest vectors of the processor: within 1e-4 of the
  /// largest output of what double precision gives. The same bits for an input alone as among others. Fast
  /// for spans: a few inputs take as long as 32. Both spans have one size.
  void decode(std::span<const Inputs> inputs, std::span<Outputs> outputs) const noexcept;

  static constexpr std::size_t bytes() noexcept { return sizeof(float) * kWeights; }

 private:
  std::vector<float> packed_;  // as the kernel reads them
};

}  // namespace burnish
