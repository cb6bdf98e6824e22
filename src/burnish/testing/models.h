// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/error.h>
#include <burnish/factors/model_spec.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {

struct ModelCase {
  const char* name;
  const char* expression;
  std::vector<std::string> options;
  std::size_t channels;
};

/// Models with every kind of table, warp and projection, alone and together.
inline const ModelCase kModelCases[] = {
    {"Pqp", "pqp", {"p=32", "q=64"}, 3},
    {"DiskPqp", "pqp", {"p=32x32", "q=64x64,rational:0.2"}, 3},
    {"Pqpr", "pqpr", {"p=32", "q=64,rational:0.05", "r=32"}, 3},
    {"PowerWarps", "p(wo) q(h) p(wi)", {"p=16,power:0.7", "q=16x16,power:0.4"}, 3},
    {"RootWarps", "q(h) r(theta_d)", {"q=9x9,power:0.5", "r=12,power:0.5"}, 1},
    {"Grid", "u(theta_h,theta_d) v(wi,wo)", {"u=16x7,rational:0.1", "v=5x5"}, 3},
    {"Affine", "s(wi+wo+0.4n) v(0.3wi+0.9wo) v(0.9wi+0.3wo)", {"s=9x9", "v=11x11"}, 3},
    {"Mirror", "a(m+wo) b(0.5m+wo-0.2n)", {"a=8x8", "b=16,rational:0.3"}, 3},
    {"BelowTheHorizon", "a(wi-0.6n) b(wo-0.6n)", {"a=8x8", "b=16"}, 1},
    {"Deviation", "a(theta_m) g(theta_h,theta_m)", {"a=16,rational:-1.3", "g=9x5"}, 3},
    {"Difference", "a(d) b(d) c(d)", {"a=12x12", "b=8", "c=9x9,rational:0.5"}, 3},
    {"Shared", "p(wo) q(h) p(wi) + s(h)", {"p=8,shared", "q=8x8,shared", "s=6"}, 3},
    {"ManyTables",
     "a(wo) b(h) a(wi) + c(wo) d(h) c(wi) + e(wo) f(h) e(wi) + g(wo) i(h) g(wi) + j(wo) k(h) j(wi) + l(wo) "
     "o(h) l(wi) + p(wo) q(h) p(wi) + r(theta_d) s(d) + t(theta_h,theta_d) u(wi,wo)",
     {"a=8", "b=16", "c=8", "d=8x8", "e=8", "f=16x16", "g=8", "i=16,rational:0.2", "j=8", "k=16", "l=8",
      "o=16", "p=8,shared", "q=16", "r=16", "s=8x8", "t=16x7", "u=8x5"},
     3},
    {"ThreeLobes", "p(wo) q(h) p(wi) + p(wo) s(h) p(wi) + t(theta_d)", {"p=8", "q=64", "s=16", "t=8"}, 3},
    {"Twist", "a(theta_t) g(theta_h,theta_t)", {"a=16,power:0.7", "g=9x5"}, 3},
    {"Volume", "z(theta_h) g(theta_h,theta_d,phi_d)", {"z=24,power:0.5", "g=9x5x4,power:0.5"}, 3},
    {"Volumes", "v(phi_d,h,d) + s(wi,wo,theta_t) w(theta_d)", {"v=3x8x4", "s=4x4x3,shared", "w=6"}, 3},
    {"OneDirection",
     "a(theta_i) c(theta_i,theta_h) q(theta_h)",
     {"a=8", "c=5x9,identity,power:0.5", "q=12"},
     3},
    {"Azimuth", "a(phi_d) g(theta_d,phi_d)", {"a=16,rational:0.3", "g=9x5"}, 3},
    {"Side",
     "b(theta_d,theta_h) g(theta_h,theta_d,phi_s) a(phi_s)",
     {"b=5x9", "g=9x5x7,power:0.5", "a=8"},
     3},
    {"ManyAngles",
     "a(wi+0.1wo) b(wi+0.2wo) c(wi+0.3wo) d(wi+0.4wo) e(wi+0.5wo) f(wi+0.6wo) g(wi+0.7wo) h(wi+0.8wo) "
     "i(wi+0.9wo) j(theta_t) k(theta_m)",
     {"a=4", "b=4", "c=4", "d=4", "e=4", "f=4", "g=4", "h=4", "i=4", "j=8", "k=8"},
     3},
};

