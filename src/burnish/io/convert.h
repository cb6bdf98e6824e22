#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/source.h>

namespace burnish {

/// Names of the formats that convert writes. "exr", slices for a viewer, cannot be read back. "model" and "burnish" are
/// the two files of a model, format_model's and format_compact's.
std::vector<std::string_view> convert_formats();

struct ConvertOptions {
  std::size_t count =
      100'000;             ///< samples drawn for "astm", "csv" and "openmaterial" of a source not scattered
  std::uint64_t seed = 1;  ///< of these
  bool entries = false;    ///< instead of drawing: every entry of a table that is no hole
  int cells = 90;  ///< along each polar angle of "merl", "mbsdf" and "exr"; twice as many along the azimuth
  bool notes = false;  ///< keep the fit's notes in "burnish"
};

struct Converted {
  std::string bytes;
  std::vector<std::string> losses;  ///< what the bytes say less than the source's file, a phrase each
  std::vector<std::string>
      notes;  ///< what they say otherwise, without a loss: "TIS is that of the values now"
  std::vector<std::string> warnings;  ///< why the result may be of little use, a sentence each
  bool resampled = false;             ///< values were sampled anew, at cells or nodes
};

/// Off by more, a conversion warns: the figure `relative` of its values.
inline constexpr double kFarFromSource = 0.2;

/// A source in another format. Tables that the format holds are kept entry by entry; others are sampled at
/// its nodes: half/difference cells 90 x 90 x 180 (MERL, slices), angle cells 90 x 90 x 180 (MBSDF),
/// zemax_layout, utia_layout, RglOptions{}, cells of a tensor tree (32 along an axis of its own squares,
/// fewer below 64 `cells`; cubes of values within 0.1 % become one). Isotropic formats get the azimuth's mean
/// of anisotropic sources, those with one side of the plane of incidence or of the exchange of directions the
/// mean of both. Scattered formats keep scattered samples; of other sources they get the table's entries, if
/// asked for, or samples drawn by `measure`. Where values were sampled anew, a loss states how far they are (a
/// warning too above kFarFromSource): the figure `relative` of metrics/error_figures.h over 2,000 drawn pairs.
/// Throws Error, naming the source, for an unknown format, cells outside [2, 1000], "model" and "burnish" of a
/// source that is no model, channels that the format has not, or entries of a source without any.
Converted convert(const Source& source, std::string_view format, const ConvertOptions& options = {});

/// Whether table_entries has an answer.
bool has_entries(const Source& source) noexcept;

/// Every entry of a table that is no hole, both directions above the horizon; see ConvertOptions::entries.
/// Throws Error, naming the source, if it is no table.
Samples table_entries(const Source& source);

}  // namespace burnish
