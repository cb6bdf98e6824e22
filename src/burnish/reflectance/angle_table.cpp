// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/angle_table.h>

namespace burnish {

namespace {

/// Radians by which rounding may miss the end of an axis.
constexpr double kSlack = 1e-9;

/// The least share of the weights that has to be known. A direction meant to be at a node misses it by rounding,
/// which must not make the hole there the value of the next node.
constexpr double kMinKnown = 1e-9;

/// The mirror direction of the light, the direction from it to the normal, and the one that completes them.
struct SpecularFrame {
  Vec3 specular, up, across;
};

SpecularFrame specular_frame(double theta, double phi_i) noexcept {
  const Vec3 specular = spherical_direction(theta, phi_i + kPi);
  const Vec3 up{std::cos(theta) * std::cos(phi_i), std::cos(theta) * std::sin(phi_i), std::sin(theta)};
  return {specular, up, cross(specular, up)};
}

/// Returns the polar angle of the direction that the table's last two angles count from.
double centre_of(const AngleTable& table, double theta_i) noexcept {
  if (table.centre_theta.empty()) return theta_i;
  const AxisNeighbours near = neighbours(table.axes[1], theta_i);
  return (1 - near.fraction) * table.centre_theta[near.index[0]] +
         near.fraction * table.centre_theta[near.index[1]];
}

}  // namespace

AngleAxis make_axis(std::vector<double> nodes, double period) {
  double widest = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i) widest = std::max(widest, nodes[i] - nodes[i - 1]);
  const bool closed = period > 0 && nodes.front() + period - nodes.back() <= 1.5 * widest;
  return {std::move(nodes), period, closed};
}

AxisNeighbours neighbours(const AngleAxis& axis, double angle) noexcept {
  const auto& nodes = axis.nodes;
  if (nodes.size() == 1) return {};
  const std::size_t last = nodes.size() - 1;
  const double half_step = 0.5 * (nodes[last] - nodes[last - 1]);
  if (axis.period > 0) {
    angle -= axis.period * std::floor((angle - nodes[0]) / axis.period);
    // Half a step in front of the first node is closer to it than to the last.
    if (!axis.closed && angle > nodes[last] + half_step + kSlack) angle -= axis.period;
  }
  // The angle lies beyond the last node, before the first, or between two. Outside, it is known up to half a step.
  if (angle > nodes[last]) {
    if (axis.closed) return {{last, 0}, (angle - nodes[last]) / (nodes[0] + axis.period - nodes[last]), true};
    return {{last, last}, 0, angle <= nodes[last] + (axis.reach > 0 ? axis.reach : half_step) + kSlack};
  }
  if (angle < nodes[0]) return {{0, 0}, 0, angle >= nodes[0] - 0.5 * (nodes[1] - nodes[0]) - kSlack};
  const auto above = std::upper_bound(nodes.begin(), nodes.end() - 1, angle);
  const auto high = std::max<std::size_t>(static_cast<std::size_t>(above - nodes.begin()), 1);
  return {{high - 1, high}, (angle - nodes[high - 1]) / (nodes[high] - nodes[high - 1]), true};
}

std::vector<double> cell_centres(std::size_t count, double extent) {
  std::vector<double> centres(count);
  for (std::size_t i = 0; i < count; ++i)
    centres[i] = (static_cast<double>(i) + 0.5) / static_cast<double>(count) * extent;
  return centres;
}

Vec3 around_specular(double theta_i, double phi_i, double azimuth, double radial) noexcept {
  const auto [specular, up, across] = specular_frame(theta_i, phi_i);
  return std::cos(radial) * specular +
         std::sin(radial) * (std::cos(azimuth) * up + std::sin(azimuth) * across);
}

bool AngleTable::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  const bool known = eval_raw(wi, wo, f);
  cut_negatives(f);
  return known;
}

