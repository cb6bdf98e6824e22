#pragma once

#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

struct NearestOpenPbr {
  OpenPbrParameters parameters;
  double psnr = 0;  ///< dB, of the pictures of metrics/sphere_images.h, 64 pixels
};

/// What fit_openpbr finds for a BRDF of 1 or 3 channels, and how much it looks like it. Takes seconds.
NearestOpenPbr nearest_openpbr(BrdfRef brdf);

}  // namespace burnish
