#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

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

/// Axes of texels' frames, rows of the x, y and z of tangent, bitangent and normal.
using TexelFrames = std::array<TexelRow, 9>;

/// Vectors as the frames see them, of length 1: `towards` are rows of x, y and z, unit vectors but where `any_length`;
/// row r of the result begins at local + r * plane. What is shorter than 1e-15 is taken for (0, 0, 1).
void turn_into(const TexelFrames& frames, const std::array<TexelRow, 3>& towards, bool any_length,
               float* local, std::size_t plane) noexcept;

/// f times the cosine, at most `most`, of the texels in so many rows: row r of f begins at f + r * plane, rows of the
/// result stand together. Not-a-number stays.
void find_products(std::size_t rows, const float* f, std::size_t plane, const float* cosine, float most,
                   float* product) noexcept;

/// Pixels' values, [texel][channel] of three channels, as rows [channel].
void take_apart(const float* values, TexelRow* rows) noexcept;

/// The sum of the lobes times weights, rows [lobe].
void sum_lobes(const TexelPixels& pixels, const TexelRow* weights, float* total) noexcept;

/// How the squared error of each pixel counts: the square of d (x^(1/2)) / d value, x = exposure times `at`, at least
/// `floor`; from 1 on that of 1 over x^2; times the pixel's own `share`.
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

/// How pixels count in a pass. The first, `of_measured`: as find_omega says of the measured values, all trusted alike.
/// Any other: of the mean of measured and modelled values, not at all where a clipped one is below the model; trusted
/// by the largest of the channels' squared errors e, those of what is brighter than the model times `brighter`, as
/// 1 / (1 + e / reach^2)^2 [GemanMcClure1987].
struct TexelPass {
  bool of_measured;
  float exposure, floor, reach, brighter;
};

/// The normal equations of a pass: sums over pictures and channels of omega times products of the lobes, the lower
/// triangles row by row, and omega times those with the value. Sets trust, rows [picture], but in the first pass, where
/// it is not read.
void find_normal_equations(const TexelPictures& pictures, const TexelPass& pass, const TexelRow* weights,
                           float* trust, TexelRow* matrix, TexelRow* vector) noexcept;

/// The weights w >= 0 with the least w^T A w / 2 - b^T w, A as find_normal_equations gives it with `ridge` times its
/// mean diagonal and 1e-30 added, by block principal pivoting [PortugalJudiceVicente1994]: what is below 0 is fixed at
/// 0, what would rise from there is set free, all at once. Begins with those free that are > 0, or unless `near` with
/// all. Returns bits of the texels that it ended for, with weights below 1e30; those of others, and of equations that
/// are not finite, are as they were: solve_nonnegative (nonnegative.h) finds them.
std::uint32_t find_weights(std::size_t lobes, const TexelRow* matrix, const TexelRow* vector, double ridge,
                           bool near, TexelRow* weights) noexcept;

/// clamp(exposure value, 0, 1)^(1/2.2), off by at most 1e-6.
void find_seen(float exposure, const float* value, float* seen) noexcept;

}  // namespace burnish
