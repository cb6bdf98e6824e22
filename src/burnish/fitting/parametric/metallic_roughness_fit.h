// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/reflectance/metallic_roughness.h>

namespace burnish {

struct MetallicRoughnessFit {
  MetallicRoughness material;
  double psnr = 0;  ///< dB, of the pictures that were fitted
};

/// The core glTF material whose spheres (metrics/sphere_images.h, three lights, 24 x 24 pixels) have the
/// least mean squared difference from the BRDF's: pattern search [Hooke 1961] from six metals and
/// dielectrics, each parameter to 1/256; anisotropy only where the BRDF is anisotropic. Throws Error for
/// other than 1 or 3 channels.
MetallicRoughnessFit fit_metallic_roughness(BrdfRef brdf);

}  // namespace burnish
