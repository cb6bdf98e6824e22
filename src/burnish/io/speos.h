#pragma once

#include <string_view>

#include <burnish/io/byte_reader.h>
#include <burnish/io/open_options.h>
#include <burnish/reflectance/angle_table.h>
#include <burnish/reflectance/findings.h>

namespace burnish {

struct SpeosFile {
  AngleTable table;
  Findings findings;
};

/// True if the text starts with the header of a Speos anisotropic BSDF or BRDF surface file.
bool looks_like_speos(std::string_view text) noexcept;

/// The text form of Ansys Speos' `.anisotropicbsdf` (rotations of the sample, incidences, a spectrum, a block of theta
/// x phi for each) and `.brdf` (incidences, wavelengths, a block for each pair). The mirror direction stands at phi =
/// 0. Blocks hold values proportional to f_r, or to f_r cos(theta_o), whose cosine is divided out; they are taken as
/// they are where their hemispheres integrate to the stated reflectances within 5 %, else scaled to these; spectra that
/// vary always scale. They make one channel a wavelength, which become linear Rec. 709 unless options.keep_spectral; a
/// single wavelength stays one channel, a spectrum that does not vary is grey. Rotations that are all alike make it
/// isotropic; between and beyond others than 67.5 degrees nothing is filled in. Blocks with angles of their own are
/// interpolated at those of all. Of reflection and transmission, whose thetas count from 90 to 180 degrees and whose
/// direction straight on is at phi = 0, the options say which is read (choose_block). Throws Error on binary files,
/// incidences that differ between rotations, and whatever does not fit the counts.
/// Checked against Ansys' "Structure of Anisotropic BSDF Files" and "Structure of BRDF Files", their definition of the
/// specular direction, the writers in Ansys' OpticalAutomation scripts, and a `.anisotropicbsdf` of version 11; no
/// `.brdf` file. Source: [Ansys 2024].
SpeosFile parse_speos(const FileBytes& file, const OpenOptions& options);

}  // namespace burnish
