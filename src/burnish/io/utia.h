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

/// True if the bytes have the length of a UTIA file and are the numbers it may hold.
bool looks_like_utia(std::span<const std::byte> bytes) noexcept;

/// The phi_i, theta_i, theta_o and phi_o - phi_i of a UTIA table, without values: theta 0, 15 ... 75 degrees, azimuths
/// in steps of 7.5 degrees.
AngleTable utia_layout();

/// A UTIA `.bin` file: 3 planes of red, green and blue, each f64 [theta_i][phi_i][theta_o][phi_o], 6 x 48 x 6 x 48. A
/// stored value v is f_r = 100 g(v / 140), g the transfer function of sRGB: the scale of dj_brdf, which has it of the
/// database's author; ALTA and UTIA-brdf take v as it is. Negatives are counted and kept. f_r is interpolated linearly
/// in the four angles, the azimuth of wo relative to that of wi, so that a highlight turns with the light; dj_brdf
/// interpolates v, and in the azimuth of wo itself: between nodes of a GGX of alpha 0.3 the two differ by .3 % on
/// average and by 13 % at most. Constant from 75 degrees to the horizon, where nothing was measured: dj_brdf, ALTA and
/// UTIA-brdf continue the last step's slope there, which leads below zero. Throws Error on another length or a value
/// that is no float. Checked against the indices of dj_brdf.h, ALTA's data_utia and UTIA-brdf; no file of the database.
/// Source: [Filip 2014].
UtiaFile parse_utia(const FileBytes& file);

/// True if a UTIA file can hold the table as it is: RGB and the nodes of utia_layout.
bool fits_utia(const AngleTable& table) noexcept;

/// The file that holds the table: reading it back gives the same values, but for those between 0.29024 and 0.29036,
/// which no stored value stands for and which move to the nearer end. A file that was read is written with every number
/// to 1.1 * 2^-24 of it, since tables hold floats. Holes become 0. Throws Error unless fits_utia.
std::string format_utia(const AngleTable& table);

}  // namespace burnish
