// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/gltf_material.h>

namespace burnish {

struct NearestOpenPbr {
  OpenPbrParameters parameters;
  double psnr = 0;  ///< dB, of the pictures of metrics/sphere_images.h
};

struct NearestGltf {
  GltfMaterial material;
  double psnr = 0;      ///< as NearestOpenPbr has it
  double relative = 0;  ///< as ErrorFigures has it, of 20,000 pairs
};

/// Returns the material that fit_openpbr finds for a BRDF of 1 or 3 channels, and how much it looks like it. Its inputs
/// are those of fit_material. Takes seconds.
NearestOpenPbr nearest_openpbr(BrdfRef brdf);

/// Returns the same for fit_gltf.
NearestGltf nearest_gltf(BrdfRef brdf);

}  // namespace burnish
