#pragma once

#include <string>
#include <vector>

#include <burnish/io/open_options.h>
#include <burnish/reflectance/findings.h>
#include <burnish/reflectance/samples.h>

namespace burnish {

/// What the readers of scattered samples return.
struct SampleFile {
  Samples samples;
  Findings findings;
};

/// Most channels a scattered file may have.
inline constexpr std::size_t kMaxFileChannels = 1024;

/// The last step of the readers of scattered samples. Counts negatives, which stay; turns spectra
/// (findings.lambda_nm of two or more) into linear Rec. 709 unless they are kept; fills in the number of samples
/// and the angles covered. Throws Error, naming `file`, if there are no samples or wavelengths do not
/// increase.
void finish_samples(const std::string& file, const OpenOptions& options, SampleFile& result);

/// What a set of ten samples or more leaves out altogether, one sentence each: it has one angle of view, one angle of
/// incidence, or stays in the plane of incidence.
std::vector<std::string> coverage_gaps(const Samples& samples);

/// True if all incident directions have the same azimuth: measurements in one setting of the sample.
bool same_incident_azimuth(const Samples& samples) noexcept;

}  // namespace burnish
