// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/io/byte_reader.h>
#include <burnish/io/sample_file.h>

namespace burnish {

/// Returns true if the first line that is no comment is one count, as in a Cornell .brdf file.
bool looks_like_cornell(std::string_view text) noexcept;

/// Reads scattered spectra of an isotropic material in the format of the Cornell Program of Computer
/// Graphics. A file has '#' comments, the number of wavelengths, the wavelengths in nm, then rows. A row has
/// theta_i, phi_i, theta_s, phi_s in radians and one f_r for each wavelength. Throws Error on anything else.
SampleFile parse_cornell(const FileBytes& file, const OpenOptions& options);

}  // namespace burnish
