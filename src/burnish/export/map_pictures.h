// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/image/image.h>
#include <burnish/surface/surface_map.h>

namespace burnish {

/// A map's values, three channels: those of a grey map three times the same, and as the third of two 0, or z of a unit
/// normal.
Image map_picture(const SurfaceMap& map, bool normals);

/// Components in [-1, 1] as bytes: 255 (x + 1) / 2, to the nearest.
Image8 vector_bytes(const Image& vectors);

}  // namespace burnish
