// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

namespace burnish {

/// Op::exponent_of splits a float c > 0 as m 2^n with m in [kLeastMantissa, 2 kLeastMantissa), by the bits of this float:
/// what the bits of c exceed it by holds n above the 23 of the mantissa.
inline constexpr std::int32_t kLeastMantissaBits = 0x3f251eb8;
inline constexpr double kLeastMantissa = std::bit_cast<float>(kLeastMantissaBits);  ///< 0.645

}  // namespace burnish
