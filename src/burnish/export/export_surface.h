// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/export/export_model.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// Returns true if a surface can be written as the target: shaders, ktx2, dds, exr, png, gltf, three and html.
bool takes_surfaces(ExportTarget target) noexcept;

/// Returns true if a surface has its maps as textures beside the target's file: shaders except C++, ktx2 and dds.
bool has_map_textures(ExportTarget target) noexcept;

/// A surface: shaders (shaders/spatial_shader.h) with the lobes' textures and NAME_map0.ktx2, ...: the maps side by
/// side with their levels; exr and png: each map and each table a picture, EXR with the maps' values, PNG of weights
/// their bytes, of normals and tangents (x + 1) / 2; three and html with everything inside; glTF, a square with
/// textures of each texel's nearest metal or dielectric (nearest_materials). The manifest's "maps" tell where each
/// lobe's weights are and what they are multiplied with. Throws Error for other targets, for an environment, for half
/// products, for blocks without has_map_textures, and as generate_shader and pack_maps.
ExportedFiles export_surface(const SpatialBrdf& surface, const ExportOptions& options);

}  // namespace burnish
