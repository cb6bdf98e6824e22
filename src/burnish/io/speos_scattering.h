// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/function_brdf.h>

namespace burnish {

struct SpeosScatteringFile {
  FunctionBrdf brdf;
  Findings findings;
};

/// Returns true if the text starts with the header of a Speos simple scattering surface.
bool looks_like_speos_scattering(std::string_view text) noexcept;

/// Reads a Speos simple scattering surface (`.simplescattering`), which is four numbers or eight. A share of the
/// light that is not absorbed is Lambertian, another is Gaussian. The rest is specular, which no function has:
/// Findings::direct states it. A file is of reflection, of transmission, or of both with a stated reflectance.
///
/// The Gaussian share has f cos(theta_o) = peak exp(-4 ln 2 (angle / fwhm)^2). The angle is that from the mirror
/// direction, or from straight on, and the peak makes the whole sphere's integral the share. A file that Speos made of
/// a surface of 10 degrees has this form to five digits at every incidence, the part beyond the horizon cut.
///
/// Throws Error on anything else: shares that exceed 100 %, a width below 0.001 degrees with a Gaussian share, and
/// shares of reflection and transmission by Fresnel's law, whose index is not in the file. Source: [Ansys 2024].
SpeosScatteringFile parse_speos_scattering(const FileBytes& file, const OpenOptions& options);

}  // namespace burnish
