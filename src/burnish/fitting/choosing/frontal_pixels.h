#pragma once

#include <burnish/fitting/refinement/training_set.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// The set with more pixels of spheres lit from the viewer: theta_d is 0 there, at the edge of a volume, whose
/// nodes the pixels of other lights reach from one side only. As many as `share` of the pixels that there are,
/// half of them where theta_h is small, weighted as if they were spread evenly over the disk.
TrainingSet with_frontal_pixels(BrdfRef source, TrainingSet set, double share);

}  // namespace burnish
