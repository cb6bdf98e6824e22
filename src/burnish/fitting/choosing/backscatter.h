#pragma once

#include <cstddef>

#include <burnish/math/angles.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

/// Whether an isotropic source that knows all directions has a lobe about wi = wo: with half vectors 20 to 60 degrees
/// off the normal it is more than 1.5 times as high at theta_d of .25 to .75 degrees as at 10 to 14, at most of those
/// it knows.
bool backscatters(BrdfRef source);

/// What makes an incidence: polar angles of wi as close as this, radians, and so many samples near wi = wo.
inline constexpr double kSameIncidence = kPi / 180;
inline constexpr std::size_t kMinNearby = 3;

/// Whether the samples of a source show a lobe about wi = wo: at most incidences that were measured there
/// (three samples with theta_d up to 1.5 degrees, else up to 3 or 5, their half vectors at least 10 degrees off the
/// normal) they are on the mean more than twice as high as around it (theta_d of 4 to 8 degrees, or that much wider).
bool backscatters(const SampleSource& source);

/// The theta_d below which samples weigh more where a source backscatters, radians; HomomorphicOptions::backscatter.
inline constexpr double kBackscatterReach = 0.03;

}  // namespace burnish
