// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/eval/factored_plan.h>

namespace burnish {

namespace {

constexpr std::uint32_t kShiftedZero = 0x4b400000;  // the bits of 1.5 2^23

// Returns the largest ratio of entries that one lookup mixes.
double steepest_ratio(const Table& table) noexcept {
  const auto channels = table.channels;
  const auto width = static_cast<std::size_t>(table.layout.width),
             height = static_cast<std::size_t>(table.layout.height),
             depth = static_cast<std::size_t>(table.layout.depth);
  const std::size_t row = height > 1 ? width * channels : 0, layer = depth > 1 ? row * height : 0;
  double ratio = 1;
  for (std::size_t z = 0; z + (layer ? 1 : 0) < depth; ++z)
    for (std::size_t y = 0; y + (row ? 1 : 0) < height; ++y)
      for (std::size_t x = 0; x + 1 < width; ++x)
        for (std::size_t c = 0; c < channels; ++c) {
          // A cell has up to eight corners; a table without rows or layers sees the same ones again.
          const float* v = table.values.data() + ((z * height + y) * width + x) * channels + c;
          const float* w = v + layer;
          const auto [least, most] = std::minmax({v[0], v[channels], v[row], v[row + channels],  //
                                                  w[0], w[channels], w[row], w[row + channels]});
          ratio = std::max(ratio, static_cast<double>(most) / least);
        }
  return ratio;
}

double lookup_bound(const Table& table) noexcept {
  // The relative error of a lookup in units of 2^-24: rounding of the interpolation, and errors of the positions
  // times the steepest relative slope, which is (ratio - 1) a cell.
  const double ratio = steepest_ratio(table);
  const TableLayout& layout = table.layout;
  const int cells = std::max({layout.width, layout.height, layout.depth}) - 1;
  return 0x1p-24 * (8 * ratio + 16 * axis_count(layout.shape) * cells * (ratio - 1));
}

// Makes a position along an axis of `nodes` nodes.
FactoredPlan::Position position_in(Warp warp, int nodes, bool disk, std::size_t slot) noexcept {
  const auto cells = static_cast<float>(nodes - 1);
  return {.disk = disk,
          .warp = warp.kind,
          .parameter = static_cast<float>(warp.parameter),
          .size = disk ? 0.5f * cells : cells,
          .cells = cells,
          .slot = slot};
}

FactoredPlan::Source::Kind kind_of(const Projection& projection, bool azimuth) noexcept {
  using Kind = FactoredPlan::Source::Kind;
  return projection == kProjectWi                      ? Kind::wi
         : projection == kProjectWo                    ? Kind::wo
         : projection == kProjectHalf                  ? Kind::half
         : projection.kind == Projection::Kind::affine ? Kind::affine
         : azimuth                                     ? Kind::difference
                                                       : Kind::angle;
}

FactoredPlan::Spacing spacing_of(const FactoredPlan::Position& position) noexcept {
  using Spacing = FactoredPlan::Spacing;
  switch (position.warp) {
    case WarpKind::rational:
      return Spacing::rational;
    case WarpKind::power:
      return position.parameter == 0.5f ? Spacing::root : Spacing::power;
    case WarpKind::identity:
      break;
  }
  return Spacing::identity;
}

// The projections whose polar angles are found together.
struct AngleOf {
  Projection projection;
  FactoredPlan::Angle angle;
};
constexpr std::array kTogetherFound{
    AngleOf{kProjectWi, FactoredPlan::Angle::wi},
    AngleOf{kProjectWo, FactoredPlan::Angle::wo},
    AngleOf{kProjectHalf, FactoredPlan::Angle::half},
    AngleOf{kProjectAzimuth, FactoredPlan::Angle::azimuth},
    AngleOf{kProjectDifference, FactoredPlan::Angle::difference},
    AngleOf{kProjectDeviation, FactoredPlan::Angle::deviation},
};

std::size_t up_to_multiple(std::size_t n, std::size_t of) noexcept {
  return (n + of - 1) / of * of;
}

}  // namespace

bool FactoredPlan::Position::same_place(const Position& other) const noexcept {
  return std::tie(disk, warp, parameter, size, cells) ==
         std::tie(other.disk, other.warp, other.parameter, other.size, other.cells);
}

FactoredPlan::FactoredPlan(const FactoredBrdf& brdf)
    : channels(brdf.channels()), isotropic(brdf.isotropic()) {
  // Each table's values are laid out once; a lookup is one use of them.
  std::vector<Lookup> tables;
  for (const Table& table : brdf.tables()) tables.push_back(add_table(table));
  for (std::size_t j = 0; j < brdf.lobes().size(); ++j) {
    const std::size_t paired = 2 * brdf.pair_count(j), first = lookups.size();
    // The bound of a lobe adds the bounds of its lookups. The sum of the lobes rounds once more for each.
    double bound = 0x1p-24 * static_cast<double>(brdf.lobes().size());
    std::size_t k = 0;
    for (const FactorUse& use : brdf.ordered_factors(j)) {
      const Table& table = brdf.tables()[use.table];
      bound += lookup_bound(table);
      const auto at = slots_of(table.layout, use);
      if (k < paired && k % 2 == 1) {
        lookups.back().pair = true;
        lookups.back().pair_at = at;
        lookups.back().pair_steps_at = steps_of(table.layout, use);
      } else {
        lookups.push_back(tables[use.table]);
        lookups.back().at = at;
        lookups.back().steps_at = steps_of(table.layout, use);
      }
      ++k;
    }
    products.push_back({first, lookups.size(), {}});
    for (const double s : brdf.lobes()[j].scale) products.back().scale.push_back(static_cast<float>(s));
    products.back().scale.resize(up_to_multiple(channels, kTogether) + 1);  // loaded in fours
    rounding_bound = std::max(rounding_bound, bound);
  }
  if (slots > kMaxSlots)
    throw Error(
        fmt::format("evaluator: expected at most {} positions in tables, found {}", kMaxSlots, slots));
  volume_and_line = find_volume_and_line(brdf);
}

// Returns the plan's data if the model has the form of VolumeAndLine, else nothing.
std::optional<FactoredPlan::VolumeAndLine> FactoredPlan::find_volume_and_line(const FactoredBrdf& brdf) {
  if (channels != kTogether || products.size() != 1 || lookups.empty() || lookups.size() > 2) return {};
  VolumeAndLine found;
  const auto set_lane = [&](std::size_t lane, Warp warp, int nodes, std::size_t stride, std::size_t start) {
    found.cells[lane] = static_cast<float>(nodes - 1);
    found.root[lane] = warp == Warp{WarpKind::power, 0.5} ? -1 : 0;
    const auto floats = static_cast<std::uint32_t>(stride * kRowStride);
    found.floats[lane] = static_cast<std::int32_t>(floats);
    found.start[lane] = static_cast<std::int32_t>(static_cast<std::uint32_t>(start) - floats * kShiftedZero);
    return found.root[lane] != 0 || warp.kind == WarpKind::identity;
  };
  std::optional<std::size_t> volume, line;  // indices in `lookups`
  for (std::size_t k = 0; k < lookups.size(); ++k) {
    const Lookup& lookup = lookups[k];
    const FactorUse& use = brdf.ordered_factors(0)[k];
    const TableLayout& layout = brdf.tables()[use.table].layout;
    if (lookup.pair || use.projection != kProjectHalf) return {};
    if (layout.shape == TableShape::line && !line) {
      line = k;
      if (!set_lane(1, layout.warp, layout.width, 1, values.size())) return {};
    } else if (layout.shape == TableShape::volume && !volume) {
      volume = k;
      found.above = lookup.width * kRowStride;
      found.layer = lookup.layer * kRowStride;
      if (use.projection_y != kProjectDifference || use.projection_z != kProjectAzimuth ||
          !set_lane(0, layout.warp_y, layout.height, lookup.width, lookup.rows) ||
          !set_lane(2, layout.warp, layout.width, 1, 0) ||
          !set_lane(3, layout.warp_z, layout.depth, lookup.layer, 0))
        return {};
    } else {
      return {};
    }
  }
  if (!volume) return {};
  // The line's nodes are multiplied by the scale. Without a line, two nodes of the scale stand for one.
  if (!line) set_lane(1, {}, 2, 0, values.size());
  const std::size_t from = line ? lookups[*line].rows : 0,
                    count = line ? lookups[*line].row_block : 2 * kRowStride;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back((line ? values[from + i] : 1.0f) * products.front().scale[i % kRowStride]);
  return found;
}

FactoredPlan::Lookup FactoredPlan::add_table(const Table& table) {
  const auto stored = table.channels, nodes = table.layout.node_count();
  const std::size_t groups = up_to_multiple(stored, kTogether) / kTogether;
  Lookup lookup{.axes = axis_count(table.layout.shape),
                .shared = table.channels == 1,
                .width = static_cast<std::size_t>(table.layout.width)};
  lookup.layer = lookup.width * static_cast<std::size_t>(table.layout.height);
  // The last position, in cells, is the last node: lookups there read past it and give it no weight.
  lookup.rows = values.size();
  lookup.row_block = (nodes + (lookup.axes > 2 ? lookup.layer : 0) + lookup.width + 2) * kRowStride;
  lookup.next_group = lookup.shared ? 0 : lookup.row_block;
  for (std::size_t g = 0; g < groups; ++g) {
    const std::size_t begin = values.size();
    for (std::size_t i = 0; i < nodes; ++i)
      for (std::size_t c = 0; c < kRowStride; ++c) {
        const std::size_t channel = lookup.shared ? 0 : g * kTogether + c;
        values.push_back(channel < stored ? table.values[i * stored + channel] : 0.0f);
      }
    values.resize(begin + lookup.row_block);
  }
  if (lookup.axes > 1 || nodes > kMaxVectors * kPlaneVector) return lookup;
  lookup.planes = values.size();
  for (lookup.plane_vectors = 1; lookup.plane_vectors * kPlaneVector < nodes;) lookup.plane_vectors *= 2;
  for (std::size_t c = 0; c < (lookup.shared ? 1 : groups * kTogether); ++c) {
    const std::size_t begin = values.size();
    for (std::size_t i = 0; c < stored && i < nodes; ++i) values.push_back(table.values[i * stored + c]);
    values.resize(begin + lookup.plane_vectors * kPlaneVector);
  }
  return lookup;
}

std::array<std::size_t, 3> FactoredPlan::slots_of(const TableLayout& layout, const FactorUse& use) {
  const bool disk = layout.shape == TableShape::disk;
  const std::size_t x = slot_of(use.projection, layout.warp, layout.width, disk);
  if (disk) return {x, x + 1, x};
  const int axes = axis_count(layout.shape);
  const std::size_t y = axes > 1 ? slot_of(use.projection_y, layout.warp_y, layout.height, false) : x;
  return {x, y, axes > 2 ? slot_of(use.projection_z, layout.warp_z, layout.depth, false) : x};
}

// Returns the slot of a position, the same for equal positions.
std::size_t FactoredPlan::slot_of(const Projection& projection, Warp warp, int nodes, bool disk) {
  const Position position = position_in(warp, nodes, disk, slots);
  Source& source = source_of(projection, disk);
  source.radius |= !disk || warp.kind != WarpKind::identity;
  for (const Position& known : source.positions)
    if (known.same_place(position)) return known.slot;
  slots += disk ? 2 : 1;
  // A position by a power is put behind one of the same power, whose result it shares.
  const auto same = std::ranges::find_if(source.positions, [&](const Position& known) {
    return !disk && !known.disk && warp.kind == WarpKind::power && known.warp == warp.kind &&
           known.parameter == position.parameter;
  });
  const bool shares = same != source.positions.end();
  source.positions.insert(shares ? same + 1 : same, position)->shares_power = shares;
  return position.slot;
}

std::array<std::uint32_t, 3> FactoredPlan::steps_of(const TableLayout& layout, const FactorUse& use) {
  if (layout.shape == TableShape::disk) {
    const auto [x, y] = steps_across(layout, use);
    return {x, y, x};
  }
  const auto width = static_cast<std::size_t>(layout.width), height = static_cast<std::size_t>(layout.height);
  const int axes = axis_count(layout.shape);
  const std::uint32_t x = steps_along(use.projection, layout.warp, layout.width, 1);
  const std::uint32_t y = axes > 1 ? steps_along(use.projection_y, layout.warp_y, layout.height, width) : x;
  return {x, y, axes > 2 ? steps_along(use.projection_z, layout.warp_z, layout.depth, width * height) : x};
}

// Returns the lane of a position along a polar angle, the same for equal positions.
std::uint32_t FactoredPlan::steps_along(const Projection& projection, Warp warp, int nodes,
                                        std::size_t stride) {
  const Position position = position_in(warp, nodes, false, 0);
  const Spacing spacing = spacing_of(position);
  if (const auto found = std::ranges::find(kTogetherFound, projection, &AngleOf::projection);
      found != kTogetherFound.end()) {
    const auto angle = static_cast<std::size_t>(found->angle);
    has_angle[angle] = true;
    return lane_of(spacing, position, stride, angle, false);
  }
  const auto known = static_cast<std::size_t>(std::ranges::find(apart, projection) - apart.begin());
  if (known < Steps::kLanes) {
    if (known == apart.size()) apart.push_back(projection);
    return lane_of(spacing, position, stride, known, true);
  }
  const std::uint32_t lane = lane_of(Spacing::given, position, stride, 0, false);
  given.push_back({kind_of(projection, false), projection, position, spacing, lane, lane});
  return lane;
}

// Returns the lanes of a disk's x and y.
std::array<std::uint32_t, 2> FactoredPlan::steps_across(const TableLayout& layout, const FactorUse& use) {
  const Position position = position_in(layout.warp, layout.width, true, 0);
  for (const GivenSteps& known : given)
    if (known.projection == use.projection && known.position.same_place(position)) return {known.x, known.y};
  const std::uint32_t x = lane_of(Spacing::given, position, 1, 0, false);
  const std::uint32_t y = lane_of(Spacing::given, position, static_cast<std::size_t>(layout.width), 0, false);
  given.push_back({kind_of(use.projection, true), use.projection, position, spacing_of(position), x, y});
  return {x, y};
}

// Returns a lane with this position along this angle; always a new one for given positions.
std::uint32_t FactoredPlan::lane_of(Spacing spacing, const Position& position, std::size_t stride,
                                    std::size_t angle, bool is_apart) {
  const auto floats = static_cast<std::int32_t>(stride * kRowStride),
             number = static_cast<std::int32_t>(angle), mask = is_apart ? -1 : 0;
  for (std::size_t i = 0; i < steps.size() && spacing != Spacing::given; ++i) {
    const Steps& s = steps[i];
    for (std::size_t k = 0; k < s.used; ++k)
      if (std::tie(s.spacing[k], s.size[k], s.parameter[k], s.floats[k], s.angle[k], s.is_apart[k]) ==
          std::tie(spacing, position.size, position.parameter, floats, number, mask))
        return static_cast<std::uint32_t>(i * Steps::kLanes + k);
  }
  if (steps.empty() || steps.back().used == Steps::kLanes) steps.emplace_back();
  Steps& open = steps.back();
  const std::size_t lane = open.used++;
  open.has[static_cast<std::size_t>(spacing)] = true;
  open.is[static_cast<std::size_t>(spacing)][lane] = -1;
  open.spacing[lane] = spacing;
  open.size[lane] = position.size;
  open.parameter[lane] = position.parameter;
  open.cells[lane] = position.cells;
  open.floats[lane] = floats;
  open.angle[lane] = number;
  open.is_apart[lane] = mask;
  open.has_apart |= is_apart;
  return static_cast<std::uint32_t>((steps.size() - 1) * Steps::kLanes + lane);
}

FactoredPlan::Source& FactoredPlan::source_of(const Projection& projection, bool azimuth) {
  using Kind = Source::Kind;
  const Kind kind = kind_of(projection, azimuth);
  needs_sum |= kind != Kind::wi && kind != Kind::wo && kind != Kind::affine;
  for (Source& source : sources)
    if (source.kind == kind && source.projection == projection) return source;
  return sources.emplace_back(Source{.kind = kind, .projection = projection});
}

}  // namespace burnish
