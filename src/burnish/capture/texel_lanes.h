#pragma once

#include <array>
#include <cstddef>

namespace burnish {

/// Texels side by side, so many in a row of floats.
inline constexpr std::size_t kTexelLanes = 32;
using TexelRow = std::array<float, kTexelLanes>;

/// One picture and channel of texels: what was measured, what lobes of weight 1 give, how pixels count.
struct TexelPixels {
  std::size_t lobes;
  const float* model;  ///< of the first lobe; the next stands `stride` floats on
  std::size_t stride;
  const float* value;
};

/// The sum of the lobes times weights, rows [lobe].
void sum_lobes(const TexelPixels& pixels, const TexelRow* weights, float* total) noexcept;

/// How the squared error of each pixel counts: the square of d (x^(1/2)) / d value, x = exposure times `at`, at least
/// `floor`; from 1 on that of 1 over x^2; times the pixel's own `share`.
void find_omega(float exposure, float floor, const float* at, const float* share, float* omega) noexcept;

/// Adds omega times products of the lobes to the lower triangles, row by row, and omega times those with the value.
void add_normal_equations(const TexelPixels& pixels, const float* omega, TexelRow* matrix,
                          TexelRow* vector) noexcept;

}  // namespace burnish
