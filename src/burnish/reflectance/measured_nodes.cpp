#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
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
// What lies on the horizon is not above it, whatever a last bit says.
constexpr double kAboveHorizon = 1e-9;

using Key = std::array<std::int64_t, 4>;

std::int64_t rounded(double x) noexcept {
  return static_cast<std::int64_t>(std::llround(x / kSameDirection));
}

// The same for all pairs that rotation, reflection (both of isotropic sources) and exchange make of one.
Key key_of(const DirectionPair& pair, bool isotropic) noexcept {
  const auto [wi, wo] = pair;
  if (isotropic) {
    const double i = std::hypot(wi.x, wi.y), o = std::hypot(wo.x, wo.y);
    return {rounded(std::min(i, o)), rounded(std::max(i, o)), rounded(std::hypot(wi.x + wo.x, wi.y + wo.y)),
            0};
  }
  const std::array<std::int64_t, 2> a{rounded(wi.x), rounded(wi.y)}, b{rounded(wo.x), rounded(wo.y)};
  return a < b ? Key{a[0], a[1], b[0], b[1]} : Key{b[0], b[1], a[0], a[1]};
}

std::uint8_t coin(std::uint32_t group) {
  return Pcg32(group).uniform() < 0.5;
}

void number_incidences(MeasuredNodes& nodes) {
  // distinct angles, in the order of their size
  std::map<std::int64_t, std::uint32_t> places;
  const auto place = [](const DirectionPair& pair) {
    return static_cast<std::int64_t>(std::llround(theta_of(pair.wi) / kSameIncidence));
  };
  for (const DirectionPair& pair : nodes.samples.pairs) places.emplace(place(pair), 0);
  for (std::uint32_t number = 0; auto& [angle, index] : places) {
    index = number++;
    nodes.theta_i.push_back(static_cast<double>(angle) * kSameIncidence);
  }
  for (const DirectionPair& pair : nodes.samples.pairs) nodes.incidence.push_back(places[place(pair)]);
}

// Groups numbered from 0 on in the order in which they come.
void number_groups(MeasuredNodes& nodes) {
  std::map<std::uint32_t, std::uint32_t> numbers;
  for (std::uint32_t& group : nodes.groups)
    group = numbers.emplace(group, static_cast<std::uint32_t>(numbers.size())).first->second;
}

// What the values of an RGL table's node are multiplied by to be f_r: 1 / cos theta_o and, where the table
// divided by it, ndf / (4 sigma).
double rgl_node_scale(const RglData& data, const DirectionPair& pair) noexcept {
  if (!data.jacobian) return 1 / pair.wo.z;
  const auto place = [](Vec3 w) { return rgl_square(theta_of(w), std::remainder(phi_of(w), kTwoPi)); };
  return rgl_lookup(data.ndf, place(half_vector(pair.wi, pair.wo))) /
         (4 * rgl_lookup(data.sigma, place(pair.wi)) * pair.wo.z);
}

bool is_valid(const RglData& data, std::size_t node) noexcept {
  return data.valid[node / 8] >> (7 - node % 8) & 1;
}

// Whether to believe the mask of valid nodes. There are files whose mask denies nearly all of a good measurement.
bool mask_holds(const RglData& data, std::size_t nodes) noexcept {
  if (data.valid.size() * 8 < nodes) return false;
  std::size_t valid = 0;
  for (std::size_t node = 0; node < nodes; ++node) valid += is_valid(data, node);
  return 2 * valid >= nodes;
}

// How groups are numbered: as they come, or where the order is a file's, or a last bit's, as their directions are.
enum class Numbering { as_they_come, by_geometry };

// Groups by geometry, halves by coin, incidences; weights of 1 where there are none.
MeasuredNodes finished(MeasuredNodes nodes, Numbering numbering = Numbering::as_they_come) {
  std::map<Key, std::uint32_t> groups;
  std::vector<Key> keys;
  for (const DirectionPair& pair : nodes.samples.pairs) {
    keys.push_back(key_of(pair, nodes.samples.isotropic));
    groups.emplace(keys.back(), static_cast<std::uint32_t>(groups.size()));
  }
  if (numbering == Numbering::by_geometry)
    for (std::uint32_t number = 0; auto& [key, group] : groups) group = number++;
  for (const Key& key : keys) {
    const std::uint32_t group = groups.at(key);
    nodes.groups.push_back(group);
    nodes.half.push_back(coin(group));
  }
  number_incidences(nodes);
  if (nodes.weights.empty()) nodes.weights.assign(nodes.size(), 1);
  return nodes;
}

