// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/half_diff_table.h>

namespace burnish {

namespace {

/// The two neighbours of a position on one axis and the weight of the second.
struct CellNeighbours {
  std::array<int, 2> index;
  double fraction;
};

/// Returns the neighbours of a position in cells, whose centres are at halves; constant beyond the outermost centres.
CellNeighbours clamped_neighbours(double position, int count) noexcept {
  const double x = std::clamp(position - 0.5, 0.0, static_cast<double>(count - 1));
  const int low = std::min(static_cast<int>(x), std::max(count - 2, 0));
  return {{low, std::min(low + 1, count - 1)}, x - low};
}

CellNeighbours periodic_neighbours(double position, int count) noexcept {
  const double x = position - 0.5, low = std::floor(x);
  const int index = (static_cast<int>(low) + count) % count;
  return {{index, (index + 1) % count}, x - low};
}

/// Returns a position's cell, the customary integer part.
int cell(double position, int count) noexcept {
  return std::clamp(static_cast<int>(position), 0, count - 1);
}

/// Directions as positions in cells along the three axes.
struct PositionInCells {
  double theta_h, theta_d, phi_d;
};

PositionInCells position_in(const HalfDiffTable& table, Vec3 wi, Vec3 wo) noexcept {
  // theta_h has cells that are even in its root, as MERL tables have; the other angles have even cells.
  const HalfDiff angles = to_half_diff(wi, wo);
  const double circle = angles.phi_d / (table.full_circle ? kTwoPi : kPi);
  return {std::sqrt(angles.theta_h / kHalfPi) * table.theta_h_count,
          angles.theta_d / kHalfPi * table.theta_d_count, (circle - std::floor(circle)) * table.phi_d_count};
}

void write_zeros(std::span<double> f) noexcept {
  std::fill(f.begin(), f.end(), 0.0);
}

}  // namespace

std::size_t HalfDiffTable::offset(int h, int d, int p) const noexcept {
  const auto row =
      static_cast<std::size_t>(h) * static_cast<std::size_t>(theta_d_count) + static_cast<std::size_t>(d);
  return (row * static_cast<std::size_t>(phi_d_count) + static_cast<std::size_t>(p)) * channel_count;
}

HalfDiff HalfDiffTable::centre(int h, int d, int p) const noexcept {
  const double root = (h + 0.5) / theta_h_count;
  return {root * root * kHalfPi, 0, (d + 0.5) / theta_d_count * kHalfPi,
          (p + 0.5) / phi_d_count * (full_circle ? kTwoPi : kPi)};
}

bool HalfDiffTable::above_horizon(int h, int d, int p) const noexcept {
  const HalfDiff angles = centre(h, d, p);
  // The cosines of the two directions are cos cos -+ sin sin cos(phi_d), positive if the product of tangents is below
  // 1.
  return std::tan(angles.theta_h) * std::tan(angles.theta_d) * std::abs(std::cos(angles.phi_d)) < 1;
}

bool HalfDiffTable::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  const bool known = eval_raw(wi, wo, f);
  cut_negatives(f);
  return known;
}

bool HalfDiffTable::eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  write_zeros(f);
  if (wi.z <= 0 || wo.z <= 0) return true;
  const PositionInCells at = position_in(*this, wi, wo);
  const CellNeighbours h = clamped_neighbours(at.theta_h, theta_h_count);
  const CellNeighbours d = clamped_neighbours(at.theta_d, theta_d_count);
  const CellNeighbours p = periodic_neighbours(at.phi_d, phi_d_count);

  // Interpolation is trilinear. Holes have no weight, and the other corners make up for it.
  double total = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t ch = corner & 1, cd = corner >> 1 & 1, cp = corner >> 2;
    const double weight = (ch ? h.fraction : 1 - h.fraction) * (cd ? d.fraction : 1 - d.fraction) *
                          (cp ? p.fraction : 1 - p.fraction);
    const float* entry = &values[offset(h.index[ch], d.index[cd], p.index[cp])];
    if (weight == 0 || std::isnan(entry[0])) continue;
    total += weight;
    for (std::size_t c = 0; c < f.size(); ++c) f[c] += weight * static_cast<double>(entry[c]);
  }
  if (total == 0) return false;
  for (double& value : f) value /= total;
  return true;
}

bool NearestHalfDiff::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  write_zeros(f);
  if (wi.z <= 0 || wo.z <= 0) return true;
  const PositionInCells at = position_in(*table, wi, wo);
  const float* entry = &table->values[table->offset(cell(at.theta_h, table->theta_h_count),
                                                    cell(at.theta_d, table->theta_d_count),
                                                    cell(at.phi_d, table->phi_d_count))];
  if (std::isnan(entry[0])) return false;
  for (std::size_t c = 0; c < f.size(); ++c) f[c] = std::max(static_cast<double>(entry[c]), 0.0);
  return true;
}

HalfDiffTable tabulate_half_diff(BrdfRef source, int theta_h_count, int theta_d_count, int phi_d_count,
                                 bool full_circle) {
  if (!source.isotropic()) throw Error("a half/difference table needs an isotropic source");
  if (theta_h_count < 1 || theta_d_count < 1 || phi_d_count < 1)
    throw Error("a half/difference table needs at least one entry along each axis");
  HalfDiffTable table{theta_h_count, theta_d_count, phi_d_count, full_circle, source.channels(), {}};
  const auto channels = table.channel_count;
  table.values.assign(table.entry_count() * channels, std::numeric_limits<float>::quiet_NaN());
  for_each_chunk(static_cast<std::size_t>(theta_h_count), 1, [&](std::size_t h, std::size_t, std::size_t) {
    const auto circle = static_cast<std::size_t>(phi_d_count);
    std::vector<DirectionPair> pairs(circle);
    std::vector<double> values(circle * channels);
    std::vector<std::uint8_t> known(circle);
    for (int d = 0; d < theta_d_count; ++d) {
      for (std::size_t p = 0; p < circle; ++p) {
        const auto [wi, wo] = from_half_diff(table.centre(static_cast<int>(h), d, static_cast<int>(p)));
        pairs[p] = {wi, wo};
      }
      source.eval(pairs, values, known);
      float* entry = &table.values[table.offset(static_cast<int>(h), d, 0)];
      for (std::size_t p = 0; p < circle; ++p)
        if (known[p] && pairs[p].wi.z > 0 && pairs[p].wo.z > 0)
          for (std::size_t c = p * channels; c < (p + 1) * channels; ++c)
            entry[c] = static_cast<float>(values[c]);
    }
  });
  return table;
}

}  // namespace burnish
