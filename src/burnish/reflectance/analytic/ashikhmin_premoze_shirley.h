// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include <burnish/reflectance/analytic/fresnel.h>
#include <burnish/reflectance/analytic/microfacet_distribution.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Area of the microfacets that face w, projected towards w, sigma(w) = integral of D(h) max(0, w·h), of any
/// distribution D of normals, tabulated over the hemisphere of w and interpolated (bicubic). The paper's
/// g(w) is sigma(w) times the mean of n·h.
/// Relative error for Gaussian slopes: below 0.3 % for alpha >= 0.05, below 0.02 % for alpha >= 0.3.
class ProjectedAreaTable {
 public:
  /// `density` is sampled over the upper hemisphere and need not be normalized. `isotropic`: it depends on
  /// h.z alone, and so shall the table. Throws Error where it is negative, not finite or zero everywhere.
  ProjectedAreaTable(const std::function<double(Vec3)>& density, bool isotropic);

  /// Returns the factor that makes density times h.z integrate to 1.
  double density_scale() const noexcept { return density_scale_; }

  /// sigma(w) of the normalized density, at least w.z (no less can face w, unless D leans to one side).
  /// Domain: w.z > 0.
  double operator()(Vec3 w) const noexcept;

 private:
  double density_scale_ = 0;
  Vec3 mean_normal_;             ///< area-weighted, z = 1
  std::vector<double> squares_;  ///< of 2 sigma(w) - w·mean_normal_; row: polar angle, column: azimuth
};

/// Share of correlated masking between directions whose azimuths differ by the angle between the tangential
/// parts of wi and wo: exp(-(angle / width)² / 2); 0 for width 0.
double masking_correlation(Vec3 wi, Vec3 wo, double width) noexcept;

/// The generator of BRDFs from a distribution of normals: f = D F / (4 sigma_i sigma_o) (in the paper's terms
/// p F <n·h> / (4 g_i g_o)), plus kd / pi. Masking does not depend on the normal among those that face the
/// direction; masking of wi and wo is independent, or, for correlation > 0, blended towards full
/// correlation where their azimuths agree. Reciprocal; conserving for kd = 0.
/// Source: [Ashikhmin 2000a].
template <MicrofacetDistribution Distribution>
class AshikhminPremozeShirley {
 public:
  /// correlation: width in radians of the blend in azimuth difference; 0 for none (15 to 25 degrees is
  /// usual).
  AshikhminPremozeShirley(Distribution distribution, Rgb f0, Rgb kd, double correlation)
      : distribution_(std::move(distribution)),
        area_([this](Vec3 h) { return distribution_.density(h); }, distribution_.isotropic()),
        f0_(f0),
        kd_(kd),
        correlation_(correlation) {}

  static constexpr std::size_t channels() noexcept { return 3; }
  bool isotropic() const noexcept { return distribution_.isotropic(); }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    return eval_above_horizon(wi, wo, f, [&](const PairGeometry& g) {
      const double area_i = std::max(area_(wi), kMinCosine), area_o = std::max(area_(wo), kMinCosine);
      const double t = masking_correlation(wi, wo, correlation_);
      // P_i P_o / (cos_i cos_o) and min(P_i, P_o) / (cos_i cos_o), with P = cos / sigma.
      const double independent = 1 / (area_i * area_o);
      const double together = 1 / std::max(area_i * g.cos_o, area_o * g.cos_i);
      const double density = area_.density_scale() * distribution_.density(g.h);
      return diffuse(kd_) +
             0.25 * density * ((1 - t) * independent + t * together) * fresnel_schlick(f0_, g.cos_d);
    });
  }

  const ProjectedAreaTable& projected_area() const noexcept { return area_; }

 private:
  Distribution distribution_;
  ProjectedAreaTable area_;
  Rgb f0_, kd_;
  double correlation_;
};

using Satin = AshikhminPremozeShirley<CrossedGaussians>;

static_assert(Brdf<Satin>);

}  // namespace burnish
