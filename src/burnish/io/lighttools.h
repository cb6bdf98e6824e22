// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/angle_table.h>
#include <burnish/reflectance/findings.h>

namespace burnish {

struct LightToolsFile {
  AngleTable table;
  Findings findings;
};

/// Returns true if the line DataBegin within the first 64 KiB is followed by a keyword of LightTools' blocks, such as
/// AOI. Zemax files have TIS there.
bool looks_like_lighttools(std::string_view text) noexcept;

/// Reads a LightTools BSDF (`.bsdf`). The header has ScatterAzimuth and ScatterRadial, degrees of azimuth and polar
/// angle about the normal. Each block has its AOI, side, type, wavelength and TIS, and a value for each azimuth and
/// polar angle, azimuths slowest. Blocks of BRDF and BTDF on both sides are the four parts. Several wavelengths are
/// bands ("550 nm"): the first is read unless options.band names another.
///
/// The light comes from azimuth 90 degrees, so the mirror direction, or straight on, is at 270. Azimuths of one half
/// are symmetric about the plane of incidence. Values are f without the cosine. XYZ becomes linear Rec. 709 for a D65
/// white. An AOI of 180 degrees is the normal of the back. Values stay as they are where they do not integrate to TIS,
/// unless options.scale_to_tis is set.
///
/// Throws Error on anything else, such as several planes of incidence (POI). Checked against the public reader of
/// libbsdf, against no file of LightTools itself. Source: [Kimura 2026].
LightToolsFile parse_lighttools(const FileBytes& file, const OpenOptions& options);

}  // namespace burnish
