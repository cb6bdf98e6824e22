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

/// True if the first line that is no comment starts with the keyword Source.
bool looks_like_zemax(std::string_view text) noexcept;

/// A Zemax (Radiant Imaging) tabular BRDF or BTDF: values over sample rotation, angle of incidence, and the azimuth
/// around and angle from the mirror direction (azimuth 0 to the normal, counter-clockwise), of a BTDF from the
/// direction straight on, mirrored through the surface with its azimuths. Rotation r means a light at phi_i = r + 90
/// degrees: the normal of the plane of incidence is then r from +x. Linear between the angles. Entries of exactly zero
/// are holes; negatives are counted and kept. Monochrome is grey; XYZ becomes linear Rec. 709 for a D65 white. Where
/// values do not integrate to the stated TIS, Findings says both; they stay as they are, or with
/// OpenOptions::scale_to_tis each block of a rotation and an incidence is scaled to its TIS, all channels by the
/// luminance's. Comments are kept. Throws Error on anything else. Source: [Rykowski 2008].
ZemaxFile parse_zemax(const FileBytes& file, const OpenOptions& options = {});

/// Frame and axes of the files that burnish makes, without values: isotropic ones folded, incidences
/// up to 85 degrees and azimuths every 5, anisotropic ones every 10; radial angles 0.5 degrees apart at the
/// mirror direction, 10 at 175.
AngleTable zemax_layout(bool isotropic);

/// True if a Zemax file can hold the table as it is: around the mirror direction, grey or RGB.
bool fits_zemax(const AngleTable& table) noexcept;

/// The file that holds the table, values and angles with all their digits; RGB as XYZ. Holes are 0, so what
/// is 0 is written as 1e-30. The total of each incidence, TIS, is the sum of its entries times cos(theta_o)
/// and the solid angles of their cells. `comments` are written as they are; without any a remark names the `sample`,
/// line breaks left out. A transmission is a BTDF. Throws Error unless fits_zemax.
std::string format_zemax(const AngleTable& table, std::string_view sample,
                         std::span<const std::string> comments = {},
                         BsdfPart part = BsdfPart::reflection_front);

}  // namespace burnish
