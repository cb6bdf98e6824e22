// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/io/byte_reader.h>
#include <burnish/reflectance/angle_table.h>
#include <burnish/reflectance/findings.h>

namespace burnish {

struct UtiaFile {
  AngleTable table;
  Findings findings;
};

/// Returns true if the bytes have the length of a UTIA file and are numbers that it may hold.
bool looks_like_utia(std::span<const std::byte> bytes) noexcept;

/// Returns phi_i, theta_i, theta_o and phi_o - phi_i of a UTIA table, without values: theta 0, 15 ... 75 degrees,
/// azimuths in steps of 7.5 degrees.
AngleTable utia_layout();

/// Reads a UTIA `.bin` file: 3 planes of red, green and blue, each f64 [theta_i][phi_i][theta_o][phi_o], 6 x 48 x 6 x
/// 48. A stored value v is f_r = 100 g(v / 140), where g is the transfer function of sRGB. This is the scale of
/// dj_brdf, which has it from the database's author; ALTA and UTIA-brdf take v as it is. Negative values are counted
/// and kept.
///
/// Values of f_r are interpolated linearly in the four angles. The azimuth of wo is relative to that of wi, so a
/// highlight turns with the light. The code of dj_brdf interpolates v instead, in the azimuth of wo itself. Between
/// nodes of a GGX of alpha 0.3 the two differ by .3 % on average and by 13 % at most. Values are constant from 75
/// degrees to the horizon, where nothing was measured. ALTA, UTIA-brdf and dj_brdf continue the last step's slope
/// there, which leads below zero.
///
/// Throws Error on another length or a value that is no float. The reader was checked against the indices of dj_brdf.h,
/// ALTA's data_utia and UTIA-brdf, but against no file of the database. Source: [Filip 2014].
UtiaFile parse_utia(const FileBytes& file);

/// Returns true if a UTIA file can hold the table as it is: RGB and the nodes of utia_layout.
bool fits_utia(const AngleTable& table) noexcept;

/// Returns the file that holds the table; reading it back gives the same values with one exception. Values between
/// 0.29024 and 0.29036 have no stored value and move to the nearer end. If the table was read from a file, every number
/// is written to 1.1 * 2^-24 of the file's, since tables hold floats. Holes become 0. Throws Error unless fits_utia.
std::string format_utia(const AngleTable& table);

}  // namespace burnish
