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

/// True if one of the first lines names columns of directions (csv_columns.h).
bool looks_like_csv(std::string_view text) noexcept;

/// Scattered samples as a table of text: perhaps lines of remarks, a header naming the columns in any order, then
/// one row a sample. Cells stand between commas, semicolons, tabs or blanks, in quotes or not; decimals have a
/// point, or a comma where it separates nothing; lines end as on any system.
///
/// Directions are theta_i, phi_i, theta_o, phi_o in degrees (in radians where the name says so), or wi_x, wi_y,
/// wi_z, wo_x, wo_y, wo_z; other names for them are in csv_columns.cpp. Without phi_i the material is isotropic;
/// without any azimuth the samples are in the plane of incidence and polar angles have signs. Values are r, g, b
/// (linear Rec. 709), or value, or value_400, 400nm and so on, one column a wavelength, or value beside a column
/// wavelength (nanometres, or the unit of its name), one row a wavelength. They are f_r in 1/sr, or what options or their names say (ValueKind). Rows without a value are left out, columns that mean nothing are
/// passed over; Findings::warnings says so, and what looks wrong (sample_checks.h).
///
/// A comment "# isotropic" or "# anisotropic" says what the material is; without it, it is anisotropic unless every
/// sample has the same phi_i. Throws Error on anything else, a direction below the horizon and vectors whose length
/// is off 1 by over 1 % included.
SampleFile parse_csv(const FileBytes& file, const OpenOptions& options);

/// Samples of the texels of a surface.
struct TexelCsv {
  std::vector<std::array<int, 2>> texels;  ///< one a sample: column and row, from 0
  std::vector<std::uint8_t> held_out;      ///< one a sample, 0 or 1; empty: the file does not say
  std::vector<DirectionPair> pairs;        ///< about the surface's normal
  std::vector<std::array<float, 3>> f;     ///< f_r in 1/sr; of a column `value` the same three times
};

/// True if that line also names a column texel_x.
bool looks_like_texel_csv(std::string_view text) noexcept;

/// As parse_csv, with columns texel_x and texel_y, whole numbers from 0 to `most`, and perhaps held_out, 0 or 1;
/// values are r, g, b or value. Throws Error as parse_csv does.
TexelCsv parse_texel_csv(const FileBytes& file, int most);

/// The text that parse_csv reads back to the same samples. `lambda_nm` names the columns where there are
/// neither 1 nor 3 channels, or spectra of 1 or 3. Throws Error if the channels have no names.
std::string samples_csv(const Samples& samples, std::span<const double> lambda_nm = {});

/// Direction pairs, and their columns as the file has them.
struct DirectionTable {
  std::vector<DirectionPair> pairs;
  std::vector<std::string> names;  ///< of the columns of directions, in the file's order
  std::vector<double> numbers;     ///< rows of as many, in the file's units
};

/// Direction pairs with the header wi_x,wi_y,wi_z,wo_x,wo_y,wo_z or angles (columns in any order); any half-space.
/// Throws Error as parse_csv does.
DirectionTable parse_directions(const FileBytes& file);

}  // namespace burnish
