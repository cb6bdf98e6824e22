// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <burnish/io/open_options.h>
#include <burnish/reflectance/angle_table.h>
#include <burnish/reflectance/findings.h>

namespace burnish {

/// Throws Error, naming the file, unless the wavelengths are positive, below 10^6 nm and increasing.
void check_wavelengths(const std::string& file, const std::vector<double>& lambda_nm);

/// Turns a table of one channel a wavelength into linear Rec. 709 under the illuminant of the options. It stays as it
/// is if the options keep spectra, or if there are fewer than two wavelengths; findings.lambda_nm has them then.
AngleTable shown_spectrum(const std::string& file, AngleTable table, const std::vector<double>& lambda_nm,
                          const OpenOptions& options, Findings& findings);

/// Fills the findings about a table: counts of entries, holes and negative values, and the angles of its axes.
void note_table(const AngleTable& table, Findings& findings);

}  // namespace burnish