// Adds a node whose directions lie above the horizon; others are left out.
template <class Values>
bool add(Samples& samples, const DirectionPair& pair, const Values& values) {
  if (!(pair.wi.z > kAboveHorizon && pair.wo.z > kAboveHorizon)) return false;
  samples.pairs.push_back(pair);
  samples.values.insert(samples.values.end(), values.begin(), values.end());
  return true;
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
  const RglData& data = table.data();
  const auto width = static_cast<std::uint32_t>(data.spectra.width),
             height = static_cast<std::uint32_t>(data.spectra.height);
  const auto channels = data.channels;
  const auto thetas = static_cast<std::uint32_t>(data.theta_i.size());
  const std::uint32_t slices =
      thetas * (table.isotropic() ? 1 : static_cast<std::uint32_t>(data.phi_i.size()));
  MeasuredNodes nodes{.samples = {.channels = data.channels, .isotropic = table.isotropic()}};
  std::vector<double> f(channels);
  const bool masked = mask_holds(data, std::size_t{slices} * width * height);

  for (std::uint32_t node = 0; node < slices * width * height; ++node) {
    const std::uint32_t slice = node / (width * height), row = node / width % height, column = node % width;
    if (masked && !is_valid(data, node)) continue;

    // what stands there, as a BRDF
    const DirectionPair pair =
        table.node_directions(static_cast<int>(slice / thetas), static_cast<int>(slice % thetas),
                              static_cast<int>(row), static_cast<int>(column));
    const double scale = rgl_node_scale(data, pair);
    for (std::size_t c = 0; c < channels; ++c)
      f[c] = scale * static_cast<double>(data.spectra.values[node * channels + c]);
    if (!add(nodes.samples, pair, f)) continue;

    // mirror twins are one; rows that meet at the normal were measured one by one
    const std::uint32_t mirrored = table.isotropic() ? std::min(row, height - 1 - row) : row;
    nodes.groups.push_back((slice * height + mirrored) * width + column);
    nodes.half.push_back(static_cast<std::uint8_t>((mirrored + column) % 2));
  }
  nodes.weights.assign(nodes.size(), 1);
  number_groups(nodes);
  number_incidences(nodes);
  return nodes;
}

MeasuredNodes measured_nodes(const HalfDiffTable& table) {
  MeasuredNodes nodes{.samples = {.channels = table.channel_count, .isotropic = true}};
  for (int h = 0; h < table.theta_h_count; ++h)
    for (int d = 0; d < table.theta_d_count; ++d)
      for (int p = 0; p < table.phi_d_count; ++p) {
        const auto f = std::span(table.values).subspan(table.offset(h, d, p), table.channel_count);
        if (std::isnan(f[0])) continue;
        const auto [wi, wo] = from_half_diff(table.centre(h, d, p));
        add(nodes.samples, {wi, wo}, f);
      }
  return finished(std::move(nodes));
}

MeasuredNodes measured_nodes(const AngleTable& table) {
  MeasuredNodes nodes{.samples = {.channels = table.channel_count, .isotropic = table.isotropic()}};
  const auto channels = table.channel_count;
  for (std::size_t entry = 0; entry < entry_count(table); ++entry) {
    const auto f = std::span(table.values).subspan(entry * channels, channels);
    if (!std::isnan(f[0])) add(nodes.samples, node_directions(table, node_of_entry(table, entry)), f);
  }
  return finished(std::move(nodes));
}

MeasuredNodes measured_nodes(const PatchTable& table) {
  MeasuredNodes nodes{.samples = {.channels = 1, .isotropic = false}};
  double total = 0;
  for (std::size_t o = 0; o < table.outgoing.size(); ++o)
    for (std::size_t i = 0; i < table.incident.size(); ++i) {
      const auto f = std::span(table.values).subspan(o * table.incident.size() + i, 1);
      if (!add(nodes.samples, {table.incident.centre(i), table.outgoing.centre(o)}, f)) continue;
      nodes.weights.push_back(table.incident.projected_solid_angle(i) *
                              table.outgoing.projected_solid_angle(o));
      total += nodes.weights.back();
    }
  for (double& weight : nodes.weights) weight *= static_cast<double>(nodes.size()) / total;
  return finished(std::move(nodes));
}

MeasuredNodes measured_nodes(const TensorTree& table) {
  MeasuredNodes nodes{.samples = {.channels = 1, .isotropic = table.isotropic()}};
  double total = 0;
  for (const TreeLeaf& leaf : leaves(table)) {
    if (!add(nodes.samples, leaf_directions(table, leaf), std::span(&leaf.value, 1))) continue;
    nodes.weights.push_back(leaf_weight(table, leaf));
    total += nodes.weights.back();
  }
  for (double& weight : nodes.weights) weight *= static_cast<double>(nodes.size()) / total;
  return finished(std::move(nodes));
}

MeasuredNodes measured_nodes(const Samples& samples) {
  MeasuredNodes nodes{.samples = {.channels = samples.channels, .isotropic = samples.isotropic}};
  for (std::size_t i = 0; i < samples.size(); ++i) add(nodes.samples, samples.pairs[i], samples.at(i));
  return finished(std::move(nodes), Numbering::by_geometry);
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
