#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace burnish {

/// A way to raise floats to one exponent that is not ours: what the kernels are measured against.
struct PowerBaseline {
  std::string name;
  void (*run)(std::span<const float> cosines, float exponent, std::span<float> out);
  double allowed_error;  ///< absolute, against the true power
};

/// The baselines that this processor and build can run. Only "fma_loop" is no power: out = a c + b, one instruction.
std::vector<PowerBaseline> power_baselines();

/// One fused multiply-add a value, the least that a loop over memory can do.
void fma_loop(std::span<const float> cosines, float a, std::span<float> out);

}  // namespace burnish
