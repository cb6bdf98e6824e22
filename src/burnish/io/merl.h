// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/half_diff_table.h>

namespace burnish {

struct MerlFile {
  HalfDiffTable table;
  Findings findings;
};

/// Returns true if the bytes start with three table sizes that a MERL file may have.
bool looks_like_merl(std::span<const std::byte> bytes) noexcept;

/// Reads a MERL .binary table: i32 sizes of theta_h, theta_d, phi_d, then f64 planes of red, green and blue.
/// 360 entries of phi_d are a full circle, any other count is half of it. Entries below the horizon, and
/// entries of -1 in all channels, are holes. Other negative values are counted and kept. Values are linear
/// Rec. 709, as the database states. Throws Error if the sizes and the file's length differ or a value above
/// the horizon is not finite. Source: [Matusik 2003].
MerlFile parse_merl(const FileBytes& file);

/// Returns true if a MERL file can hold the table as it is. The table has to be grey or RGB, and to cover the
/// full circle of phi_d exactly if it has 360 entries of phi_d.
bool fits_merl(const HalfDiffTable& table) noexcept;

/// Returns the file that holds the table; reading it back gives the same values. If the table was read from a file,
/// every number is written to 2^-24 of the file's, since tables hold floats. Holes are -1, grey fills all three
/// planes. Throws Error unless fits_merl.
std::string format_merl(const HalfDiffTable& table);

/// Writes a 90 x 90 x 180 table of an isotropic source, sampled at cell centres. The table holds the source's
/// reciprocal part (see SymmetrizedBrdf), because the format has one half of phi_d. Values are -1 below the
/// horizon and where the source knows nothing. Throws Error, naming the file, if the source is anisotropic,
/// spectral, or the file cannot be written.
void write_merl(const std::filesystem::path& path, BrdfRef source);

}  // namespace burnish
