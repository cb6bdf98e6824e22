#pragma once

#include <cstddef>
#include <string>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/angle_table.h>
#include <burnish/reflectance/findings.h>

namespace burnish {

struct MbsdfFile {
  AngleTable table;
  Findings findings;
};

bool looks_like_mbsdf(std::span<const std::byte> bytes) noexcept;

/// The reflection of an NVIDIA MBSDF file, its block MBSDF_DATA_REFLECTION or MBSDF_DATA, isotropic, grey or RGB: values over theta_in, theta_out in [0,
/// pi/2) and the azimuth between the directions in [0, pi], each the value at its cell's centre; the mirror
/// direction is at pi. Linear between cell centres. Negatives are counted and kept. Throws Error if the file
/// has no reflection, its sizes and its length differ, or a value is not finite. Source: [NVIDIA 2021].
MbsdfFile parse_mbsdf(const FileBytes& file);

/// Frame and axes of a file of these resolutions, without values.
AngleTable mbsdf_layout(std::size_t theta_count, std::size_t phi_count);

/// True if an MBSDF file can hold the table as it is: a layout as mbsdf_layout's, grey or RGB.
bool fits_mbsdf(const AngleTable& table) noexcept;

/// The file that holds the table; reading it back gives the same values to the last bit. The format has no
/// holes: they become 0. Throws Error unless fits_mbsdf.
std::string format_mbsdf(const AngleTable& table);

}  // namespace burnish
