#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <burnish/io/byte_reader.h>
#include <burnish/io/sample_file.h>

namespace burnish {

/// True if the first line that is no comment names direction columns.
bool looks_like_csv(std::string_view text) noexcept;

/// Scattered samples as comma-separated values: '#' comments, a header naming the columns in any order, then
/// one row a sample. Directions are theta_i, phi_i, theta_o, phi_o in degrees (in radians where the name ends
/// in _rad), or wi_x, wi_y, wi_z, wo_x, wo_y, wo_z; values are r, g, b (linear Rec. 709), or value, or
/// value_400 and so on, one column a wavelength in nm. Values are f_r in 1/sr, or f_r cos(theta_i) if
/// options.has_cosine. A comment "# isotropic" or "# anisotropic" says what the material is; without it, it
/// is anisotropic unless every sample has the same phi_i. Throws Error on anything else, a direction below the
/// horizon and vectors whose length is off 1 by over 1 % included.
SampleFile parse_csv(const FileBytes& file, const OpenOptions& options);

/// The text that parse_csv reads back to the same samples. `lambda_nm` names the columns where there are
/// neither 1 nor 3 channels, or spectra of 1 or 3. Throws Error if the channels have no names.
std::string samples_csv(const Samples& samples, std::span<const double> lambda_nm = {});

/// Direction pairs with the header wi_x,wi_y,wi_z,wo_x,wo_y,wo_z (columns in any order); any half-space.
/// Throws Error as parse_csv does.
std::vector<DirectionPair> parse_directions(const FileBytes& file);

}  // namespace burnish
