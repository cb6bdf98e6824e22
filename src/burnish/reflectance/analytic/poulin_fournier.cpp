// SPDX-License-Identifier: Apache-2.0
#include <burnish/math/quadrature.h>
#include <burnish/reflectance/analytic/cosine_lobes.h>
#include <burnish/reflectance/analytic/poulin_fournier.h>

namespace burnish {

namespace {

using Interval = PoulinFournier::Interval;

Interval overlap(Interval a, Interval b) noexcept {
  return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
}

/// Cosine between w and the cylinder's normal at angle psi, 0 where it faces away.
double facing(Vec3 w, double psi) noexcept {
  return std::max(0.0, w.y * std::sin(psi) + w.z * std::cos(psi));
}

}  // namespace

// Both functions look to the right (w.y >= 0) and mirror the answer for the left.

Interval PoulinFournier::visible_arc(Vec3 w) const noexcept {
  const double base = std::acos(1 - height);  // the arc above the floor is [-base, base]
  const double cosine = w.z / std::hypot(w.y, w.z);
  const double facing = -std::atan2(w.z, std::abs(w.y));  // where the normal turns away from w
  // The ray that grazes the neighbour starts acos(1 - spacing cosine) further; beyond 2 radii none does.
  const double free = 2 * std::asin(std::sqrt(std::min(1.0, 0.5 * spacing * cosine)));
  const Interval right{std::max(facing, -base), std::min(facing + free, base)};
  return w.y >= 0 ? right : Interval{-right.hi, -right.lo};
}

Interval PoulinFournier::visible_floor(Vec3 w) const noexcept {
  const double floor = 1 - height, base = std::sqrt(height * (2 - height));
  const double in_plane = std::hypot(w.y, w.z), sine = std::abs(w.y) / in_plane, cosine = w.z / in_plane;
  // The neighbour's silhouette hides the floor only if the grazing ray touches it above the floor.
  const double hidden = sine > floor ? (1 - floor * sine) / cosine : base;
  const Interval right{base, spacing - hidden};
  return w.y >= 0 ? right : Interval{spacing - right.hi, spacing - right.lo};
}

bool PoulinFournier::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  return eval_above_horizon(wi, wo, f, [&](const PairGeometry& g) {
    const Interval arc = overlap(visible_arc(wi), visible_arc(wo));
    const Interval floor = overlap(visible_floor(wi), visible_floor(wo));
    const double floor_share = std::max(0.0, floor.hi - floor.lo) / spacing;
    const double per_area = 1 / (spacing * g.cos_i * g.cos_o);
    const double scale = blinn_phong_normalization(exponent);

    // Diffuse: the integrand is a cosine of twice the angle; 12 nodes reach rounding on an arc of pi.
    const double rough =
        integrate<12>(arc.lo, arc.hi, [&](double psi) { return facing(wi, psi) * facing(wo, psi); });

    // Specular: only where the lobe is above 1e-10 of its largest.
    const double reach = std::acos(std::pow(1e-10, 1 / exponent));
    const double peak = std::atan2(g.h.y, g.h.z);
    const Interval lit = overlap(arc, {peak - reach, peak + reach});
    const double glossy = integrate<24>(lit.lo, lit.hi, [&](double psi) {
      return std::pow(facing(g.h, psi), exponent) * facing(wi, psi) * facing(wo, psi);
    });
    return (rough * per_area + floor_share) * diffuse(kd) +
           scale * (glossy * per_area + floor_share * std::pow(g.h.z, exponent)) * ks;
  });
}

}  // namespace burnish
