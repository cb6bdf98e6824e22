// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/fitting/refinement/training_set.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Adds pixels of spheres lit from the viewer to the set. Their theta_d is 0, at the edge of a volume; pixels of
/// other lights reach the nodes there from one side only. Their number is `share` of the present pixels. Half of them
/// have small theta_h; weights make them count as if they were spread evenly over the disk.
TrainingSet with_frontal_pixels(BrdfRef source, TrainingSet set, double share);

}  // namespace burnish
