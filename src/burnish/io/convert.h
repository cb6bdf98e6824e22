// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/source.h>

namespace burnish {

/// Returns the names of the formats that convert writes. "exr", slices for a viewer, cannot be read back. "model" and
/// "burnish" are the two files of a model: the bytes of format_model and of format_compact.
std::vector<std::string_view> convert_formats();

struct ConvertOptions {
  std::size_t count =
      100'000;  ///< samples drawn for "astm", "csv" and "openmaterial" if the source is not scattered
  std::uint64_t seed = 1;  ///< seed of these samples
  bool entries = false;    ///< write every known entry of a table instead of drawing samples
  /// Cells along each polar angle of "merl", "mbsdf" and "exr", twice as many along the azimuth. convert says what they
  /// mean for "tensortree" and "klems".
  int cells = 90;
  bool notes = false;  ///< keep the fit's notes in "burnish"
};

struct Converted {
  std::string bytes;
  std::vector<std::string> losses;  ///< what the source's file holds and the bytes do not, a phrase each
  std::vector<std::string>
      notes;  ///< what differs without a loss, a phrase each: "TIS is that of the values now"
  std::vector<std::string> warnings;  ///< why the result may be of little use, a sentence each
  bool resampled = false;             ///< values were sampled anew, at cells or nodes
};

/// A conversion warns if the figure `relative` of its values exceeds this number.
inline constexpr double kFarFromSource = 0.2;

/// Converts a source to another format. Tables that the format can hold are kept entry by entry. Other sources
/// are sampled at the nodes of the format:
/// - MERL and slices: 90 x 90 x 180 half/difference cells;
/// - MBSDF: 90 x 90 x 180 angle cells;
/// - Klems XML: means over pairs of patches, which keep each patch's energy; 145 x 145 of the full basis, below 45
///   `cells` 41 x 41 of the quarter basis;
/// - Speos, Zemax, UTIA and RGL: the nodes of speos_layout, zemax_layout, utia_layout and RglOptions{};
/// - tensor tree: cells, 32 along each axis of its squares, fewer below 64 `cells`; cubes whose values agree
///   within 0.1 % become one.
///
/// Isotropic formats get the azimuth's mean of anisotropic sources. Formats that hold one side of the plane of
/// incidence, or one order of the two directions, get the mean of both. Scattered formats keep scattered samples. From
/// other sources they get samples drawn by `measure`, or the table's entries if the options say so.
///
/// If values were sampled anew, a loss states how far they are from the source, and above kFarFromSource a
/// warning does too: the figure `relative` of metrics/error_figures.h over 2,000 drawn pairs. Throws Error,
/// naming the source, for an unknown format or cells outside [2, 1000]. Throws it too if the format is "model"
/// or "burnish" and the source is no model. Throws it for channels that the format cannot hold, and for
/// entries of a source that has none.
Converted convert(const Source& source, std::string_view format, const ConvertOptions& options = {});

/// Converts several parts of one surface into one file, each as convert does. Throws Error if the format holds one part
/// alone. Throws it too if one part and band come twice, and as convert does.
Converted convert_parts(std::span<const Source> parts, std::string_view format,
                        const ConvertOptions& options = {});

/// Returns true if table_entries can read the source's entries.
bool has_entries(const Source& source) noexcept;

/// Returns every known entry of a table with both directions above the horizon, see ConvertOptions::entries.
/// Throws Error, naming the source, if the source is no table.
Samples table_entries(const Source& source);

}  // namespace burnish
