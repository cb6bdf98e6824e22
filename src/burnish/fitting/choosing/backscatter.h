// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <burnish/math/angles.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

/// True if an isotropic source that knows all directions has a lobe about wi = wo. Half vectors 20 to 60 degrees off
/// the normal are tested. At most of those that the source knows, it has to be more than 1.5 times as high at theta_d
/// of .25 to .75 degrees as at 10 to 14.
bool backscatters(BrdfRef source);

/// Samples belong to one incidence if their polar angles of wi agree to kSameIncidence, radians. An incidence needs
/// kMinNearby samples near wi = wo.
inline constexpr double kSameIncidence = kPi / 180;
inline constexpr std::size_t kMinNearby = 3;

/// True if the samples of a source show a lobe about wi = wo. Incidences count that were measured there: three
/// samples with theta_d up to 1.5 degrees, else up to 3 or 5, their half vectors at least 10 degrees off the normal.
/// At most of these incidences, their mean has to be more than twice the mean around it (theta_d of 4 to 8 degrees,
/// or that much wider).
bool backscatters(const SampleSource& source);

/// The theta_d below which samples weigh more if a source backscatters, radians; see HomomorphicOptions::backscatter.
inline constexpr double kBackscatterReach = 0.03;

}  // namespace burnish
