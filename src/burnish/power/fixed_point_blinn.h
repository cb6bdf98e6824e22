// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include <burnish/math/vec3.h>
#include <burnish/power/fixed_point.h>

namespace burnish {

/// A direction as the hardware takes it: signed words of 18 bits with 16 fraction bits, in [-2, 2).
using FixedVec3 = std::array<std::int32_t, 3>;
inline constexpr int kFixedVec3FractionBits = 16;
/// Rounds to the nearest word. Domain: components in [-2, 2).
FixedVec3 fixed_vec3(Vec3 v) noexcept;

/// Blinn's v = 1 - n.h / (|n| |h|), h = l + v, from vectors of any length up to 2, as hw/rtl/burnish_blinn.sv
/// computes it, bit for bit: the input of a unit with UnitInput::versine.
class BlinnFront {
 public:
  /// Throws Error unless versine_bits is in [12, 24].
  explicit BlinnFront(int versine_bits = 20);

  /// In steps of 2^-versine_bits, in [0, 2^versine_bits]: 0 where l = -v, as blinn_cosine has it, full
  /// where the cosine is not above 0. Error for normals and half vectors of length 1/2 and more: half a step
  /// and 2^-22, beside the rounding of the vectors.
  std::uint32_t versine(const FixedVec3& n, const FixedVec3& l, const FixedVec3& v) const noexcept;

  /// Start and slope of 1/sqrt over [1, 4), the hardware's table.
  UnitTable table() const;

 private:
  int versine_bits_;
  std::array<std::uint32_t, 256> start_{}, slope_{};
};

}  // namespace burnish
