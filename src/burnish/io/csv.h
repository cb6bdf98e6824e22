// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/io/byte_reader.h>
#include <burnish/io/sample_file.h>

namespace burnish {

/// Returns true if one of the first lines names columns of directions (csv_columns.h).
bool looks_like_csv(std::string_view text) noexcept;

/// Reads scattered samples from a table of text: remarks or none, a header that names the columns in any order, then
/// one row for each sample. Cells stand between commas, semicolons, tabs or blanks, in quotes or not. Decimals have a
/// point, or a comma if commas do not separate cells. Lines end as on any system.
///
/// Directions are theta_i, phi_i, theta_o, phi_o in degrees (in radians if the name says so), or wi_x, wi_y, wi_z,
/// wo_x, wo_y, wo_z; csv_columns.cpp lists other names for them. Without phi_i the material is isotropic. Without any
/// azimuth the samples lie in the plane of incidence, and polar angles have signs.
///
/// Values stand in one of these forms:
/// - r, g, b (linear Rec. 709), or value;
/// - value_400, 400nm and so on, one column for each wavelength;
/// - value beside a column wavelength (in nanometres, or in the unit of its name), one row for each wavelength.
///
/// Values are f_r in 1/sr unless the options or the columns' names say another kind (ValueKind). Rows without a value
/// are left out, and columns of unknown names are passed over. Findings::warnings names both, and whatever looks wrong
/// (sample_checks.h).
///
/// A comment "# isotropic" or "# anisotropic" states the material's symmetry. Without it, the material is anisotropic
/// unless every sample has the same phi_i. Throws Error on anything else. A direction below the horizon is such an
/// error, and so is a vector whose length is off 1 by over 1 %.
SampleFile parse_csv(const FileBytes& file, const OpenOptions& options);

/// Samples of the texels of a surface.
struct TexelCsv {
  std::vector<std::array<int, 2>> texels;  ///< column and row of each sample, from 0
  std::vector<std::uint8_t> held_out;      ///< 0 or 1 for each sample; empty if the file has no such column
  std::vector<DirectionPair> pairs;        ///< directions about the surface's normal
  std::vector<std::array<float, 3>> f;     ///< f_r in 1/sr; a column `value` fills all three
};

/// Returns true if the line of columns also names texel_x.
bool looks_like_texel_csv(std::string_view text) noexcept;

/// Reads a table as parse_csv does, with columns texel_x and texel_y, whole numbers from 0 to `most`. A column
/// held_out, 0 or 1, is optional. Values are r, g, b or value. Throws Error as parse_csv does.
TexelCsv parse_texel_csv(const FileBytes& file, int most);

/// Returns the text that parse_csv reads back to the same samples. `lambda_nm` names the columns of spectra,
/// which may have 1 or 3 channels too. Throws Error if the channels have no names.
std::string samples_csv(const Samples& samples, std::span<const double> lambda_nm = {});

/// Direction pairs, and their columns in the file's units.
struct DirectionTable {
  std::vector<DirectionPair> pairs;
  std::vector<std::string> names;  ///< names of the columns of directions, in the file's order
  std::vector<double> numbers;     ///< rows of as many numbers, in the file's units
};

/// Reads direction pairs under the header wi_x,wi_y,wi_z,wo_x,wo_y,wo_z or under angles, columns in any order.
/// Directions may lie in any half-space. Throws Error as parse_csv does.
DirectionTable parse_directions(const FileBytes& file);

}  // namespace burnish
