// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/sample_source.h>
#include <burnish/reflectance/samples.h>

namespace burnish {

/// Returns expected values about wi = wo between the measured incidences, for isotropic sources that have samples
/// there at few incidences. Without these values a product of factors is undetermined there, because each factor is
/// measured where others are not. The fit of a tape was 3 times as high half way to the normal as at the first
/// incidence.
///
/// The pairs have wi in the middle of the gaps between incidences, or between the normal and the first one; wo is up
/// to 10 degrees from wi. Gaps of less than 5 degrees have none. `fitted` is a model of the source. Values come from
/// it at the neighbouring incidences, at the same distance from wi and on the same side. Their logarithms are linear
/// in theta_i between two incidences, and constant up to the normal.
Samples between_incidences(const SampleSource& source, BrdfRef fitted);

/// Returns the source's samples, followed by `expected` with a weight of their own. Both must outlive the result.
SampleSource with_expected(const SampleSource& source, const Samples& expected, double weight);

}  // namespace burnish
