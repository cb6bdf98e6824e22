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

/// True if the bytes start with three table sizes a MERL file may have.
bool looks_like_merl(std::span<const std::byte> bytes) noexcept;

/// A MERL .binary table: i32 sizes of theta_h, theta_d, phi_d, then f64 planes of red, green and blue. 360
/// entries of phi_d are a full circle, any other count half of it. Entries below the horizon, and entries of
/// -1 in all channels, are holes; other negatives are counted and kept.
/// Linear Rec. 709, as the database states. Throws Error if the sizes and the file's length differ or a value
/// above the horizon is not finite. Source: [Matusik 2003].
MerlFile parse_merl(const FileBytes& file);

/// True if a MERL file can hold the table as it is: grey or RGB, the full circle of phi_d exactly where it
/// has 360 entries.
bool fits_merl(const HalfDiffTable& table) noexcept;

/// The file that holds the table: reading it back gives the same values. A file that was read is written with every
/// number to 2^-24 of it, since tables hold floats. Holes are -1, grey fills all three planes. Throws Error unless
/// fits_merl.
std::string format_merl(const HalfDiffTable& table);

/// Writes a 90 x 90 x 180 table of an isotropic source's reciprocal part (see SymmetrizedBrdf: the format
/// holds one half of phi_d), sampled at cell centres; -1 below the horizon and where the source knows
/// nothing. Throws Error, naming the file, if the source is anisotropic, spectral, or the file cannot be
/// written.
void write_merl(const std::filesystem::path& path, BrdfRef source);

}  // namespace burnish
