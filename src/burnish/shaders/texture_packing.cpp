// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/shaders/frame_function.h>
#include <burnish/shaders/half_range.h>
#include <burnish/shaders/texture_packing.h>

namespace burnish {

namespace {

constexpr int kMaxTextureSide = 16384;
// Tables stand side by side up to this width, where a texture is wider than its widest table.
constexpr int kMaxPackedWidth = 4096;

// Along an axis: where a table's nodes are, and how far its edges are repeated.
struct SpotAxis {
  int first = 0, nodes = 1, low = 0, high = 1;
};
struct Spot {
  std::size_t table = 0;
  std::array<SpotAxis, 3> axes{};
};
struct PackingPlan {
  std::array<int, 3> size{0, 0, 1};
  std::vector<Spot> spots;

  long texels() const noexcept { return long{size[0]} * size[1] * size[2]; }
};

using TableNumbers = std::vector<std::size_t>;

// Tables beside each other in shelves, the highest first.
PackingPlan shelves(std::span<const Table> tables, const TableNumbers& order, int width) {
  PackingPlan plan{.size = {width, 0, 1}, .spots = {}};
  int top = 0, bottom = 0;  // of the shelf with its border
  for (const std::size_t i : order) {
    const TableLayout& layout = tables[i].layout;
    const int border = layout.height > 1;  // rows are read in their middle
    SpotAxis x{.first = 0, .nodes = layout.width, .low = 0, .high = width};
    SpotAxis y{.first = 0, .nodes = layout.height, .low = top, .high = 0};
    Spot* const last = plan.spots.empty() ? nullptr : &plan.spots.back();
    const int beside = last ? last->axes[0].first + last->axes[0].nodes + 2 : 0;
    if (last && beside + layout.width <= width) {
      y.first = last->axes[1].first;
      x.first = beside;
      x.low = last->axes[0].high = beside - 1;
    } else {
      y.low = top = bottom;
      y.first = last ? top + border : 0;
      bottom = y.first + layout.height + border;
      plan.size[1] = y.first + layout.height;
    }
    y.high = bottom;
    plan.spots.push_back({i, {x, y, {}}});
  }
  // the last shelf ends with the texture
  const bool lines = std::ranges::any_of(order, [&](std::size_t i) { return tables[i].layout.height == 1; });
  if (lines) plan.size[1] = static_cast<int>(std::bit_ceil(static_cast<unsigned>(plan.size[1])));
  for (Spot& spot : plan.spots)
    if (spot.axes[1].low == top) spot.axes[1].high = plan.size[1];
  return plan;
}

// The width that takes fewest texels, of those the one with fewest rows.
PackingPlan plan_2d(std::span<const Table> tables, TableNumbers order) {
  const auto size_of = [&](std::size_t i) {
    return std::pair(tables[i].layout.height, tables[i].layout.width);
  };
  std::ranges::stable_sort(order, std::greater{}, size_of);
  int width = 0;
  for (const std::size_t i : order) width = std::max(width, tables[i].layout.width);
  PackingPlan best = shelves(tables, order, width);
  for (width = static_cast<int>(std::bit_ceil(static_cast<unsigned>(width))); width <= kMaxPackedWidth;
       width *= 2)
    if (PackingPlan plan = shelves(tables, order, width); plan.texels() <= best.texels())
      best = std::move(plan);
  return best;
}

// Volumes behind each other, and behind what is before them.
PackingPlan plan_3d(std::span<const Table> tables, const TableNumbers& order, const LayersBefore* before) {
  PackingPlan plan;
  if (before) plan.size = {before->width, before->height, before->depth};
  for (const std::size_t i : order) {
    const TableLayout& layout = tables[i].layout;
    plan.size[0] = std::max(plan.size[0], layout.width);
    plan.size[1] = std::max(plan.size[1], layout.height);
    SpotAxis z{.first = 0, .nodes = layout.depth, .low = 0, .high = 0};
    if (before || !plan.spots.empty()) {
      z.first = plan.size[2] + 2;
      z.low = z.first - 1;
      if (!plan.spots.empty()) plan.spots.back().axes[2].high = z.low;
    }
    plan.size[2] = z.high = z.first + layout.depth;
    plan.spots.push_back({i, {SpotAxis{0, layout.width, 0, 0}, SpotAxis{0, layout.height, 0, 0}, z}});
  }
  for (Spot& spot : plan.spots)
    for (std::size_t axis = 0; axis < 2; ++axis) spot.axes[axis].high = plan.size[axis];
  return plan;
}

// A format that holds every table.
TableFormat common_format(std::span<const Table> tables, const TableNumbers& numbers) {
  const TableFormat first = tables[numbers.front()].format;
  const auto all = [&](auto holds) {
    return std::ranges::all_of(numbers, [&](std::size_t i) { return holds(tables[i]); });
  };
  if (all([&](const Table& table) { return table.format == first; })) return first;
  const bool halves = all([&](const Table& table) {
    return round_to_format(TableFormat::half, table.channels, table.values) == table.values;
  });
  return halves ? TableFormat::half : TableFormat::single;
}

// The table's nodes and what repeats its edges.
void fill(ShaderTexture& texture, const Spot& spot, const Table& table, int exponent) {
  const auto& [ax, ay, az] = spot.axes;
  const auto node_of = [](int texel, const SpotAxis& axis) {
    return std::clamp(texel - axis.first, 0, axis.nodes - 1);
  };
  const std::size_t channels = texture.channels, step = table.channels == 1 ? 0 : 1;
  for (int z = az.low; z < az.high; ++z)
    for (int y = ay.low; y < ay.high; ++y)
      for (int x = ax.low; x < ax.high; ++x) {
        const int row = node_of(z, az) * ay.nodes + node_of(y, ay);
        const auto from = static_cast<std::size_t>(row * ax.nodes + node_of(x, ax)) * table.channels,
                   to = static_cast<std::size_t>((z * texture.height + y) * texture.width + x) * channels;
        for (std::size_t c = 0; c < channels; ++c)
          texture.values[to + c] = std::ldexp(table.values[from + c * step], exponent);
      }
}

ShaderTexture packed(std::span<const Table> tables, const TableNumbers& numbers, const PackingPlan& plan,
                     const std::vector<int>& exponents, std::string name, bool deep,
                     std::size_t channels = 1) {
  ShaderTexture texture{.name = std::move(name),
                        .width = plan.size[0],
                        .height = plan.size[1],
                        .depth = deep ? plan.size[2] : 0,
                        .channels = channels,
                        .format = common_format(tables, numbers),
                        .values = {},
                        .tables = {}};
  if (std::ranges::max(plan.size) > kMaxTextureSide)
    throw Error(
        fmt::format("shader: expected tables that fit into a texture of sides to {}, found {} x {} x {}",
                    kMaxTextureSide, plan.size[0], plan.size[1], plan.size[2]));
  for (const std::size_t i : numbers) texture.channels = std::max(texture.channels, tables[i].channels);
  texture.values.resize(static_cast<std::size_t>(plan.texels() * texture.channels));
  for (const Spot& spot : plan.spots) {
    const int exponent = exponents[spot.table];
    fill(texture, spot, tables[spot.table], exponent);
    texture.tables.push_back(
        {spot.table, {spot.axes[0].first, spot.axes[1].first, spot.axes[2].first}, exponent});
  }
  return texture;
}

}  // namespace

std::vector<ShaderTexture> pack_tables(const FactoredBrdf& brdf, const std::string& name,
                                       const LayersBefore* before) {
  TableNumbers flat, deep;
  for (std::size_t i = 0; i < brdf.tables().size(); ++i)
    (brdf.tables()[i].layout.shape == TableShape::volume ? deep : flat).push_back(i);
  const std::vector<int> exponents = table_exponents(brdf);
  std::vector<ShaderTexture> textures;
  if (!flat.empty())
    textures.push_back(packed(brdf.tables(), flat, plan_2d(brdf.tables(), flat), exponents,
                              fmt::format("burnish_{}_tables", name), false));
  if (!deep.empty())
    textures.push_back(packed(brdf.tables(), deep, plan_3d(brdf.tables(), deep, before), exponents,
                              before ? before->name : fmt::format("burnish_{}_volumes", name), true,
                              before ? before->channels : 1));
  return textures;
}

std::vector<ShaderTexture> tables_apart(const FactoredBrdf& brdf, const std::string& name) {
  std::vector<ShaderTexture> textures;
  for (std::size_t i = 0; i < brdf.tables().size(); ++i) {
    const Table& table = brdf.tables()[i];
    textures.push_back({.name = is_identifier(table.name)
                                    ? fmt::format("burnish_{}_table_{}", name, table.name)
                                    : fmt::format("burnish_{}_table{}", name, i),
                        .width = table.layout.width,
                        .height = table.layout.rows(),
                        .channels = table.channels,
                        .format = table.format,
                        .values = table.values,
                        .tables = {{i}}});
  }
  return textures;
}

}  // namespace burnish
