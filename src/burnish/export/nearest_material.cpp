// SPDX-License-Identifier: Apache-2.0
#include <burnish/export/nearest_material.h>
#include <burnish/fitting/parametric/gltf_fit.h>
#include <burnish/fitting/parametric/grain.h>
#include <burnish/fitting/parametric/openpbr_fit.h>
#include <burnish/metrics/error_figures.h>

namespace burnish {

namespace {

constexpr std::size_t kPairs = 20'000;

}  // namespace

// The exposure is that of fit_material, whose pictures have the same size: both find the same inputs.
NearestOpenPbr nearest_openpbr(BrdfRef brdf) {
  const Scorer scorer(brdf, {.count = kPairs});
  const PicturePairs pairs = picture_pairs(brdf, scorer.exposure());
  const OpenPbrParameters parameters =
      fit_openpbr(pairs,
                  {.grey = pairs.grey(), .anisotropic = !brdf.isotropic(), .tangent = grain_direction(brdf)})
          .parameters;
  return {parameters, scorer.picture_psnr(scorer.pictures(OpenPbr(parameters)))};
}

NearestGltf nearest_gltf(BrdfRef brdf) {
  const Scorer scorer(brdf, {.count = kPairs});
  const PicturePairs pairs = picture_pairs(brdf, scorer.exposure());
  const GltfFit fit = fit_gltf(
      pairs, {.grey = pairs.grey(), .anisotropic = !brdf.isotropic(), .tangent = grain_direction(brdf)});
  const ErrorFigures figures = scorer.score(fit.material);
  return {fit.material, figures.psnr, figures.relative};
}

}  // namespace burnish
