// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/lighting/area_light_table.h>
#include <burnish/lighting/mirrored_view.h>

namespace burnish {

namespace {

// Two or four nodes and their interpolation weights.
struct NodeMix {
  std::array<std::size_t, 4> node{};
  std::array<double, 4> weight{};
};

struct AxisPlace {
  std::size_t low;
  double part;
};
AxisPlace axis_place(double position, std::size_t nodes) noexcept {
  if (nodes == 1) return {0, 0};
  const double last = static_cast<double>(nodes - 1), at = std::clamp(position, 0.0, 1.0) * last;
  const double low = std::min(std::floor(at), last - 1);
  return {static_cast<std::size_t>(low), at - low};
}

NodeMix node_mix(const AreaLightTable& table, Vec3 wo) noexcept {
  const AxisPlace theta = axis_place(theta_position(wo), table.thetas);
  const AxisPlace azimuth = axis_place(azimuth_position(table.views, wo), table.azimuths);
  const std::size_t first = azimuth.low * table.thetas + theta.low,
                    next = first + (table.azimuths > 1 ? table.thetas : 0);
  return {{first, first + 1, next, next + 1},
          {(1 - theta.part) * (1 - azimuth.part), theta.part * (1 - azimuth.part),
           (1 - theta.part) * azimuth.part, theta.part * azimuth.part}};
}

double mixed(const NodeMix& mix, std::span<const float> values, std::size_t each, std::size_t k) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i)
    sum += mix.weight[i] * static_cast<double>(values[mix.node[i] * each + k]);
  return sum;
}

Rgb mixed_color(const NodeMix& mix, std::span<const float> values) noexcept {
  return {mixed(mix, values, 3, 0), mixed(mix, values, 3, 1), mixed(mix, values, 3, 2)};
}

}  // namespace

ShadedLobes shaded_lobes(const AreaLightTable& table, Vec3 wo) noexcept {
  const NodeMix mix = node_mix(table, wo);
  const MirroredView frame = mirrored_view(wo, table.views);
  ShadedLobes shaded{.lobes = {}, .count = table.lobes.size() + 1};
  shaded.lobes[0].amplitude = mixed_color(mix, table.cosine);
  for (std::size_t j = 0; j < table.lobes.size(); ++j) {
    const AreaLobe& lobe = table.lobes[j];
    std::array<double, 9> b{};
    for (std::size_t k = 0; k < 9; ++k) b[k] = mixed(mix, lobe.inverse, 9, k);
    shaded.lobes[j + 1] = {frame.of_local(b), mixed_color(mix, lobe.amplitude)};
  }
  return shaded;
}

Rgb reflected_density(const AreaLightTable& table, Vec3 wi, Vec3 wo) noexcept {
  Rgb sum;
  if (wi.z <= 0 || wo.z <= 0) return sum;
  const auto shaded = shaded_lobes(table, wo);  // the loop refers to it
  for (const ShadedLobe& lobe : shaded.all()) sum = sum + Rgb(lobe.shape.density(wi)) * lobe.amplitude;
  return sum;
}

Rgb albedo(const AreaLightTable& table, Vec3 wo) noexcept {
  Rgb sum;
  if (wo.z <= 0) return sum;
  const auto shaded = shaded_lobes(table, wo);  // the loop refers to it
  for (const ShadedLobe& lobe : shaded.all()) sum = sum + Rgb(lobe.shape.share_above()) * lobe.amplitude;
  return sum;
}

Rgb reflected(const AreaLightTable& table, std::span<const Vec3> polygon, Vec3 wo) {
  Rgb sum;
  if (wo.z <= 0) return sum;
  const auto shaded = shaded_lobes(table, wo);  // the loop refers to it
  for (const ShadedLobe& lobe : shaded.all())
    sum = sum + Rgb(lobe_share(lobe.shape, polygon)) * lobe.amplitude;
  return sum;
}

}  // namespace burnish
