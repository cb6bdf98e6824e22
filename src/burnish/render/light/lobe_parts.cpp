// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <burnish/render/light/lobe_parts.h>

namespace burnish {
namespace {

bool of_view_alone(const Table& table, const FactorUse& use) noexcept {
  const auto alone = [](const Projection& p) {
    return p.kind == Projection::Kind::affine && p.wi == 0 && p.mirror == 0;
  };
  const int projections = projection_count(table.layout.shape);
  return alone(use.projection) && (projections < 2 || alone(use.projection_y)) &&
         (projections < 3 || alone(use.projection_z));
}

// The table's place among those that are needed, made where it is new.
std::size_t number_of(const Table& table, std::vector<Table>& tables) {
  const auto known = std::ranges::find(tables, table.name, &Table::name);
  const auto number = static_cast<std::size_t>(known - tables.begin());
  if (known == tables.end()) tables.push_back(table);
  return number;
}

// The lobe with some of its factors, and the tables they need.
FactoredBrdf part_of(const FactoredBrdf& brdf, std::vector<double> scale,
                     const std::vector<FactorUse>& uses) {
  std::vector<Table> tables;
  Lobe lobe{.scale = std::move(scale), .factors = uses};
  for (FactorUse& use : lobe.factors) {
    use.table = number_of(brdf.table_of(use), tables);
  }
  return {brdf.channels(), std::move(tables), {std::move(lobe)}};
}

}  // namespace

LobeParts parts_of(const FactoredBrdf& brdf, const Lobe& lobe) {
  std::vector<FactorUse> outside, inside;
  for (const FactorUse& use : lobe.factors)
    if (of_view_alone(brdf.table_of(use), use))
      outside.push_back(use);
    else
      inside.push_back(use);
  return {part_of(brdf, lobe.scale, outside), part_of(brdf, std::vector(lobe.scale.size(), 1.0), inside)};
}

FactoredBrdf joined(std::span<const FactoredBrdf> parts) {
  std::vector<Table> tables;
  std::vector<Lobe> lobes;
  for (const FactoredBrdf& part : parts) {
    Lobe lobe = part.lobes()[0];
    for (FactorUse& use : lobe.factors) use.table = number_of(part.table_of(use), tables);
    lobes.push_back(std::move(lobe));
  }
  return {parts[0].channels(), std::move(tables), std::move(lobes)};
}

Channels eval_channels(const FactoredBrdf& brdf, Vec3 wi, Vec3 wo) noexcept {
  Channels f{};
  brdf.eval(wi, wo, std::span(f).first(brdf.channels()));
  if (brdf.channels() == 1) f[1] = f[2] = f[0];
  return f;
}

}  // namespace burnish
