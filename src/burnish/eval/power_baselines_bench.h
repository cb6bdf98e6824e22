// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace burnish {

/// A way from outside the library to raise floats to one exponent, with which the kernels are compared.
struct PowerBaseline {
  std::string name;
  void (*run)(std::span<const float> cosines, float exponent, std::span<float> out);
  double allowed_error;  ///< absolute, against the true power
};

/// The baselines that this processor and build can run.
std::vector<PowerBaseline> power_baselines();

/// Not powers, but the least work that a loop over memory can do, for AVX2 and AVX-512: a copy, one multiply-add a
/// value, and sixteen multiply-adds. The difference of the last two is the time of the arithmetic alone. Their
/// allowed error is -1.
std::vector<PowerBaseline> power_limits();

}  // namespace burnish
