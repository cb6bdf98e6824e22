// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/angle_table.h>
#include <burnish/reflectance/findings.h>

namespace burnish {

struct ZemaxFile {
  AngleTable table;
  Findings findings;
};

/// Returns true if the first line that is no comment starts with the keyword Source.
bool looks_like_zemax(std::string_view text) noexcept;

/// Reads a Zemax (Radiant Imaging) tabular BRDF or BTDF. The axes are sample rotation, angle of incidence, azimuth
/// around the mirror direction, and angle from it. Azimuth 0 points to the normal, and azimuths run counter-clockwise.
/// A BTDF has the direction straight on in place of the mirror direction; direction and azimuths are mirrored through
/// the surface. Rotation r means a light at phi_i = r + 90 degrees: the normal of the plane of incidence is then r
/// from +x.
///
/// Values are interpolated linearly between the angles. Entries of exactly zero are holes; negative values are counted
/// and kept. Monochrome is grey; XYZ becomes linear Rec. 709 for a D65 white. If values do not integrate to the stated
/// TIS, Findings states both numbers. The values then stay as they are unless OpenOptions::scale_to_tis is set. With
/// it, each block of a rotation and an incidence is scaled to its TIS, all channels by the luminance's factor.
/// Comments are kept. Throws Error on anything else. Source: [Rykowski 2008].
ZemaxFile parse_zemax(const FileBytes& file, const OpenOptions& options = {});

/// Returns frame and axes of the files that burnish makes, without values. Isotropic ones are folded.
/// Incidences up to 85 degrees and azimuths stand every 5 degrees, in anisotropic ones every 10. Radial
/// angles are 0.5 degrees apart at the mirror direction and 10 degrees apart at 175.
AngleTable zemax_layout(bool isotropic);

/// Returns true if a Zemax file can hold the table as it is: around the mirror direction, grey or RGB.
bool fits_zemax(const AngleTable& table) noexcept;

/// Returns the file that holds the table, values and angles with all their digits; RGB as XYZ. Holes are 0, so
/// values of 0 are written as 1e-30. The total of each incidence, TIS, is the sum of its entries times cos(theta_o)
/// and the solid angles of their cells. `comments` are written as they are; without any, a remark names the
/// `sample`, line breaks left out. A transmission is written as a BTDF. Throws Error unless fits_zemax.
std::string format_zemax(const AngleTable& table, std::string_view sample,
                         std::span<const std::string> comments = {},
                         BsdfPart part = BsdfPart::reflection_front);

}  // namespace burnish
