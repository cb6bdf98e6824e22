#include <algorithm>
#include <cmath>

#include <burnish/math/angles.h>
#include <burnish/reflectance/patch_table.h>

namespace burnish {

namespace {

double centre_theta(const PatchRing& ring) noexcept {
  return ring.theta_low == 0 && ring.count == 1 ? 0 : 0.5 * (ring.theta_low + ring.theta_high);
}

const PatchRing& ring_of(const PatchBasis& basis, std::size_t patch) noexcept {
  std::size_t r = 0;
  while (basis.rings[r].first + basis.rings[r].count <= patch) ++r;
  return basis.rings[r];
}

}  // namespace

PatchNeighbours PatchBasis::neighbours(Vec3 w) const noexcept {
  const double theta = theta_of(w), turn = phi_of(w) / kTwoPi - first_azimuth / kTwoPi + 1;

  // the two rings whose centres are next to theta
  std::size_t high = 0;
  while (high < rings.size() && centre_theta(rings[high]) <= theta) ++high;
  const std::size_t inner = high > 0 ? high - 1 : 0, outer = std::min(high, rings.size() - 1);
  const double low_theta = centre_theta(rings[inner]), high_theta = centre_theta(rings[outer]);
  const double outwards =
      inner == outer ? 0 : std::clamp((theta - low_theta) / (high_theta - low_theta), 0.0, 1.0);

  // in each of them the two patches next to phi
  PatchNeighbours near;
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    const PatchRing& ring = rings[side ? outer : inner];
    const double position = turn * static_cast<double>(ring.count), below = std::floor(position);
    const std::size_t k = static_cast<std::size_t>(below) % ring.count;
    const double weight = side ? outwards : 1 - outwards;
    near.index[2 * side] = ring.first + k;
    near.index[2 * side + 1] = ring.first + (k + 1) % ring.count;
    near.weight[2 * side] = weight * (1 - (position - below));
    near.weight[2 * side + 1] = weight * (position - below);
  }
  return near;
}

Vec3 PatchBasis::centre(std::size_t patch) const noexcept {
  const PatchRing& ring = ring_of(*this, patch);
  const double turn = static_cast<double>(patch - ring.first) / static_cast<double>(ring.count);
  return spherical_direction(centre_theta(ring), first_azimuth + kTwoPi * turn);
}

double PatchBasis::projected_solid_angle(std::size_t patch) const noexcept {
  const PatchRing& ring = ring_of(*this, patch);
  const double low = std::sin(ring.theta_low), high = std::sin(ring.theta_high);
  return kPi * (high * high - low * low) / static_cast<double>(ring.count);
}

bool PatchTable::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  const bool known = eval_raw(wi, wo, f);
  cut_negatives(f);
  return known;
}

bool PatchTable::eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  f[0] = 0;
  if (wi.z <= 0 || wo.z <= 0) return true;
  const PatchNeighbours in = incident.neighbours(wi), out = outgoing.neighbours(wo);
  for (std::size_t o = 0; o < 4; ++o)
    for (std::size_t i = 0; i < 4; ++i)
      f[0] += out.weight[o] * in.weight[i] *
              static_cast<double>(values[out.index[o] * incident.size() + in.index[i]]);
  return true;
}

PatchBasis klems_full_basis() {
  constexpr std::array bounds_deg = {0, 5, 15, 25, 35, 45, 55, 65, 75, 90};
  constexpr std::array<std::size_t, 9> counts = {1, 8, 16, 20, 24, 24, 24, 16, 12};
  PatchBasis basis;
  for (std::size_t r = 0; r < counts.size(); ++r)
    basis.rings.push_back({radians(bounds_deg[r]), radians(bounds_deg[r + 1]), counts[r], basis.size()});
  return basis;
}

}  // namespace burnish
