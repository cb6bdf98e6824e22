// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// The nearest metal or dielectric of each texel: what of GltfMaterial can be a texture everywhere. Rows from v = 0 on.
struct TexelMaterials {
  int width = 0, height = 0;
  std::vector<std::uint8_t> base_color;  ///< sRGB, [texel][3]
  std::vector<std::uint8_t> metallic, roughness;
  /// PSNR, dB, of lit spheres of some texels' materials, beside those of the texels themselves: their mean square.
  double psnr = 0;
};

/// Finds them by least squares over the pixels of lit spheres, weighted about as a square root would show them: all
/// that it takes of a texel are its lobes' products with each other and with GltfMaterial at a grid of roughnesses,
/// so texels are found in microseconds. Groups of texels decide what white is, and which of two equally near
/// materials is taken. Frames are the texel's own. The same for any number of threads. Source: [glTF 2021], appendix
/// B, as GltfMaterial.
TexelMaterials nearest_materials(const SpatialBrdf& surface);

}  // namespace burnish
