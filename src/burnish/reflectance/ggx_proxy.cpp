// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <burnish/reflectance/ggx_proxy.h>
#include <burnish/reflectance/half_vector_quadrature.h>

namespace burnish {
namespace {

constexpr double kMinProxyAlpha = 0.004;

// The light that is reflected towards one view.
struct View {
  Vec3 wo;
  std::vector<DirectionWeight> rule;
  std::vector<double> size;  // reflected_size at the rule's directions
  double total = 0;
};

// Returns the relative second moment of the weights, mean over the views: integral of size^2 / pdf over the square of
// the integral of size.
double second_moment(const std::vector<View>& views, const GgxProxy& proxy) noexcept {
  double sum = 0;
  for (const View& view : views) {
    double squares = 0;
    for (std::size_t i = 0; i < view.rule.size(); ++i)
      squares += view.size[i] * view.size[i] / proxy.pdf(view.rule[i].wi, view.wo) * view.rule[i].weight;
    sum += squares / (view.total * view.total);
  }
  return sum / static_cast<double>(views.size());
}

}  // namespace

DrawnDirection GgxProxy::sample_wi(Vec3 wo, Point2 u) const noexcept {
  Vec3 wi;
  if (u.x < share) {
    // A point of the spherical cap of the stretched view gives a visible normal [Dupuy 2023].
    const double ax = distribution.alpha_x, ay = distribution.alpha_y;
    const Vec3 view = normalize({ax * wo.x, ay * wo.y, wo.z});
    const double phi = kTwoPi * u.x / share, z = (1 - u.y) * (1 + view.z) - view.z;
    const double sine = std::sqrt(std::clamp(1 - z * z, 0.0, 1.0));
    const Vec3 cap = Vec3{sine * std::cos(phi), sine * std::sin(phi), z} + view;
    const Vec3 h = normalize({ax * cap.x, ay * cap.y, cap.z});
    wi = 2 * dot(wo, h) * h - wo;
  } else {
    wi = CosineSampler{}.sample_wi(wo, {(u.x - share) / (1 - share), u.y}).wi;
  }
  return {wi, pdf(wi, wo)};
}

double GgxProxy::pdf(Vec3 wi, Vec3 wo) const noexcept {
  if (wi.z <= 0 || wo.z <= 0) return 0;
  // The density of visible normals is D wo.h / projected_area, and that of wi is it over 4 wo.h [Heitz 2018].
  const double glossy = distribution.density(half_vector(wi, wo)) / (4 * distribution.projected_area(wo));
  return share * glossy + (1 - share) * wi.z / kPi;
}

GgxProxy fit_ggx_proxy(BrdfRef brdf, bool with_cosine) {
  // The light reflected towards eight views is tabulated once.
  std::vector<View> views;
  std::vector<double> f(brdf.channels());
  for (int k = 0; k < 8; ++k) {
    const double phi = brdf.isotropic() ? 0 : k;  // radians: spread over the circle
    View view{.wo = spherical_direction(radians(12 * k), phi), .rule = {}, .size = {}};
    view.rule = half_vector_quadrature(view.wo, 24, 64);
    for (const auto& [wi, weight] : view.rule) {
      view.size.push_back(reflected_size(brdf, wi, view.wo, f));
      view.total += view.size.back() * weight;
    }
    if (view.total > 0) views.push_back(std::move(view));
  }

  // The proxy whose weights vary least is kept.
  GgxProxy best;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double alpha_x, double alpha_y, double share) {
    const auto bounded = [](double alpha) { return std::clamp(alpha, kMinProxyAlpha, 1.0); };
    const GgxProxy proxy{{bounded(alpha_x), bounded(alpha_y)}, share};
    const double moment = second_moment(views, proxy);
    if (!(moment < least)) return;
    least = moment;
    best = proxy;
  };
  // A coarse grid is tried first, then neighbours at shrinking ratios.
  for (double alpha = kMinProxyAlpha; alpha < 1; alpha *= 1.6)
    for (double share = 1; share > (with_cosine ? 0 : 0.9); share -= 0.25) consider(alpha, alpha, share);
  for (const double ratio : {1.5, 1.3, 1.15, 1.07, 1.03, 1.02})
    for (int pass = 0; pass < 2; ++pass) {
      const GgxProxy start = best;
      const auto [x, y] = start.distribution;
      for (const double r : {ratio, 1 / ratio}) {
        consider(x * r, y * r, start.share);
        if (!brdf.isotropic()) {
          consider(x * r, y, start.share);
          consider(x, y * r, start.share);
        }
      }
      if (with_cosine)
        for (const double step : {-0.05, 0.05}) consider(x, y, std::clamp(start.share + step, 0.05, 0.95));
    }
  return best;
}

}  // namespace burnish