/// Returns the case of that name.
inline const ModelCase& model_case(std::string_view name) {
  const ModelCase* const found = std::ranges::find(kModelCases, name, &ModelCase::name);
  if (found == std::end(kModelCases)) throw Error("no model case " + std::string(name));
  return *found;
}

/// Gives one value to both ends of tables that are looked up by phi_s. The two ends are one place, and rounding
/// decides between them.
inline void close_circles(std::vector<Table>& tables, const std::vector<Lobe>& lobes) {
  for (const Lobe& lobe : lobes)
    for (const FactorUse& use : lobe.factors) {
      Table& table = tables[use.table];
      const auto [width, height, depth] =
          std::array{table.layout.width, table.layout.height, table.layout.depth};
      const auto value = [&](int x, int y, int z, std::size_t c) -> float& {
        return table.values[static_cast<std::size_t>((z * height + y) * width + x) * table.channels + c];
      };
      for (int z = 0; z < depth; ++z)
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x)
            for (std::size_t c = 0; c < table.channels; ++c) {
              if (use.projection == kProjectSide && x == width - 1) value(x, y, z, c) = value(0, y, z, c);
              if (use.projection_y == kProjectSide && y == height - 1) value(x, y, z, c) = value(x, 0, z, c);
              if (use.projection_z == kProjectSide && z == depth - 1) value(x, y, z, c) = value(x, y, 0, c);
            }
    }
}

/// Returns a model of the case's form. log_value(table, layout, x, row, channel) fills its tables, and `random` draws
/// the scales of its lobes.
template <class LogValue>
FactoredBrdf model_of(const ModelCase& model, TableFormat format, Pcg32& random, LogValue log_value) {
  const ModelSpec spec = parse_model_spec(model.expression, model.options, true);
  std::vector<Table> tables;
  for (std::size_t t = 0; t < spec.tables.size(); ++t) {
    const ModelSpec::TableSpec& form = spec.tables[t];
    Table table{
        .name = form.name, .layout = form.layout, .channels = form.shared ? 1 : model.channels, .values = {}};
    for (int y = 0; y < form.layout.rows(); ++y)
      for (int x = 0; x < form.layout.width; ++x)
        for (std::size_t c = 0; c < table.channels; ++c)
          table.values.push_back(static_cast<float>(log_value(t, form.layout, x, y, c)));
    tables.push_back(std::move(table));
  }
  std::vector<Lobe> lobes;
  for (const auto& factors : spec.lobes) {
    Lobe lobe{.scale = {}, .factors = factors};
    for (std::size_t c = 0; c < model.channels; ++c) lobe.scale.push_back(random.uniform());
    lobes.push_back(std::move(lobe));
  }
  close_circles(tables, lobes);
  return from_log_tables(model.channels, std::move(tables), std::move(lobes), format);
}

/// Returns a model with smooth tables, as fits have them: neighbours differ by 12 % at most for sides of 32 or more.
inline FactoredBrdf smooth_model(const ModelCase& model, TableFormat format = TableFormat::single) {
  Pcg32 random(7);
  std::vector<double> phases;  // one phase for each table
  return model_of(model, format, random,
                  [&](std::size_t table, const TableLayout& layout, int x, int y, int c) {
                    if (table == phases.size()) phases.push_back(6 * random.uniform());
                    return std::sin(3.0 * x / layout.width + phases[table] + 0.5 * c) *
                           std::cos(2.5 * y / layout.rows() + phases[table]);
                  });
}

/// Returns a model with random tables: log values uniform in [-span, 0].
inline FactoredBrdf random_model(const char* expression, std::vector<std::string> options,
                                 std::size_t channels, TableFormat format, double span = 3) {
  Pcg32 random(17);
  const ModelSpec spec = parse_model_spec(expression, options, true);
  std::vector<Table> tables;
  for (const ModelSpec::TableSpec& t : spec.tables) {
    Table table{.name = t.name, .layout = t.layout, .channels = t.shared ? 1 : channels, .values = {}};
    for (std::size_t i = 0; i < t.layout.node_count() * table.channels; ++i)
      table.values.push_back(static_cast<float>(-span * random.uniform()));
    table.format = format_of(t, format);
    tables.push_back(std::move(table));
  }
  std::vector<Lobe> lobes;
  for (const auto& factors : spec.lobes)
    lobes.push_back({.scale = std::vector<double>(channels, 0.3), .factors = factors});
  return from_log_tables(channels, std::move(tables), std::move(lobes));
}

