// SPDX-License-Identifier: Apache-2.0
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

/// Reads one block of an NVIDIA MBSDF file, isotropic, grey or RGB. The block is MBSDF_DATA_REFLECTION, in older
/// files MBSDF_DATA, or MBSDF_DATA_TRANSMISSION; choose_block finds it for the options. Values stand at the cell
/// centres of theta_in and theta_out in [0, pi/2) and of the azimuth between the directions in [0, pi]. The mirror
/// direction is at pi, and so is the direction straight on of transmission. Values are interpolated linearly between
/// cell centres. Negative values are counted and kept. Throws Error if the file has no such block, its sizes and its
/// length differ, or a value is not finite. Source: [NVIDIA 2021].
MbsdfFile parse_mbsdf(const FileBytes& file, const OpenOptions& options = {});

/// Returns frame and axes of a file of these resolutions, without values.
AngleTable mbsdf_layout(std::size_t theta_count, std::size_t phi_count);

/// Returns true if an MBSDF file can hold the table as it is: a layout as mbsdf_layout's, grey or RGB.
bool fits_mbsdf(const AngleTable& table) noexcept;

/// Returns the file that holds the table as its one block; reading it back gives the same values to the last bit.
/// The format has no holes, so they become 0. Throws Error unless fits_mbsdf.
std::string format_mbsdf(const AngleTable& table, BsdfPart part = BsdfPart::reflection_front);

}  // namespace burnish
