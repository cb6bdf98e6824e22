// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include <burnish/testing/models.h>

namespace burnish {

/// Models whose lobes are sampled well: lines, disks and grids, every warp and kind of projection, one lobe and
/// several.
inline const ModelCase kGlossyModels[] = {
    {"Pqp", "pqp", {"p=16", "q=64,rational:0.05"}, 3},
    {"Pqpr", "pqpr", {"p=16", "q=64", "r=16"}, 3},
    {"TwoLobes",
     "p(wo) q(h) r(theta_d) p(wi) + s(wo) t(h) s(wi)",
     {"p=8", "q=64,rational:0.02", "r=8", "s=8", "t=16"},
     3},
    {"Grid", "p(wo) g(theta_h,theta_d) p(wi) + s(wo) s(wi)", {"g=32x8,rational:0.1", "p=8", "s=8,shared"}, 3},
    {"Volume", "z(theta_h) g(theta_h,theta_d,phi_d)", {"g=28x5x4,power:0.5", "z=32"}, 3},
    {"Affine", "q(wi+wo+0.4n) v(0.3wi+0.9wo) v(0.9wi+0.3wo) + q(h)", {"q=32", "v=9"}, 1},
    {"Mirror", "a(m+wo) q(h) b(d)", {"a=16,power:0.5", "q=32", "b=8"}, 3},
    {"Disks", "pqp", {"p=17x17", "q=33x33,rational:0.2"}, 3},
    {"DiskAndLine", "p(wo) q(h) p(wi) + s(wo) t(h) s(wi)", {"p=8", "q=33x33,power:0.5", "s=9x9", "t=32"}, 3},
    {"Twist", "p(wo) q(h) p(wi) w(theta_t,theta_h)", {"p=8", "q=48", "w=5x8"}, 3},
    {"Side", "z(theta_h) g(theta_h,theta_d,phi_s)", {"g=28x5x7,power:0.5", "z=32"}, 3},
};

inline const ModelCase& glossy_case(std::string_view name) {
  return *std::ranges::find(kGlossyModels, name, &ModelCase::name);
}

/// Returns a model with a highlight in every table of h, longer along one axis if the table is a disk. Other tables
/// have slopes.
inline FactoredBrdf glossy_model(const ModelCase& model) {
  const ModelSpec spec = parse_model_spec(model.expression, model.options, true);
  std::vector<Table> tables;
  for (const ModelSpec::TableSpec& t : spec.tables) {
    Table table{.name = t.name, .layout = t.layout, .channels = t.shared ? 1 : model.channels, .values = {}};
    const double steepness = t.name == "q" || t.name == "g" ? 400 : 3;
    for (int y = 0; y < t.layout.rows(); ++y)
      for (int x = 0; x < t.layout.width; ++x)
        for (std::size_t c = 0; c < table.channels; ++c) {
          const bool angles = projection_count(t.layout.shape) > 1;
          const Vec3 w = node_direction(t.layout, x, angles ? 0 : y);
          const double along = w.x + 0.5 * w.y, across = 3 * (w.y - 0.5 * w.x);
          const double tilt = 0.1 * y / t.layout.height;
          table.values.push_back(static_cast<float>(
              -(1 + 0.2 * c) * std::log1p(steepness * (along * along + across * across)) - tilt));
        }
    tables.push_back(std::move(table));
  }
  std::vector<Lobe> lobes;
  for (const auto& factors : spec.lobes)
    lobes.push_back(
        {.scale = std::vector<double>(model.channels, lobes.empty() ? 0 : -3), .factors = factors});
  return from_log_tables(model.channels, std::move(tables), std::move(lobes), TableFormat::half);
}

}  // namespace burnish
