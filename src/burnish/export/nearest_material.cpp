#include <burnish/export/nearest_material.h>
#include <burnish/fitting/parametric/gltf_fit.h>
#include <burnish/fitting/parametric/openpbr_fit.h>
#include <burnish/metrics/error_figures.h>

namespace burnish {

namespace {

constexpr int kSize = 64;
constexpr std::size_t kPairs = 20'000;

}  // namespace

NearestOpenPbr nearest_openpbr(BrdfRef brdf) {
  const Scorer scorer(brdf, {.count = kPairs, .image_size = kSize});
  const OpenPbrParameters parameters =
      fit_openpbr(picture_pairs(brdf, scorer.exposure()),
                  {.grey = brdf.channels() == 1, .anisotropic = !brdf.isotropic()})
          .parameters;
  return {parameters, scorer.picture_psnr(scorer.pictures(OpenPbr(parameters)))};
}

NearestGltf nearest_gltf(BrdfRef brdf) {
  const Scorer scorer(brdf, {.count = kPairs, .image_size = kSize});
  const GltfFit fit = fit_gltf(picture_pairs(brdf, scorer.exposure()),
                               {.grey = brdf.channels() == 1, .anisotropic = !brdf.isotropic()});
  const ErrorFigures figures = scorer.score(fit.material);
  return {fit.material, figures.psnr, figures.relative};
}

}  // namespace burnish