/// An expression with every kind of table, warp and projection, and sizes for its tables.
inline const char* const kEverything =
    "p(wo) q(h) p(wi) r(theta_d) + s(wi+wo+0.4n) t(wi) t(wo) u(theta_h,theta_d) + v(0.3wi+0.9wo) "
    "v(0.9wi+0.3wo) + x(theta_h,theta_d,phi_d)";
inline const std::vector<std::string> kEverySize{
    "p=8", "q=16x16,rational:0.2", "r=5,power:0.5,shared", "s=9x9", "t=4,shared", "u=6x7", "v=11", "x=7x5x3"};

/// Returns all pairs of the corners: normal, grazing, borders of maps, wi == wo, the wrap of phi, below the horizon.
inline std::vector<DirectionPair> corner_pairs() {
  const Vec3 corners[] = {{0, 0, 1},         {1, 0, 1e-5}, {-1, 0, 1e-5},    {0, -1, 1e-3},   {1e-6, 0, 1},
                          {-1e-6, 1e-6, 1},  {1, 1, 1},    {1, 1, 0.999},    {-1, -1e-9, .5}, {-1, 1e-9, .5},
                          {0.7, -0.7, 1e-7}, {0, 0, -1},   {0.3, 0.1, -0.2}, {1, 0, 0}};
  std::vector<DirectionPair> pairs;
  for (const Vec3 wi : corners)
    for (const Vec3 wo : corners) pairs.push_back({normalize(wi), normalize(wo)});
  return pairs;
}

/// Returns the pairs with components rounded to floats.
inline std::vector<DirectionPair> as_floats(std::vector<DirectionPair> pairs) {
  for (auto& [wi, wo] : pairs)
    for (Vec3* w : {&wi, &wo})
      *w = {static_cast<float>(w->x), static_cast<float>(w->y), static_cast<float>(w->z)};
  return pairs;
}

/// Returns `count` pairs rounded to floats: the corners and random pairs, a tenth of them wi == wo.
inline std::vector<DirectionPair> corner_and_random_pairs(int count) {
  std::vector<DirectionPair> pairs = corner_pairs();
  Pcg32 random(11);
  while (static_cast<int>(pairs.size()) < count) {
    const auto draw = [&] {
      const double z = random.uniform() * random.uniform(), phi = 6.283185307179586 * random.uniform();
      const double s = std::sqrt(1 - z * z);
      return Vec3{s * std::cos(phi), s * std::sin(phi), z};
    };
    const Vec3 wi = draw();
    pairs.push_back({wi, random.uniform() < 0.1 ? wi : draw()});
  }
  return as_floats(std::move(pairs));
}

/// Returns the factor by which cancelling terms of projections magnify rounding errors. It is the largest of
/// (sum of
/// coefficients|) / |combination| over the factors.
inline double cancellation(const FactoredBrdf& brdf, Vec3 wi, Vec3 wo) {
  double worst = 1;
  for (const Lobe& lobe : brdf.lobes())
    for (const FactorUse& use : lobe.factors) {
      const Projection& p = use.projection;
      if (p.kind != Projection::Kind::affine || p == kProjectWi || p == kProjectWo || p == kProjectHalf)
        continue;
      const Vec3 v = p.wi * wi + p.wo * wo + p.mirror * mirror(wi) + Vec3{0, 0, p.n};
      worst = std::max(worst, (std::abs(p.wi) + std::abs(p.wo) + std::abs(p.mirror) + std::abs(p.n)) /
                                  length({v.x, v.y, std::max(v.z, 0.0)}));
    }
  return worst;
}

/// Returns the same factor for shaders, where phi_d adds to it. The phi_d of directions that are unit to 2^-24
/// is off by 2^-24 / (sin theta_d sin theta_h) (folded_azimuth of parameterization/projection-inl.h). So f is
/// off by that error times the slope of its tables.
inline double shader_cancellation(const FactoredBrdf& brdf, Vec3 wi, Vec3 wo) {
  double worst = cancellation(brdf, wi, wo);
  const Vec3 sum = wi + wo;
  const double product = length(wi - wo) * std::hypot(sum.x, sum.y);
  for (const Lobe& lobe : brdf.lobes())
    for (const FactorUse& use : lobe.factors)
      for (const Projection& p : {use.projection, use.projection_y, use.projection_z})
        if (p == kProjectAzimuth || p == kProjectSide)
          worst = std::max(worst, 1 + 0.05 / std::max(product, 1e-12));
  return worst;
}

}  // namespace burnish
