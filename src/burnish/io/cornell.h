#pragma once

#include <burnish/io/byte_reader.h>
#include <burnish/io/sample_file.h>

namespace burnish {

/// True if the first line that is no comment is one count, as in a Cornell .brdf file.
bool looks_like_cornell(std::string_view text) noexcept;

/// Scattered spectra of an isotropic material in the format of the Cornell Program of Computer Graphics: '#'
/// comments, the number of wavelengths, the wavelengths in nm, then rows of theta_i, phi_i, theta_s, phi_s in
/// radians and one f_r a wavelength. Throws Error on anything else.
SampleFile parse_cornell(const FileBytes& file, const OpenOptions& options);

}  // namespace burnish
