// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace burnish {

/// Small seeded generator (PCG32: 64-bit state, 32-bit output). The same seed and stream give the same
/// numbers on every machine. Source: [O'Neill 2014].
class Pcg32 {
 public:
  explicit constexpr Pcg32(std::uint64_t seed, std::uint64_t stream = 0) noexcept
      : increment_(2 * stream + 1) {
    next();
    state_ += seed;
    next();
  }

  /// Uniform 32-bit integer.
  constexpr std::uint32_t next() noexcept {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ULL + increment_;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
    const auto rotation = static_cast<std::uint32_t>(old >> 59);
    return (shifted >> rotation) | (shifted << ((32 - rotation) & 31));
  }

  /// Uniform in [0, 1), 53 bits.
  constexpr double uniform() noexcept {
    const std::uint64_t high = next(), low = next();
    return static_cast<double>(((high << 32) | low) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_ = 0;
  std::uint64_t increment_;
};

}  // namespace burnish
