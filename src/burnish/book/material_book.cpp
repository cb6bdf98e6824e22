// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <burnish/book/material_book.h>
#include <burnish/error.h>

namespace burnish {

namespace {

using std::numbers::sqrt2, std::numbers::inv_sqrt3;

constexpr double kSqrt6 = sqrt2 / inv_sqrt3;
constexpr double kMinValue = 1e-6;     // 1/sr: what is at or below the floor stays positive
constexpr double kMaxLogOverLine = 7;  // logarithm of the volume's largest value
constexpr double kMaxLog = 80;         // of f at a node: single floats end soon after
constexpr std::size_t kHalfBytes = 2, kNumbersAComponent = 3;

bool positive(float value) {
  return std::isfinite(value) && value > 0;
}

void check(bool holds, const char* expected, const std::string& found) {
  if (!holds) throw Error(fmt::format("book: expected {}, found {}", expected, found));
}

void check_axis(const BookAxis& axis, std::size_t nodes) {
  const std::size_t count = axis.component_count();
  check(axis.mean.size() == nodes, "a mean of every node", fmt::format("{}", axis.mean.size()));
  check(count <= MaterialBook::kMaxComponents, "at most 256 components of an axis", fmt::format("{}", count));
  check(axis.components.size() == count * nodes, "a number of every node and component",
        fmt::format("{}", axis.components.size()));
  check(axis.steps.size() == count && axis.deviations.size() == count,
        "a step and a deviation of every component",
        fmt::format("{} and {}", axis.steps.size(), axis.deviations.size()));
  check(std::ranges::all_of(axis.mean, [](float v) { return std::isfinite(v); }), "finite means", "others");
  check(positive(axis.residual) && std::ranges::all_of(axis.scales, positive) &&
            std::ranges::all_of(axis.steps, positive) && std::ranges::all_of(axis.deviations, positive),
        "scales, steps and deviations above 0", "others");
}

// With a node between any two along theta_d and phi_d. Tables are linear in f where a book is in its logarithm, and
// between nodes that are far apart these differ; along theta_h nodes are near one another.
TableLayout refined(TableLayout layout) {
  layout.height = 2 * layout.height - 1;
  layout.depth = 2 * layout.depth - 1;
  return layout;
}

std::vector<double> refined(const TableLayout& coarse, std::span<const double> logs) {
  const TableLayout fine = refined(coarse);
  const auto row = static_cast<std::size_t>(coarse.width) * MaterialBook::kChannels;
  const auto coarse_height = static_cast<std::size_t>(coarse.height),
             height = static_cast<std::size_t>(fine.height), depth = static_cast<std::size_t>(fine.depth);
  std::vector<double> all(row * height * depth);
  for (std::size_t z = 0; z < depth; ++z)
    for (std::size_t y = 0; y < height; ++y)
      for (std::size_t x = 0; x < row; ++x) {
        // an odd place is the mean of its neighbours, an even one of itself and itself
        const auto at = [&](std::size_t layer, std::size_t line) {
          return logs[(layer * coarse_height + line) * row + x];
        };
        all[(z * height + y) * row + x] = (at(z / 2, y / 2) + at(z / 2, (y + 1) / 2) +
                                           at((z + 1) / 2, y / 2) + at((z + 1) / 2, (y + 1) / 2)) /
                                          4;
      }
  return all;
}

}  // namespace

const std::array<std::array<double, 3>, MaterialBook::kAxes> kBookAxes = {
    {{inv_sqrt3, inv_sqrt3, inv_sqrt3}, {1 / sqrt2, 0, -1 / sqrt2}, {1 / kSqrt6, -2 / kSqrt6, 1 / kSqrt6}}};

TableLayout book_layout(std::array<int, 3> sides) {
  return {.shape = TableShape::volume,
          .width = sides[0],
          .height = sides[1],
          .depth = sides[2],
          .warp = {WarpKind::power, 0.5},
          .warp_y = {},
          .warp_z = {}};
}

FactorUse book_use() {
  return {.table = 1,
          .projection = kProjectHalf,
          .projection_y = kProjectDifference,
          .projection_z = kProjectAzimuth};
}

std::array<NodeShare, 8> book_nodes(const TableLayout& layout, const DirectionPair& pair) noexcept {
  const Lookup at = locate(layout, book_use(), pair.wi, pair.wo);
  const auto width = static_cast<std::size_t>(layout.width),
             layer = width * static_cast<std::size_t>(layout.height);
  std::array<NodeShare, 8> shares;
  for (std::size_t corner = 0; corner < shares.size(); ++corner) {
    const bool x = (corner & 1) != 0, y = (corner & 2) != 0, z = (corner & 4) != 0;
    shares[corner] = {static_cast<std::size_t>(at.node) + x + y * width + z * layer,
                      (x ? at.fx : 1 - at.fx) * (y ? at.fy : 1 - at.fy) * (z ? at.fz : 1 - at.fz)};
  }
  return shares;
}

FactoredBrdf brdf_of_logs(const TableLayout& coarse, std::span<const double> coarse_logs,
                          TableFormat format) {
  constexpr std::size_t kChannels = MaterialBook::kChannels;
  const TableLayout layout = refined(coarse);
  const std::vector<double> logs = refined(coarse, coarse_logs);
  std::vector<double> log_f;
  for (const double log : logs)
    log_f.push_back(std::log(std::max(std::exp(std::min(log, kMaxLog)) - MaterialBook::kFloor, kMinValue)));

  // the line: the mean of what its theta_h holds away from grazing, as far as a table's range goes
  const auto width = static_cast<std::size_t>(layout.width), height = static_cast<std::size_t>(layout.height);
  std::vector<double> mean(width, 0.0), counts(width, 0.0);
  for (std::size_t i = 0; i < log_f.size(); ++i) {
    const std::size_t node = i / kChannels;
    if (node / width % height > height / 2) continue;
    mean[node % width] += log_f[i];
    ++counts[node % width];
  }
  for (std::size_t x = 0; x < width; ++x) mean[x] /= counts[x];
  const double floor = std::ranges::max(mean) + std::log(2 * kTableFloor);
  for (double& log : mean) log = std::max(log, floor);

  // the volume: what is left, nowhere so bright that dark texels had no bits
  Table line{.name = "z",
             .layout = {.width = layout.width, .warp = layout.warp, .warp_y = {}, .warp_z = {}},
             .channels = 1,
             .values = {mean.begin(), mean.end()},
             .format = format == TableFormat::rgb9e5 ? TableFormat::half : format};
  Table volume{.name = "g", .layout = layout, .channels = kChannels, .values = {}, .format = format};
  for (std::size_t i = 0; i < log_f.size(); ++i)
    volume.values.push_back(
        static_cast<float>(std::min(log_f[i] - mean[i / kChannels % width], kMaxLogOverLine)));
  Lobe lobe{.scale = std::vector<double>(kChannels, 0.0),
            .factors = {{.table = 0, .projection = kProjectHalf, .projection_y = {}, .projection_z = {}},
                        book_use()}};
  return from_log_tables(kChannels, {std::move(line), std::move(volume)}, {std::move(lobe)});
}

MaterialBook::MaterialBook(std::array<int, 3> sides, std::array<BookAxis, kAxes> axes,
                           std::vector<Material> materials)
    : layout_(book_layout(sides)), axes_(std::move(axes)), materials_(std::move(materials)) {
  check_layout(layout_, "g");
  for (const BookAxis& axis : axes_) check_axis(axis, node_count());
  check(materials_.size() <= kMaxMaterials, "at most 1048576 materials",
        fmt::format("{}", materials_.size()));
  std::set<std::string_view> names;
  for (const Material& material : materials_) {
    check(!material.name.empty() && names.insert(material.name).second, "names, no two alike",
          fmt::format("'{}' again", material.name));
    check(material.weights.size() == bytes_a_material(), "a weight of every component",
          fmt::format("{}", material.weights.size()));
  }
}

std::optional<std::size_t> MaterialBook::find(std::string_view name) const noexcept {
  const auto at = std::ranges::find(materials_, name, &Material::name);
  if (at == materials_.end()) return std::nullopt;
  return static_cast<std::size_t>(at - materials_.begin());
}

std::size_t MaterialBook::shared_bytes() const noexcept {
  std::size_t bytes = 0;
  for (const BookAxis& axis : axes_)
    bytes += axis.mean.size() * kHalfBytes + axis.components.size() +
             (kNumbersAComponent * axis.component_count() + 1) * sizeof(float);
  return bytes;
}

std::size_t MaterialBook::bytes_a_material() const noexcept {
  std::size_t bytes = 0;
  for (const BookAxis& axis : axes_) bytes += axis.component_count();
  return bytes;
}

std::array<std::vector<double>, MaterialBook::kAxes> MaterialBook::weights(std::size_t i) const {
  std::array<std::vector<double>, kAxes> weights;
  std::size_t at = 0;
  for (std::size_t u = 0; u < kAxes; ++u)
    for (const float step : axes_[u].steps)
      weights[u].push_back(static_cast<double>(step) * materials_[i].weights[at++]);
  return weights;
}

std::vector<double> MaterialBook::logs(const std::array<std::vector<double>, kAxes>& weights) const {
  const std::size_t nodes = node_count();
  std::vector<double> logs(nodes * kChannels, 0.0), line(nodes);
  for (std::size_t u = 0; u < kAxes; ++u) {
    const BookAxis& axis = axes_[u];
    std::ranges::copy(axis.mean, line.begin());
    for (std::size_t k = 0; k < axis.component_count(); ++k) {
      const double weight = weights[u][k] * static_cast<double>(axis.scales[k]);
      for (std::size_t n = 0; n < nodes; ++n) line[n] += weight * axis.components[k * nodes + n];
    }
    for (std::size_t n = 0; n < nodes; ++n)
      for (std::size_t c = 0; c < kChannels; ++c) logs[n * kChannels + c] += line[n] * kBookAxes[u][c];
  }
  return logs;
}

FactoredBrdf MaterialBook::brdf(std::size_t i, TableFormat format) const {
  return brdf_of_logs(layout_, logs(weights(i)), format);
}

}  // namespace burnish
