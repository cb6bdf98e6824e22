// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include <burnish/io/byte_reader.h>
#include <burnish/math/spectrum.h>

namespace burnish {

/// Reads a text file of rows: wavelength in nm, increasing, and relative power. There are at least two rows; blank
/// lines and lines that start with '#' are passed over. Throws Error for anything else, or a power that is not finite
/// or below zero.
Illuminant parse_illuminant(const FileBytes& file);

/// Returns a standard_illuminant by its name, or parse_illuminant of a file. Throws Error if `spec` is neither.
Illuminant open_illuminant(const std::string& spec);

/// Returns rec709_weights of a file's wavelengths under open_illuminant(spec). Throws Error as these functions do,
/// naming the file if its wavelengths are wrong.
std::vector<std::array<double, 3>> rec709_weights_of(const std::string& file,
                                                     std::span<const double> lambda_nm,
                                                     const std::string& spec);

/// Returns the name of an illuminant in findings: "equal energy" for "E".
std::string illuminant_name(const std::string& spec);

}  // namespace burnish
