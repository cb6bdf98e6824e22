// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>

#include <burnish/baselines/node_table.h>
#include <burnish/error.h>
#include <burnish/factors/table.h>
#include <burnish/math/half.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxValues = std::size_t{1} << 26;

}  // namespace

std::size_t NodeTable::node_count() const noexcept {
  std::size_t count = 1;
  for (const NodeAxis& axis : axes) count *= static_cast<std::size_t>(axis.count);
  return count;
}

NodeCorners corners(std::span<const NodeAxis> axes, const PairPlace& place) noexcept {
  // each axis doubles the corners: those so far at its lower node, then the same at its upper one
  NodeCorners result;
  result.node[0] = 0;
  result.weight[0] = 1;
  result.count = 1;
  for (const NodeAxis& axis : axes) {
    // the two nodes; those of a periodic axis go around, and the last is followed by the first
    const double u = std::clamp(place[axis.coordinate], 0.0, 1.0);
    const bool periodic = is_periodic(axis.coordinate);
    const double position = u * (periodic ? axis.count : axis.count - 1);
    const int lower = std::min(static_cast<int>(position), periodic ? axis.count - 1 : axis.count - 2);
    const int upper = lower + 1 == axis.count ? 0 : lower + 1;
    const double fraction = position - lower;
    const auto side = static_cast<std::size_t>(axis.count);
    for (std::size_t k = 0; k < result.count; ++k) {
      const std::size_t row = result.node[k] * side;
      result.node[k] = row + static_cast<std::size_t>(lower);
      result.node[k + result.count] = row + static_cast<std::size_t>(upper);
      result.weight[k + result.count] = fraction * result.weight[k];
      result.weight[k] *= 1 - fraction;
    }
    result.count *= 2;
  }
  return result;
}

double node_value(const NodeTable& table, const NodeCorners& at, std::size_t channel,
                  std::size_t term) noexcept {
  assert(channel < table.channels && term < static_cast<std::size_t>(table.terms));
  const auto terms = static_cast<std::size_t>(table.terms), stride = terms * table.channels;
  const float* const first = table.values.data() + channel * terms + term;
  double sum = 0;
  for (std::size_t k = 0; k < at.count; ++k) sum += at.weight[k] * first[at.node[k] * stride];
  return sum;
}

void check_node_table(const NodeTable& table, std::size_t brdf_channels, const std::string& name) {
  const auto fail = [&](const std::string& expected, const std::string& found) {
    throw Error(fmt::format("table '{}': expected {}, found {}", name, expected, found));
  };
  if (table.axes.empty() || table.axes.size() > NodeTable::kMaxAxes)
    fail(fmt::format("1 to {} axes", NodeTable::kMaxAxes), fmt::format("{}", table.axes.size()));
  if (table.channels != 1 && table.channels != brdf_channels)
    fail(fmt::format("1 or {} channels", brdf_channels), fmt::format("{}", table.channels));
  if (table.terms < 1 || static_cast<std::size_t>(table.terms) > kMaxValues)
    fail("at least 1 term", fmt::format("{}", table.terms));

  // the count stays in bounds while it is multiplied
  std::size_t count = table.channels * static_cast<std::size_t>(table.terms);
  for (const NodeAxis& axis : table.axes) {
    if (axis.count < 2 || axis.count > kMaxSide)
      fail(fmt::format("2 to {} nodes along {}", kMaxSide, to_string(axis.coordinate)),
           fmt::format("{}", axis.count));
    count *= static_cast<std::size_t>(axis.count);
    if (count > kMaxValues) fail(fmt::format("at most {} values", kMaxValues), "more");
  }
  if (table.values.size() != count)
    fail(fmt::format("{} values", count), fmt::format("{}", table.values.size()));

  // half floats, so that a file that counts two bytes a value is what is evaluated
  for (const float value : table.values)
    if (!std::isfinite(value) || static_cast<float>(Imath::half(value)) != value)
      fail("half floats", fmt::format("{}", value));
}

float round_to_half(double value) noexcept {
  constexpr double kMaxHalf = 65504;
  return static_cast<float>(Imath::half(static_cast<float>(std::clamp(value, -kMaxHalf, kMaxHalf))));
}

}  // namespace burnish
