// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/measured_nodes.h>
#include <burnish/reflectance/scattered_brdf.h>

namespace burnish {

namespace {

// Directions that differ by less are the same: far above rounding, far below an instrument's step.
constexpr double kSameDirection = 1e-6;
constexpr double kSameIncidence = 1e-4;  // radians
// Directions on the horizon are not above it, whatever their last bit says.
constexpr double kAboveHorizon = 1e-9;

using Key = std::array<std::int64_t, 4>;

std::int64_t rounded(double x) noexcept {
  return static_cast<std::int64_t>(std::llround(x / kSameDirection));
}

// Returns the numbers of an isotropic source's pair that rotation, reflection and exchange leave alone: both sines,
// the smaller first, and the length of their vectors' sum.
std::array<double, 3> isotropic_numbers(const DirectionPair& pair) noexcept {
  const auto [wi, wo] = pair;
  const double i = std::hypot(wi.x, wi.y), o = std::hypot(wo.x, wo.y);
  return {std::min(i, o), std::max(i, o), std::hypot(wi.x + wo.x, wi.y + wo.y)};
}

// Returns a key that is the same for all pairs that rotation, reflection (both for isotropic sources) and exchange
// make of one.
Key key_of(const DirectionPair& pair, bool isotropic) noexcept {
  const auto [wi, wo] = pair;
  if (isotropic) {
    const auto [less, more, sum] = isotropic_numbers(pair);
    return {rounded(less), rounded(more), rounded(sum), 0};
  }
  const std::array<std::int64_t, 2> a{rounded(wi.x), rounded(wi.y)}, b{rounded(wo.x), rounded(wo.y)};
  return a < b ? Key{a[0], a[1], b[0], b[1]} : Key{b[0], b[1], a[0], a[1]};
}

std::uint8_t coin(std::uint32_t group) {
  return Pcg32(group).uniform() < 0.5;
}

// Distinct angles, in the order of their size.
using Incidences = std::map<std::int64_t, std::uint32_t>;

std::int64_t incidence_of(const DirectionPair& pair) noexcept {
  return static_cast<std::int64_t>(std::llround(theta_of(pair.wi) / kSameIncidence));
}

void number_incidences(MeasuredNodes& nodes) {
  Incidences places;
  for (const DirectionPair& pair : nodes.samples.pairs) places.emplace(incidence_of(pair), 0);
  for (std::uint32_t number = 0; auto& [angle, index] : places) {
    index = number++;
    nodes.theta_i.push_back(static_cast<double>(angle) * kSameIncidence);
  }
  nodes.incidence.reserve(nodes.size());
  for (const DirectionPair& pair : nodes.samples.pairs) nodes.incidence.push_back(places[incidence_of(pair)]);
}

// Numbers the groups from 0 on, in the order in which they come.
void number_groups(MeasuredNodes& nodes) {
  std::map<std::uint32_t, std::uint32_t> numbers;
  for (std::uint32_t& group : nodes.groups)
    group = numbers.emplace(group, static_cast<std::uint32_t>(numbers.size())).first->second;
}

// Returns the factor from the values of an RGL table's node to f_r: 1 / cos theta_o and, where the table divided by
// it, ndf / (4 sigma) [Dupuy 2018, sec. 4].
double rgl_node_scale(const RglData& data, const DirectionPair& pair) noexcept {
  if (!data.jacobian) return 1 / pair.wo.z;
  const auto place = [](Vec3 w) { return rgl_square(theta_of(w), std::remainder(phi_of(w), kTwoPi)); };
  return rgl_lookup(data.ndf, place(half_vector(pair.wi, pair.wo))) /
         (4 * rgl_lookup(data.sigma, place(pair.wi)) * pair.wo.z);
}

bool is_valid(const RglData& data, std::size_t node) noexcept {
  return data.valid[node / 8] >> (7 - node % 8) & 1;
}

// Returns true if the mask of valid nodes is to be believed. Some files have a mask that denies nearly all of a good
// measurement.
bool mask_holds(const RglData& data, std::size_t nodes) noexcept {
  if (data.valid.size() * 8 < nodes) return false;
  std::size_t valid = 0;
  for (std::size_t node = 0; node < nodes; ++node) valid += is_valid(data, node);
  return 2 * valid >= nodes;
}

// The order of the groups' numbers: as they come or, where the order is a file's or depends on a last bit, by their
// directions.
enum class Numbering { as_they_come, by_geometry };

// Sets groups by geometry, halves by a coin for each group, and incidences.
MeasuredNodes finished(MeasuredNodes nodes, Numbering numbering = Numbering::as_they_come) {
  // Sorted by key, pairs that lead to one another lie side by side, the one that came first at the front.
  std::vector<std::pair<Key, std::uint32_t>> keyed;
  keyed.reserve(nodes.size());
  for (std::uint32_t i = 0; i < nodes.size(); ++i)
    keyed.emplace_back(key_of(nodes.samples.pairs[i], nodes.samples.isotropic), i);
  std::ranges::sort(keyed);

  const bool by_geometry = numbering == Numbering::by_geometry;
  std::uint32_t next = 0;
  for (std::size_t i = 0, first = 0; i < keyed.size(); ++i) {
    const bool begins = i == 0 || keyed[i].first != keyed[i - 1].first;
    if (begins) first = i;
    if (begins && by_geometry) ++next;
    nodes.groups[keyed[i].second] = by_geometry ? next - 1 : keyed[first].second;
  }
  keyed = {};
  // The place of a group's first node becomes its number.
  for (std::uint32_t i = 0; i < nodes.size() && !by_geometry; ++i)
    nodes.groups[i] = nodes.groups[i] == i ? next++ : nodes.groups[nodes.groups[i]];

  std::ranges::transform(nodes.groups, nodes.half.begin(), coin);
  number_incidences(nodes);
  return nodes;
}

bool lies_above(const DirectionPair& pair) noexcept {
  return pair.wi.z > kAboveHorizon && pair.wo.z > kAboveHorizon;
}

// A node above the horizon; of the table of RGL also its group and half.
struct Node {
  DirectionPair pair;
  std::span<const double> f;  // holds until the next one
  double weight = 1;
  std::uint32_t group = 0;
  std::uint8_t half = 0;
};
using Visit = std::function<void(const Node&)>;

// Each of these functions visits the nodes in the order of measured_nodes.
void each_node(const RglTable& table, const Visit& visit) {
  const RglData& data = table.data();
  const auto width = static_cast<std::uint32_t>(data.spectra.width),
             height = static_cast<std::uint32_t>(data.spectra.height);
  const auto channels = data.channels;
  const auto thetas = static_cast<std::uint32_t>(data.theta_i.size());
  const std::uint32_t slices =
      thetas * (table.isotropic() ? 1 : static_cast<std::uint32_t>(data.phi_i.size()));
  std::vector<double> f(channels);
  const bool masked = mask_holds(data, std::size_t{slices} * width * height);

  for (std::uint32_t node = 0; node < slices * width * height; ++node) {
    // Nodes are numbered by slice, then row, then column of the square of samples.
    const std::uint32_t slice = node / (width * height), row = node / width % height, column = node % width;
    if (masked && !is_valid(data, node)) continue;
    const DirectionPair pair =
        table.node_directions(static_cast<int>(slice / thetas), static_cast<int>(slice % thetas),
                              static_cast<int>(row), static_cast<int>(column));
    if (!lies_above(pair)) continue;

    // The stored values become f_r.
    const double scale = rgl_node_scale(data, pair);
    for (std::size_t c = 0; c < channels; ++c)
      f[c] = scale * static_cast<double>(data.spectra.values[node * channels + c]);

    // Mirror twins are one measurement; rows that meet at the normal were measured one by one.
    const std::uint32_t mirrored = table.isotropic() ? std::min(row, height - 1 - row) : row;
    visit({.pair = pair,
           .f = f,
           .group = (slice * height + mirrored) * width + column,
           .half = static_cast<std::uint8_t>((mirrored + column) % 2)});
  }
}

void each_node(const HalfDiffTable& table, const Visit& visit) {
  std::vector<double> f(table.channel_count);
  for (int h = 0; h < table.theta_h_count; ++h)
    for (int d = 0; d < table.theta_d_count; ++d)
      for (int p = 0; p < table.phi_d_count; ++p) {
        std::ranges::copy(std::span(table.values).subspan(table.offset(h, d, p), f.size()), f.begin());
        if (std::isnan(f[0])) continue;
        const auto [wi, wo] = from_half_diff(table.centre(h, d, p));
        if (const DirectionPair pair{wi, wo}; lies_above(pair)) visit({.pair = pair, .f = f});
      }
}

void each_node(const AngleTable& table, const Visit& visit) {
  std::vector<double> f(table.channel_count);
  for (std::size_t entry = 0; entry < entry_count(table); ++entry) {
    std::ranges::copy(std::span(table.values).subspan(entry * f.size(), f.size()), f.begin());
    if (std::isnan(f[0])) continue;
    if (const DirectionPair pair = node_directions(table, node_of_entry(table, entry)); lies_above(pair))
      visit({.pair = pair, .f = f});
  }
}

void each_node(const PatchTable& table, const Visit& visit) {
  for (std::size_t o = 0; o < table.outgoing.size(); ++o)
    for (std::size_t i = 0; i < table.incident.size(); ++i) {
      const DirectionPair pair{table.incident.centre(i), table.outgoing.centre(o)};
      const float* stored = &table.values[(o * table.incident.size() + i) * table.channel_count];
      const std::vector<double> f(stored, stored + table.channel_count);
      // A patch weighs as much of both hemispheres as it covers.
      const double weight = table.incident.projected_solid_angle(i) * table.outgoing.projected_solid_angle(o);
      if (lies_above(pair)) visit({.pair = pair, .f = f, .weight = weight});
    }
}

void each_node(const TensorTree& table, const Visit& visit) {
  for (const TreeLeaf& leaf : leaves(table)) {
    const double f = static_cast<double>(leaf.value);
    if (const DirectionPair pair = leaf_directions(table, leaf); lies_above(pair))
      visit({.pair = pair, .f = {&f, 1}, .weight = leaf_weight(table, leaf)});
  }
}

void each_node(const Samples& samples, const Visit& visit) {
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (lies_above(samples.pairs[i])) visit({.pair = samples.pairs[i], .f = samples.at(i)});
}

NodeCount counted(const auto& source) {
  NodeCount count;
  Incidences incidences;
  each_node(source, [&](const Node& node) {
    ++count.nodes;
    incidences.emplace(incidence_of(node.pair), 0);
  });
  count.incidences = incidences.size();
  return count;
}

// Collects the nodes without their incidences, in no more memory than they take.
MeasuredNodes collected(const auto& source, std::size_t channels, bool isotropic) {
  const std::size_t count = count_nodes(source).nodes;
  MeasuredNodes nodes{.samples = {.channels = channels, .isotropic = isotropic}};
  nodes.samples.pairs.reserve(count);
  nodes.samples.values.reserve(count * channels);
  nodes.weights.reserve(count);
  nodes.groups.reserve(count);
  nodes.half.reserve(count);
  each_node(source, [&](const Node& node) {
    nodes.samples.pairs.push_back(node.pair);
    nodes.samples.values.insert(nodes.samples.values.end(), node.f.begin(), node.f.end());
    nodes.weights.push_back(node.weight);
    nodes.groups.push_back(node.group);
    nodes.half.push_back(node.half);
  });
  return nodes;
}

// Scales the weights to a mean of 1.
MeasuredNodes with_mean_weight(MeasuredNodes nodes) {
  double total = 0;
  for (const double weight : nodes.weights) total += weight;
  for (double& weight : nodes.weights) weight *= static_cast<double>(nodes.size()) / total;
  return nodes;
}

MeasuredNodes chosen(const MeasuredNodes& nodes, const NodePart& part, bool inside) {
  std::vector<std::size_t> subset;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (part.holds(nodes, i) == inside) subset.push_back(i);
  if (subset.empty())
    throw Error(fmt::format("nodes: expected some {} the part, found none of {} at {} incident angles",
                            inside ? "in" : "outside", nodes.size(), nodes.theta_i.size()));
  return select(nodes, subset);
}

}  // namespace

std::uint32_t MeasuredNodes::group_count() const noexcept {
  return groups.empty() ? 0 : std::ranges::max(groups) + 1;
}

MeasuredNodes measured_nodes(const RglTable& table) {
  MeasuredNodes nodes = collected(table, table.channels(), table.isotropic());
  number_groups(nodes);
  number_incidences(nodes);
  return nodes;
}

MeasuredNodes measured_nodes(const HalfDiffTable& table) {
  return finished(collected(table, table.channel_count, true));
}

MeasuredNodes measured_nodes(const AngleTable& table) {
  return finished(collected(table, table.channel_count, table.isotropic()));
}

MeasuredNodes measured_nodes(const PatchTable& table) {
  return finished(with_mean_weight(collected(table, table.channel_count, false)));
}

MeasuredNodes measured_nodes(const TensorTree& table) {
  return finished(with_mean_weight(collected(table, 1, table.isotropic())));
}

MeasuredNodes measured_nodes(const Samples& samples) {
  return finished(collected(samples, samples.channels, samples.isotropic), Numbering::by_geometry);
}

bool are_one_measurement(const DirectionPair& a, const DirectionPair& b, bool isotropic) noexcept {
  const auto same = [](double x, double y) { return std::abs(x - y) < kSameDirection; };
  if (isotropic) return std::ranges::equal(isotropic_numbers(a), isotropic_numbers(b), same);
  const auto same_direction = [&](Vec3 v, Vec3 w) { return same(v.x, w.x) && same(v.y, w.y); };
  return (same_direction(a.wi, b.wi) && same_direction(a.wo, b.wo)) ||
         (same_direction(a.wi, b.wo) && same_direction(a.wo, b.wi));
}

NodeCount count_nodes(const RglTable& table) {
  return counted(table);
}

NodeCount count_nodes(const HalfDiffTable& table) {
  return counted(table);
}

NodeCount count_nodes(const AngleTable& table) {
  return counted(table);
}

NodeCount count_nodes(const PatchTable& table) {
  return counted(table);
}

NodeCount count_nodes(const TensorTree& table) {
  return counted(table);
}

NodeCount count_nodes(const Samples& samples) {
  return counted(samples);
}

MeasuredNodes select(const MeasuredNodes& nodes, std::span<const std::size_t> subset) {
  MeasuredNodes part{.samples = select(nodes.samples, subset), .theta_i = nodes.theta_i};
  for (const std::size_t i : subset) {
    part.weights.push_back(nodes.weights[i]);
    part.groups.push_back(nodes.groups[i]);
    part.half.push_back(nodes.half[i]);
    part.incidence.push_back(nodes.incidence[i]);
  }
  return part;
}

NodePart parse_node_part(std::string_view text) {
  const auto number_after = [&](std::string_view name) -> std::optional<std::uint32_t> {
    std::uint32_t number = 0;
    if (!text.starts_with(name)) return {};
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + name.size(), end, number);
    if (error != std::errc() || rest != end) return {};
    return number;
  };
  if (const auto half = number_after("half="); half && *half < 2) return {NodePart::Kind::half, *half};
  if (const auto incidence = number_after("theta_i=")) return {NodePart::Kind::incidence, *incidence};
  throw Error(fmt::format("part of the nodes: expected half=0, half=1 or theta_i=K, found '{}'", text));
}

MeasuredNodes nodes_of(const MeasuredNodes& nodes, const NodePart& part) {
  return chosen(nodes, part, true);
}

MeasuredNodes nodes_without(const MeasuredNodes& nodes, const NodePart& part) {
  return chosen(nodes, part, false);
}

}  // namespace burnish
