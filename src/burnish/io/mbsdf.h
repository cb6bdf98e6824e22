#pragma once

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

/// The reflection of an NVIDIA MBSDF file, isotropic, grey or RGB: values over theta_in, theta_out in [0,
/// pi/2) and the azimuth between the directions in [0, pi], each the value at its cell's centre; the mirror
/// direction is at pi. Linear between cell centres. Negatives are counted and, unless kept on request, set to
/// zero. Throws Error if the file has no reflection, its sizes and its length differ, or a value is not
/// finite. Source: [NVIDIA 2021].
MbsdfFile parse_mbsdf(const FileBytes& file, const OpenOptions& options);

}  // namespace burnish
