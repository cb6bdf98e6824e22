// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <burnish/io/open_options.h>
#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/samples.h>

namespace burnish {

/// The result of the readers of scattered samples.
struct SampleFile {
  Samples samples;
  Findings findings;
};

/// Largest number of channels in a scattered file.
inline constexpr std::size_t kMaxFileChannels = 1024;

/// Ends the work of the readers of scattered samples. Counts negative values, which stay. Turns spectra
/// (findings.lambda_nm of two or more) into linear Rec. 709 unless they are kept. Fills in the number of samples
/// and the angles covered. Throws Error, naming `file`, if there are no samples or wavelengths do not increase.
void finish_samples(const std::string& file, const OpenOptions& options, SampleFile& result);

/// Returns the gaps in a set of ten samples or more, one sentence each: the set has one angle of view, one angle of
/// incidence, or stays in the plane of incidence.
std::vector<std::string> coverage_gaps(const Samples& samples);

/// Returns true if all incident directions have the same azimuth: measurements in one setting of the sample.
bool same_incident_azimuth(const Samples& samples) noexcept;

}  // namespace burnish
