// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace burnish {

/// The encoding of a texture's texels as bytes: each by itself, or pairs of numbers in blocks (see encode_bc5), in
/// [0, 1] or in [-1, 1].
enum class TexelBlocks { none, bc5_unorm, bc5_snorm };

/// "none", "bc5_unorm" or "bc5_snorm".
std::string_view to_string(TexelBlocks blocks) noexcept;

/// Pairs of numbers as texture units read them at a byte a texel: BC5 (RGTC2), blocks of 4 x 4 texels, row by row,
/// each channel two values of 8 bits and for every texel which of them it is, or a mixture. The numbers are in [0,
/// 1], or in [-1, 1] where `has_sign`; others are clamped, and not-a-number becomes 0. `pairs` are [y][x][2]; blocks
/// at the right and lower edge repeat their last texels. The values are searched for the least squared error: of what
/// spans r in a block some 0.04 r rms, besides the rounding to 1/255 or 1/127. Same bits for any number of threads.
/// Throws Error for sides below 0 and another count of numbers. Source: [DataFormat, BC5].
std::vector<std::byte> encode_bc5(int width, int height, std::span<const float> pairs, bool has_sign);

/// Returns the values that a texture unit decodes, [y][x][2]. Throws Error for another count of bytes.
std::vector<float> decode_bc5(int width, int height, std::span<const std::byte> blocks, bool has_sign);

}  // namespace burnish
