#include <vector>

#include <burnish/export/nearest_material.h>
#include <burnish/fitting/parametric/gltf_fit.h>
#include <burnish/fitting/parametric/openpbr_fit.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/metrics/sphere_images.h>

namespace burnish {

namespace {

constexpr int kSize = 64;
constexpr std::size_t kPairs = 20'000;

}  // namespace

NearestOpenPbr nearest_openpbr(BrdfRef brdf) {
  std::vector<LitSphere> truth;
  for (const double light : kSphereLights) truth.push_back(render_sphere(brdf, light, kSize));
  const double exposure = sphere_exposure(truth);
  NearestOpenPbr nearest{.parameters =
                             fit_openpbr(picture_pairs(brdf, exposure),
                                         {.grey = brdf.channels() == 1, .anisotropic = !brdf.isotropic()})
                                 .parameters};
  double error = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    error += mean_squared_error(
        tone_map(render_sphere(OpenPbr(nearest.parameters), kSphereLights[i], kSize).image, exposure),
        tone_map(truth[i].image, exposure));
  nearest.psnr = psnr(error / static_cast<double>(truth.size()));
  return nearest;
}

NearestGltf nearest_gltf(BrdfRef brdf) {
  const Scorer scorer(brdf, {.count = kPairs, .image_size = kSize});
  const GltfFit fit = fit_gltf(picture_pairs(brdf, scorer.exposure()),
                               {.grey = brdf.channels() == 1, .anisotropic = !brdf.isotropic()});
  const ErrorFigures figures = scorer.score(fit.material);
  return {fit.material, figures.psnr, figures.relative};
}

}  // namespace burnish
