#pragma once

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Whether an isotropic source that knows all directions has a lobe about wi = wo: with half vectors 20 to 60 degrees
/// off the normal it is more than 1.5 times as high at theta_d of .25 to .75 degrees as at 10 to 14, at most of those
/// it knows. Scattered samples: scattered_plan.h.
bool backscatters(BrdfRef source);

}  // namespace burnish
