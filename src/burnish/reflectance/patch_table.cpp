// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <initializer_list>

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

/// Rings between polar angles, degrees, and the patches of each.
PatchBasis basis_of(std::initializer_list<double> bounds_deg, std::initializer_list<std::size_t> counts) {
  PatchBasis basis;
  const double* low_deg = bounds_deg.begin();
  for (const std::size_t count : counts) {
    basis.rings.push_back({radians(low_deg[0]), radians(low_deg[1]), count, basis.size()});
    ++low_deg;
  }
  return basis;
}

}  // namespace

std::size_t PatchBasis::patch_of(Vec3 w) const noexcept {
  const double theta = theta_of(w);
  std::size_t r = 0;
  while (r + 1 < rings.size() && theta >= rings[r].theta_high) ++r;
  const PatchRing& ring = rings[r];
  // Patches of a ring are centred on first_azimuth and its multiples, hence the rounding.
  const double turn = phi_of(w) / kTwoPi - first_azimuth / kTwoPi + 1;
  return ring.first +
         static_cast<std::size_t>(std::floor(turn * static_cast<double>(ring.count) + 0.5)) % ring.count;
}

Vec3 PatchBasis::centre(std::size_t patch) const noexcept {
  const PatchRing& ring = ring_of(*this, patch);
  const double turn = static_cast<double>(patch - ring.first) / static_cast<double>(ring.count);
  return spherical_direction(centre_theta(ring), first_azimuth + kTwoPi * turn);
}

double PatchBasis::projected_solid_angle(std::size_t patch) const noexcept {
  const PatchRing& ring = ring_of(*this, patch);
  // The integral of cos(theta) over a ring is pi (sin^2 high - sin^2 low), shared evenly by its patches.
  const double low = std::sin(ring.theta_low), high = std::sin(ring.theta_high);
  return kPi * (high * high - low * low) / static_cast<double>(ring.count);
}

bool PatchTable::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  const bool known = eval_raw(wi, wo, f);
  cut_negatives(f);
  return known;
}

bool PatchTable::eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  std::ranges::fill(f, 0.0);
  if (wi.z <= 0 || wo.z <= 0) return true;
  const std::size_t pair = outgoing.patch_of(wo) * incident.size() + incident.patch_of(wi);
  for (std::size_t c = 0; c < channel_count; ++c)
    f[c] = static_cast<double>(values[pair * channel_count + c]);
  return true;
}

double PatchTable::albedo(Vec3 wi, std::size_t channel) const noexcept {
  // The albedo is the sum of f times the projected solid angle of each outgoing patch.
  double sum = 0;
  const std::size_t column = incident.patch_of(wi);
  for (std::size_t o = 0; o < outgoing.size(); ++o)
    sum += static_cast<double>(values[(o * incident.size() + column) * channel_count + channel]) *
           outgoing.projected_solid_angle(o);
  return sum;
}

PatchBasis klems_full_basis() {
  return basis_of({0, 5, 15, 25, 35, 45, 55, 65, 75, 90}, {1, 8, 16, 20, 24, 24, 24, 16, 12});
}

PatchBasis klems_half_basis() {
  return basis_of({0, 6.5, 19.5, 32.5, 45.5, 58.5, 71.5, 90}, {1, 8, 12, 16, 20, 12, 8});
}

PatchBasis klems_older_half_basis() {
  return basis_of({0, 6.5, 19.5, 32.5, 46.5, 61.5, 76.5, 90}, {1, 8, 12, 16, 20, 12, 4});
}

PatchBasis klems_quarter_basis() {
  return basis_of({0, 9, 27, 45, 63, 90}, {1, 8, 12, 12, 8});
}

}  // namespace burnish
