// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <burnish/factors/model_spec.h>
#include <burnish/factors/table.h>

namespace burnish {

/// Bytes of a number that a model stores beside its tables: a scale, a warp's parameter, a projection's coefficient.
inline constexpr std::size_t kNumberBytes = 4;

/// Counts a model's bytes piece by piece, as FactoredBrdf::bytes says. Every budget is kept by this count.
class ByteCount {
 public:
  /// Adds the texels and, for each axis whose spacing is no identity, a number.
  void add_table(const TableLayout& layout, std::size_t texel_bytes) noexcept;
  /// Adds a number for the scale of each channel.
  void add_lobe(std::size_t channels) noexcept { numbers_ += channels; }
  /// Adds the coefficients of the projections that a table of this shape is looked up by.
  void add_use(const FactorUse& use, TableShape shape) noexcept;

  std::size_t bytes() const noexcept { return texels_ + numbers_ * kNumberBytes; }

 private:
  std::size_t texels_ = 0;  ///< their bytes
  std::size_t numbers_ = 0;
};

/// FactoredBrdf::bytes of a model of the spec. Tables without a format of their own are in `general`, see format_of,
/// which holds_channels must allow.
std::size_t model_bytes(const ModelSpec& spec, std::size_t channels, TableFormat general) noexcept;

/// The same where a texel of each table takes `texel_bytes`, and of a shared table shared_texel_bytes; the tables'
/// own formats do not count.
std::size_t model_bytes(const ModelSpec& spec, std::size_t channels, std::size_t texel_bytes) noexcept;

/// Bytes of a texel of one channel beside texels of `channels`, at least 1, that take `texel_bytes` each. Three
/// channels in four bytes share an exponent, which serves no single channel: its table is half.
std::size_t shared_texel_bytes(std::size_t channels, std::size_t texel_bytes) noexcept;

}  // namespace burnish
