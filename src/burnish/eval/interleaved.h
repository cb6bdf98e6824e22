#pragma once

#include <cstddef>

namespace burnish {

/// Vectors (x, y, z) one after the other, as most programs keep them, into the planes that the evaluators
/// read: rows has 3 * count floats.
void to_planes(const float* rows, std::size_t count, float* x, float* y, float* z) noexcept;

/// And back. Rows written by to_rows are read by to_planes to the same bits.
void to_rows(const float* x, const float* y, const float* z, std::size_t count, float* rows) noexcept;

}  // namespace burnish
