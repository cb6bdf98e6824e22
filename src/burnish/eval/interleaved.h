// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace burnish {

/// Splits vectors (x, y, z), stored one after the other as in most programs, into the planes that the evaluators
/// read. `rows` has 3 * count floats.
void to_planes(const float* rows, std::size_t count, float* x, float* y, float* z) noexcept;

}  // namespace burnish
