// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/parametric/metallic_roughness_fit.h>
#include <burnish/metrics/sphere_images.h>

namespace burnish {

namespace {

constexpr int kSize = 24;

// Base colour, metallic, roughness in [0, 1]; anisotropy in [-1, 1], its sign the direction.
using Point = std::array<double, 6>;

MetallicRoughness material_of(const Point& p) {
  return {{p[0], p[1], p[2]}, p[3], std::max(p[4], 0.03), std::abs(p[5]), p[5] < 0};
}

/// The mean squared error of pictures of a material: the three lit spheres, at the exposure of the BRDF's.
class SphereError {
 public:
  explicit SphereError(BrdfRef brdf) {
    for (const double light : kSphereLights) truth_.push_back(render_sphere(brdf, light, kSize));
    exposure_ = sphere_exposure(truth_);
    for (LitSphere& sphere : truth_) sphere.image = tone_map(sphere.image, exposure_);
  }

  double operator()(const Point& p) const {
    double sum = 0;
    for (std::size_t i = 0; i < truth_.size(); ++i)
      sum += mean_squared_error(
          tone_map(render_sphere(material_of(p), kSphereLights[i], kSize).image, exposure_), truth_[i].image);
    return sum / static_cast<double>(truth_.size());
  }

 private:
  std::vector<LitSphere> truth_;
  double exposure_ = 1;
};

struct Candidate {
  Point point;
  double error;
};

/// A pattern search of the first `parameters` from a point.
Candidate searched(const SphereError& error, Point point, std::size_t parameters) {
  double now = error(point);
  const auto try_point = [&](Point next) {
    for (std::size_t k = 0; k < parameters; ++k) next[k] = std::clamp(next[k], k == 5 ? -1.0 : 0.0, 1.0);
    if (next == point) return false;
    const double there = error(next);
    if (there >= now) return false;
    point = next;
    now = there;
    return true;
  };
  for (double step = 0.25; step >= 1.0 / 256;) {
    const Point before = point;
    for (std::size_t k = 0; k < parameters; ++k)
      for (const double sign : {-1.0, 1.0}) {
        Point next = point;
        next[k] += sign * step;
        if (try_point(next)) break;
      }
    // along valleys: the same way again
    Point further = point;
    for (std::size_t k = 0; k < parameters; ++k) further[k] += point[k] - before[k];
    if (point == before)
      step /= 2;
    else
      try_point(further);
  }
  return {point, now};
}

}  // namespace

MetallicRoughnessFit fit_metallic_roughness(BrdfRef brdf) {
  if (brdf.channels() != 1 && brdf.channels() != 3)
    throw Error(fmt::format("metallic-roughness fit: expected 1 or 3 channels, found {}", brdf.channels()));
  const SphereError error(brdf);
  Candidate best{{}, INFINITY};
  for (const double metallic : {0.0, 1.0})
    for (const double roughness : {0.2, 0.45, 0.8}) {
      const Candidate found =
          searched(error, {0.5, 0.5, 0.5, metallic, roughness, 0}, brdf.isotropic() ? 5 : 6);
      if (found.error < best.error) best = found;
    }
  return {material_of(best.point), psnr(best.error)};
}

}  // namespace burnish
