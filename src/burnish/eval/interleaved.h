#pragma once

#include <cstddef>

namespace burnish {

/// Vectors (x, y, z) one after the other, as most programs keep them, into the planes that the evaluators
/// read: rows has 3 * count floats.
void to_planes(const float* rows, std::size_t count, float* x, float* y, float* z) noexcept;

}  // namespace burnish
