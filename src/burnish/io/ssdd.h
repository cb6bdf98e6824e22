// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <variant>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/angle_table.h>
#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/function_brdf.h>

namespace burnish {

struct SsddFile {
  std::variant<AngleTable, FunctionBrdf> brdf;
  Findings findings;
};

/// Returns true if the first line that is no comment starts with VERSION, and DATA_TYPE begins a line within the first
/// 64 KiB.
bool looks_like_ssdd(std::string_view text) noexcept;

/// Reads surface scattering distribution data (`.ssdd`), versions 0.2 and 0.3: text or binary tables of a BRDF, a BTDF,
/// and shares of specular reflection and transmission, which become Findings::direct of the part that is read.
///
/// Spherical coordinates of isotropic data and specular coordinates are tables of angles, unknown farther than half a
/// step beyond their ends. Half/difference coordinates, distorted spherical coordinates and spherical coordinates of
/// anisotropic data are functions, linear between nodes and constant beyond the first and the last. Offset angles turn
/// the mirror direction, or straight on. Directions of a BTDF are mirrored through the surface.
///
/// The file does not say which primaries its RGB has: they are taken as linear Rec. 709. XYZ becomes linear Rec. 709
/// for a D65 white, as libbsdf shows it. So do spectra, under the options' illuminant, unless options.keep_spectral.
/// The reader takes memory in proportion to the file. Throws Error on anything else. Source: [Kimura 2026].
SsddFile parse_ssdd(const FileBytes& file, const OpenOptions& options);

}  // namespace burnish
