#include <vector>

#include <burnish/export/nearest_openpbr.h>
#include <burnish/fitting/parametric/openpbr_fit.h>
#include <burnish/metrics/sphere_images.h>

namespace burnish {

NearestOpenPbr nearest_openpbr(BrdfRef brdf) {
  constexpr int kSize = 64;
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

}  // namespace burnish
