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

/// The baselines that this processor and build can run.
std::vector<PowerBaseline> power_baselines();

/// No powers but the least that a loop over memory can do, for AVX2 and AVX-512: a copy, one multiply-add a value, and
/// sixteen of them, whose time beside that of one is the arithmetic's alone. Their allowed error is -1.
std::vector<PowerBaseline> power_limits();

}  // namespace burnish
