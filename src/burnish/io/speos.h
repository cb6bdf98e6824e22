// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
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

/// Returns true if the text starts with the header of a Speos anisotropic BSDF or BRDF surface file.
bool looks_like_speos(std::string_view text) noexcept;

/// Reads the text form of two kinds of Ansys Speos files:
/// - `.anisotropicbsdf`: rotations of the sample, incidences, a spectrum, a block of theta x phi for each rotation and
///   incidence;
/// - `.brdf`: incidences, wavelengths, a block for each pair of them.
///
/// The mirror direction stands at phi = 0. Blocks hold values proportional to f_r, or to f_r cos(theta_o), whose cosine
/// is divided out. Values are taken as they are if their hemispheres integrate to the stated reflectances within 5 %.
/// Otherwise, and if the spectrum varies, they are scaled to the stated reflectances. Each wavelength makes one
/// channel; the channels become linear Rec. 709 unless options.keep_spectral. A single wavelength stays one channel,
/// and a spectrum that does not vary is grey.
///
/// If all rotations are alike, the table is isotropic. Otherwise nothing is known farther than half a step beyond the
/// first and the last rotation. The circle closes if the step around is at most 1.5 times the widest other step, which
/// is 67.5 degrees for rotations 45 degrees apart (make_axis). Blocks with different angles are interpolated at the
/// angles of all blocks. Thetas of transmission count from 90 to 180 degrees, and its direction straight on is at phi =
/// 0. The options decide whether reflection or transmission is read (choose_block). Throws Error on binary files,
/// incidences that differ between rotations, and whatever does not fit the counts.
///
/// The reader was checked against Ansys' "Structure of Anisotropic BSDF Files" and "Structure of BRDF Files" and their
/// definition of the specular direction. It was checked against the writers in Ansys' OpticalAutomation scripts and a
/// `.anisotropicbsdf` of version 11, but against no `.brdf` file. Source: [Ansys 2024].
SpeosFile parse_speos(const FileBytes& file, const OpenOptions& options);

/// Returns frame and axes of the files that burnish makes, without values. Isotropic files have incidences every 5
/// degrees up to 85, anisotropic ones every 10 degrees up to 80 and at 85. Thetas are 2.5 degrees apart, azimuths 5, or
/// 10 if anisotropic.
AngleTable speos_layout(bool isotropic);

/// Returns true if a Speos file can hold the table as it is: one channel, angles about the normal, isotropic, and
/// azimuths of the whole circle or of half of it.
bool fits_speos(const AngleTable& table) noexcept;

/// The tables that become the parts of a file; nullptr if a part is missing.
struct SpeosParts {
  const AngleTable* reflection = nullptr;
  const AngleTable* transmission = nullptr;
};

/// Returns the `.anisotropicbsdf` that holds the parts. Values are f, holes are 0. The spectrum of each part is flat,
/// and states what the values at the least incidence integrate to. Reading the file back gives the values to the last
/// bit. Preconditions: there is a part; each table has the normal frame and one channel, and no half circle unless it
/// is folded.
std::string format_speos(const SpeosParts& parts, std::string_view comment);

}  // namespace burnish
