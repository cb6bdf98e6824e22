// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/angle_table.h>
#include <burnish/reflectance/findings.h>

namespace burnish {

struct IntegraFile {
  AngleTable table;
  Findings findings;
};

/// Returns true if a line within the first 64 KiB starts with the keyword TypeSym.
bool looks_like_integra(std::string_view text) noexcept;

/// Reads Integra's diffuse distributions: reflection (`.ddr`) and transmission (`.ddt`). The file itself does not say
/// which of them it is; its name's ending does, or the keyword sigmat, which transmission alone has.
///
/// The axes are the azimuth of the light (psi; none is isotropic), its polar angle (sigma), the azimuth around the
/// mirror direction (phi, 0 towards the normal) and the angle from it (theta), all in degrees. In a transmission the
/// direction straight on stands in place of the mirror direction, or refracted light at the polar angles sigmat.
///
/// Values of TypeData Luminance are pi f, those of Intensity f cos(theta_o). With Absolute they are multiplied by each
/// incidence's kbdf, with Relative scaled until the incidence reflects its kbdf. TypeSym AxiSymmetrical,
/// PlaneSymmetrical (phi up to 180 degrees) and ASymmetrical, with or without 4D, are read. Colours are taken as linear
/// Rec. 709, spectra become it unless options.keep_spectral.
///
/// Comments start with ";;". Keywords are compared in any case. Throws Error on anything else, DirSymmetrical included,
/// whose directions no public text explains. Checked against the public reader of libbsdf. Source: [Kimura 2026].
IntegraFile parse_integra(const FileBytes& file, const OpenOptions& options);

}  // namespace burnish
