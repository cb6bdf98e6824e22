// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <burnish/surface/surface_file.h>

namespace burnish {

/// Reads an OpenEXR file as parse_surface does.
SurfaceModel read_surface_exr(const FileBytes& file);

/// Weights of the own lobes, then normals and tangents: the maps of a file.
std::vector<const SurfaceMap*> all_maps(const SpatialBrdf& brdf);

}  // namespace burnish