bool AngleTable::eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  std::fill(f.begin(), f.end(), 0.0);
  if (wi.z <= 0 || wo.z <= 0) return true;

  // The four angles are those of the table's frame: about the normal, or about the mirror direction of the light.
  const double theta_i = theta_of(wi), phi_i = phi_of(wi);
  std::array<double, 4> angles{phi_i, theta_i, 0, 0};
  const std::size_t azimuth = frame == Frame::normal ? 3 : 2;
  if (frame == Frame::normal) {
    angles[2] = theta_of(wo);
    angles[3] = phi_of(wo) - phi_i;
  } else {
    const auto [specular, up, across] = specular_frame(centre_of(*this, theta_i), phi_i);
    const Vec3 about{dot(wo, up), dot(wo, across), 0};
    angles[2] = is_pole(about) ? 0 : std::atan2(about.y, about.x);
    angles[3] = angle_between(specular, wo);
  }
  if (folded) angles[azimuth] = std::abs(std::remainder(angles[azimuth], kTwoPi));

  std::array<AxisNeighbours, 4> near;
  for (std::size_t k = 0; k < 4; ++k) {
    near[k] = neighbours(axes[k], angles[k]);
    if (!near[k].inside) return false;
  }

  // Interpolation is linear along each axis. Holes have no weight, and the other corners make up for it.
  double total = 0;
  for (std::size_t corner = 0; corner < 16; ++corner) {
    double weight = 1;
    std::size_t index = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const bool second = corner >> k & 1;
      weight *= second ? near[k].fraction : 1 - near[k].fraction;
      index = index * axes[k].nodes.size() + near[k].index[second];
    }
    const float* entry = &values[index * channel_count];
    if (weight == 0 || std::isnan(entry[0])) continue;
    total += weight;
    for (std::size_t c = 0; c < f.size(); ++c) f[c] += weight * static_cast<double>(entry[c]);
  }
  if (total < kMinKnown) {
    std::fill(f.begin(), f.end(), 0.0);
    return false;
  }
  for (double& value : f) value /= total;
  return true;
}

std::size_t entry_count(const AngleTable& table) noexcept {
  std::size_t count = 1;
  for (const AngleAxis& axis : table.axes) count *= axis.nodes.size();
  return count;
}

std::array<std::size_t, 4> node_of_entry(const AngleTable& table, std::size_t entry) noexcept {
  std::array<std::size_t, 4> node;
  for (std::size_t k = 4; k-- > 0;) {
    node[k] = entry % table.axes[k].nodes.size();
    entry /= table.axes[k].nodes.size();
  }
  return node;
}

DirectionPair node_directions(const AngleTable& table, const std::array<std::size_t, 4>& node) noexcept {
  std::array<double, 4> at;
  for (std::size_t k = 0; k < 4; ++k) at[k] = table.axes[k].nodes[node[k]];
  const Vec3 wi = spherical_direction(at[1], at[0]);
  if (table.frame == AngleTable::Frame::normal) return {wi, spherical_direction(at[2], at[0] + at[3])};
  return {wi, around_specular(centre_of(table, at[1]), at[0], at[2], at[3])};
}

AngleTable tabulate_angles(BrdfRef source, AngleTable layout) {
  const auto channels = source.channels();
  layout.channel_count = source.channels();
  layout.values.assign(entry_count(layout) * channels, std::numeric_limits<float>::quiet_NaN());
  for_each_chunk(entry_count(layout), 4096, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<double> f(channels), other(channels);
    for (std::size_t entry = begin; entry < end; ++entry) {
      const auto node = node_of_entry(layout, entry);
      const auto [wi, wo] = node_directions(layout, node);
      if (wi.z <= 0 || wo.z <= 0) continue;

      // A folded table takes the mean with the mirror image of wo about the plane of incidence.
      bool known = source.eval(wi, wo, f);
      if (layout.folded) {
        const double phi_i = layout.axes[0].nodes[node[0]];
        const Vec3 across{-std::sin(phi_i), std::cos(phi_i), 0};
        const Vec3 reflected = wo - 2 * dot(across, wo) * across;
        const bool other_known = source.eval(wi, reflected, other);
        if (known && other_known)
          for (std::size_t c = 0; c < channels; ++c) f[c] = 0.5 * (f[c] + other[c]);
        else if (other_known)
          f = other;
        known = known || other_known;
      }
      if (!known) continue;
      for (std::size_t c = 0; c < channels; ++c)
        layout.values[entry * channels + c] = static_cast<float>(f[c]);
    }
  });
  return layout;
}

}  // namespace burnish
