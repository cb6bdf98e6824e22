// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace burnish {

/// The storage of a table's values. A texel is the values of one node, its channels side by side; m is the largest of
/// them. For a positive value within the format's range, and not below its smallest:
/// - half: 2 bytes a value, IEEE 754 binary16; off by at most 2^-11 of the value from 2^-14 to 65504, below
///   that by at most 2^-25;
/// - single: 4 bytes a value, exact;
/// - rgb9e5: 4 bytes a texel of three channels, 9-bit mantissas with a common exponent of 5 bits; off by at
///   most m / 511, or 2^-25 if that is more, up to 65408. A channel far below its texel's largest has fewer
///   bits;
/// - unorm8: 1 byte a value, byte / 255 (a lobe's scale is the scale); off by at most 1 / 510, up to 1.
enum class TableFormat { half, single, rgb9e5, unorm8 };

/// "half", "float", "rgb9e5" or "unorm8".
std::string_view to_string(TableFormat format) noexcept;

/// Reads what to_string writes; none on anything else.
std::optional<TableFormat> find_table_format(std::string_view name) noexcept;

/// Reads what to_string writes; throws Error on anything else.
TableFormat parse_table_format(std::string_view name);

/// True but for rgb9e5, which has three channels.
bool holds_channels(TableFormat format, std::size_t channels) noexcept;

/// Bytes of a texel; holds_channels must be true.
std::size_t texel_bytes(TableFormat format, std::size_t channels) noexcept;

/// Encodes finite values > 0, channels interleaved, each to the nearest that the format holds (rgb9e5:
/// nearest with its texel's exponent), but never to 0: what would be, becomes the smallest positive value
/// (rgb9e5: 1 in the mantissa), and what is above the range the largest. Little-endian; texel_bytes() *
/// texels bytes; rgb9e5 as GL_RGB9_E5 and VK_FORMAT_E5B9G9R9_UFLOAT_PACK32 lay it out, red in the lowest bits
/// [EXT_texture_shared_exponent].
std::vector<std::byte> pack(TableFormat format, std::size_t channels, std::span<const float> values);

/// The values that pack's bytes stand for; exact.
std::vector<float> unpack(TableFormat format, std::size_t channels, std::span<const std::byte> bytes);

/// The values as they are after storing: unpack(pack(values)). Rounding twice changes nothing.
std::vector<float> round_to_format(TableFormat format, std::size_t channels, std::span<const float> values);

}  // namespace burnish
