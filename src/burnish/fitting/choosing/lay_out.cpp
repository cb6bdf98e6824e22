// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include <burnish/error.h>
#include <burnish/fitting/choosing/lay_out.h>

namespace burnish {

namespace {

constexpr int kMinDepth = 3, kMinDiskSide = 5;

// kFolded is for volumes that are their own mirror image, kSigned for others. Grids have 1.5 nodes along phi_s for
// each along theta_d.
constexpr VolumeForm kFolded{14, 12, 6}, kSigned{8, 10, 10};
constexpr double kSidesOfDifference = 1.5;
constexpr int kWideNodes = 12;

TableLayout disk_of(double nodes, Warp warp = {}) {
  const int side = std::max(kMinDiskSide, static_cast<int>(std::sqrt(nodes)));
  return {.shape = TableShape::disk, .width = side, .height = side, .warp = warp};
}

TableLayout grid_of_difference(double nodes) {
  const double side = std::sqrt(nodes / kSidesOfDifference);
  return {.shape = TableShape::grid,
          .width = std::max(3, static_cast<int>(side)),
          .height = std::max(3, static_cast<int>(kSidesOfDifference * side))};
}

/// Returns one use of the table; all of its uses are of one kind.
const FactorUse& use_of(const ModelSpec& spec, std::size_t table) {
  for (const std::vector<FactorUse>& lobe : spec.lobes)
    for (const FactorUse& use : lobe)
      if (use.table == table) return use;
  throw Error("fit: expected a factor that uses every table, found a table without one");
}

}  // namespace

TableLayout volume_of(const VolumeForm& form, double nodes) {
  const double scale = std::cbrt(nodes / (form.half * form.difference * form.azimuth));
  const auto side = [](double n, int least) {
    return std::clamp(static_cast<int>(std::lround(n)), least, kMaxVolumeSide);
  };
  TableLayout layout{.shape = TableShape::volume, .warp = kHalfRootWarp};
  layout.depth = side(form.azimuth * scale, kMinDepth);
  const int widest = std::max(2, static_cast<int>(nodes) / (2 * layout.depth));  // leaves a width of two
  layout.height = std::min(side(std::sqrt(nodes / layout.depth * form.difference / form.half), 2), widest);
  layout.width = std::min(static_cast<int>(nodes) / (layout.depth * layout.height), kMaxVolumeSide);
  return layout;
}

ModelSpec at_fewer_nodes(ModelSpec spec, double share) {
  for (ModelSpec::TableSpec& table : spec.tables) {
    TableLayout& layout = table.layout;
    const auto shorten = [](int& side, double by, int least) {
      side = std::min(side, std::max(least, static_cast<int>(std::lround(side * by))));
    };
    if (layout.shape == TableShape::volume)
      for (int* side : {&layout.width, &layout.height, &layout.depth})
        shorten(*side, std::cbrt(share), kMinDepth);
    if (layout.shape == TableShape::disk)
      for (int* side : {&layout.width, &layout.height}) shorten(*side, std::sqrt(share), kMinDiskSide);
  }
  return spec;
}

std::optional<ModelSpec> lay_out(const ProductForm& form, const CostLimit& limit, std::size_t channels) {
  const double texels = static_cast<double>(limit.bytes / limit.texel_bytes);
  ModelSpec spec = parse_model_spec(form.model, {}, false);
  std::vector<TableLayout*> of_half_vectors;
  const auto of_difference = static_cast<double>(std::ranges::count_if(spec.tables, [](const auto& table) {
    return table.layout.shape == TableShape::grid || table.layout.shape == TableShape::volume;
  }));

  // Each table except those of half vectors gets its share of the texels.
  for (std::size_t t = 0; t < spec.tables.size(); ++t) {
    TableLayout& layout = spec.tables[t].layout;
    const FactorUse& use = use_of(spec, t);
    const double nodes = form.difference / of_difference * texels;
    if (layout.shape == TableShape::line) {
      layout.width = kWideNodes;
    } else if (layout.shape == TableShape::grid) {
      layout = grid_of_difference(nodes);
    } else if (layout.shape == TableShape::volume) {
      spec.tables[t].circle_z = use.projection_z == kProjectSide;
      layout = volume_of(spec.tables[t].circle_z ? kSigned : kFolded, nodes);
      if (layout.width < 2) return {};
    } else if (use.projection == kProjectHalf) {
      layout = {.shape = TableShape::disk, .width = 0, .height = 0, .warp = kHalfDiskWarp};
      of_half_vectors.push_back(&layout);
    } else {
      layout = disk_of(form.border * texels);
    }
  }

  // Tables of half vectors have no nodes yet, so this count is that of the other tables. They share the rest.
  const std::size_t taken = model_bytes(spec, channels, limit.texel_bytes);
  const double rest =
      taken < limit.bytes ? static_cast<double>((limit.bytes - taken) / limit.texel_bytes) : 0;
  for (TableLayout* layout : of_half_vectors)
    *layout = disk_of(rest / static_cast<double>(of_half_vectors.size()), kHalfDiskWarp);
  if (model_bytes(spec, channels, limit.texel_bytes) > limit.bytes) return {};
  return spec;
}

}  // namespace burnish
