// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace burnish {

/// Texels side by side, so many in a row of floats.
inline constexpr std::size_t kTexelLanes = 32;
using TexelRow = std::array<float, kTexelLanes>;

/// One picture and channel of texels: measured values and the values of lobes with weight 1.
struct TexelPixels {
  std::size_t lobes;
  const float* model;  ///< the first lobe's; the next one is `stride` floats later
  std::size_t stride;
  const float* value;
};

/// Axes of texels' frames, rows of the x, y and z of tangent, bitangent and normal.
using TexelFrames = std::array<TexelRow, 9>;

/// Turns vectors into the frames, with length 1. `towards` are rows of x, y and z, unit vectors unless `any_length`.
/// Row r of the result begins at local + r * plane. Vectors shorter than 1e-15 become (0, 0, 1).
void turn_into(const TexelFrames& frames, const std::array<TexelRow, 3>& towards, bool any_length,
               float* local, std::size_t plane) noexcept;

/// Multiplies f by the cosine, in `rows` rows of the texels, and limits the products to `most`. Row r of f begins at
/// f + r * plane; rows of the result follow each other. Not-a-number stays.
void find_products(std::size_t rows, const float* f, std::size_t plane, const float* cosine, float most,
                   float* product) noexcept;

/// Lays out pixels' values, [texel][channel] of three channels, as rows [channel].
void take_apart(const float* values, TexelRow* rows) noexcept;

/// Sums the lobes times their weights, which are rows [lobe].
void sum_lobes(const TexelPixels& pixels, const TexelRow* weights, float* total) noexcept;

/// Finds the weight of each pixel's squared error. With x = max(exposure at, floor), it is the square of d (x^(1/2))
/// / d value. From x = 1 on, it is that square over x^2. It is multiplied by the pixel's own `share`.
void find_omega(float exposure, float floor, const float* at, const float* share, float* omega) noexcept;

/// All fitted pixels of the texels, picture by picture.
struct TexelPictures {
  std::size_t lobes, channels, pictures;
  const float* model;  ///< rows [picture][lobe][channel]
  const float* value;  ///< rows [picture][channel]
  const float* there;  ///< rows [picture]: 1 of pixels that count, else 0
  const float*
      clipped;  ///< rows [picture][channel]: 1 of values that are clipped, else 0; null: there are none
};

/// The weights of pixels in a pass. In the first pass, `of_measured`, they are find_omega of the measured values, and
/// all pixels are trusted alike. In the other passes they are find_omega of the mean of measured and modelled values,
/// and 0 for a clipped value below the model. Trust is then 1 / (1 + e / reach^2)^2 [GemanMcClure1987]. Here e is the
/// largest squared error of the channels; errors of values brighter than the model are first multiplied by
/// `brighter`.
struct TexelPass {
  bool of_measured;
  float exposure, floor, reach, brighter;
};

/// Finds the normal equations of a pass. The matrix has sums over pictures and channels of omega times products of
/// two lobes, lower triangles row by row. The vector has sums of omega times a lobe and the value. Sets trust, rows
/// [picture], except in the first pass, where it is not read.
void find_normal_equations(const TexelPictures& pictures, const TexelPass& pass, const TexelRow* weights,
                           float* trust, TexelRow* matrix, TexelRow* vector) noexcept;

/// Finds the weights w >= 0 with the least w^T A w / 2 - b^T w. A is the matrix of find_normal_equations, with
/// `ridge` times its mean diagonal and 1e-30 added. The method is block principal pivoting
/// [PortugalJudiceVicente1994]: unknowns below 0 are fixed at 0, and those that would rise from 0 are set free, all
/// at once. With `near` it begins with those free that are > 0, otherwise with all free.
///
/// Returns a bit for each texel that converged with weights below 1e30. The weights of the other texels, and of
/// equations that are not finite, stay as they were: solve_nonnegative (nonnegative.h) finds them.
std::uint32_t find_weights(std::size_t lobes, const TexelRow* matrix, const TexelRow* vector, double ridge,
                           bool near, TexelRow* weights) noexcept;

/// Finds clamp(exposure value, 0, 1)^(1/2.2), with an error of at most 1e-6.
void find_seen(float exposure, const float* value, float* seen) noexcept;

}  // namespace burnish
