// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <burnish/fitting/fit_summary.h>
#include <burnish/fitting/parametric/picture_pairs.h>
#include <burnish/reflectance/gltf_material.h>

namespace burnish {

struct GltfFit {
  GltfMaterial material;  ///< rounded to six decimals
  /// The figures are those of OpenPbrFit.
  FitSummary summary;
  int starts = 0;  ///< minimizations run
};

struct GltfFitOptions {
  bool grey = false;         ///< colours are grey, and there is no film, which has some
  bool anisotropic = false;  ///< stretches are looked for
  double tangent = 0;  ///< of these, degrees from the tangent, which stay: grain_direction of the source
  std::function<void(double fraction)> progress = {};
};

/// The material of glTF whose lit spheres have the least mean squared difference from those of `pairs`, as fit_openpbr
/// does it: Levenberg-Marquardt steps within the ranges of GltfMaterial, of roughnesses from .03 (of sheen and coats .1:
/// a coat that is sharper shows as a dot under a point light, as a mirror under the sky), of indices to 3, of films to
/// 1.5 micrometres. Smooth to rough metals and dielectrics first, then the best with coats, sheen and films, and random
/// starts on few pixels. Extensions without which the squared error is less than a percent greater (of films 12 percent,
/// half a decibel: programs have their own) are left out: their numbers are those of a GltfMaterial that nobody set. The
/// same bits for every number of threads.
GltfFit fit_gltf(const PicturePairs& pairs, const GltfFitOptions& options = {});

}  // namespace burnish
