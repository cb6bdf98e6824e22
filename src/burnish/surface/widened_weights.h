// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// The maps with weights of the widened lobes behind those given: 0 in level 0. In other levels the mean of a lobe's
/// weight is shared between the lobe and its copies, so that their mean variance is that of the covered texels' normals
/// about the level's, as far as the widest copy goes; each texel counts by its weight. Linear in weights where the
/// normals are the same. Precondition: normals, and of each lobe its copies together, by rising variance > 0.
SurfaceMaps with_widened_weights(SurfaceMaps maps, std::span<const WidenedLobe> widened);

}  // namespace burnish
