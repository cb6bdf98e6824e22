// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/byte_count.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/factors/lookup_scalar.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxChannels = SymmetrizedBrdf::kMaxChannels;

bool depends_on_azimuth(const TableLayout& layout) noexcept {
  return layout.shape == TableShape::disk;
}

// Returns the use that swapping wi and wo turns `use` into; nothing where there is none.
std::optional<FactorUse> swapped_use(const FactorUse& use, const TableLayout& layout) noexcept {
  const auto x = swapped(use.projection, depends_on_azimuth(layout));
  const int projections = projection_count(layout.shape);
  const auto y = projections > 1 ? swapped(use.projection_y, false) : use.projection_y;
  const auto z = projections > 2 ? swapped(use.projection_z, false) : use.projection_z;
  if (!x || !y || !z) return std::nullopt;
  return FactorUse{.table = use.table, .projection = *x, .projection_y = *y, .projection_z = *z};
}

// Largest logarithm of a scale. A fit that is far too rough can leave an unbounded product in a direction without
// data; floats end at e^88.
constexpr double kMaxLogScale = 88;

double lookup(const Table& table, const Lookup& at, std::size_t channel) noexcept {
  // Interpolates linearly along each axis: x within a row, y between rows, z between layers.
  const auto step = table.channels;
  const std::size_t c = step == 1 ? 0 : channel;
  const float* node = table.values.data() + static_cast<std::size_t>(at.node) * step + c;
  const auto along = [&](const float* v) { return definition::mix<double>(v[0], v[step], at.fx); };
  const std::size_t row = static_cast<std::size_t>(table.layout.width) * step;
  const auto across = [&](const float* v) { return definition::mix(along(v), along(v + row), at.fy); };
  switch (axis_count(table.layout.shape)) {
    case 1:
      return along(node);
    case 2:
      return across(node);
    default:
      return definition::mix(across(node), across(node + row * static_cast<std::size_t>(table.layout.height)),
                             at.fz);
  }
}

std::vector<Table> in_format(std::vector<Table> tables, TableFormat format) {
  for (Table& table : tables) table.format = format;
  return tables;
}

void check_positive(const Table& table) {
  for (const float v : table.values)
    if (!(v > 0) || !std::isfinite(v))
      throw Error(fmt::format("table '{}': expected positive finite values, found {}", table.name, v));
}

void check_stored(const Table& table) {
  check_format(table);
  const std::vector<float> stored = round_to_format(table.format, table.channels, table.values);
  const auto [value, rounded] = std::ranges::mismatch(table.values, stored);
  if (value != table.values.end())
    throw Error(fmt::format("table '{}': expected values that {} holds, such as {}, found {}", table.name,
                            to_string(table.format), *rounded, *value));
}

/// Checks names, sizes and values; throws Error.
void check_tables(std::span<const Table> tables, std::size_t channels) {
  std::set<std::string> names;
  for (const Table& table : tables) {
    check_layout(table.layout, table.name);
    if (table.name.empty() || !names.insert(table.name).second)
      throw Error(
          fmt::format("factored BRDF: expected distinct table names, found '{}' twice or empty", table.name));
    if (table.channels != 1 && table.channels != channels)
      throw Error(fmt::format("table '{}': expected 1 or {} channels, found {}", table.name, channels,
                              table.channels));
    if (table.values.size() != table.layout.node_count() * table.channels)
      throw Error(fmt::format("table '{}': expected {} values, found {}", table.name,
                              table.layout.node_count() * table.channels, table.values.size()));
    check_positive(table);
    check_stored(table);
  }
}

void check_scales(const Lobe& lobe, std::size_t channels) {
  if (lobe.scale.size() != channels)
    throw Error(fmt::format("lobe: expected {} scales, found {}", channels, lobe.scale.size()));
  for (const double s : lobe.scale)
    if (!(s >= 0) || !std::isfinite(s))
      throw Error(fmt::format("lobe: expected finite scales >= 0, found {}", s));
}

// Returns for each channel the logarithm that is divided out: that of its largest value, which becomes 1. Channels of
// rgb9e5 share an exponent, so they are brought to one mean, and the largest value of all becomes 1.
std::vector<double> logs_of_one(const Table& table) {
  const auto channels = table.channels;
  std::vector<double> largest(channels, -std::numeric_limits<double>::infinity()), mean(channels, 0);
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    largest[i % channels] = std::max<double>(largest[i % channels], table.values[i]);
    mean[i % channels] += table.values[i] / static_cast<double>(table.layout.node_count());
  }
  if (table.format != TableFormat::rgb9e5) return largest;
  double above = 0;
  for (std::size_t c = 0; c < channels; ++c) above = std::max(above, largest[c] - mean[c]);
  for (double& m : mean) m += above;
  return mean;
}

constexpr std::size_t kMaxPlaces = 32;  // kept while a pair of directions is evaluated

}  // namespace

std::size_t coefficient_count(const Projection& p) noexcept {
  if (p.kind != Projection::Kind::affine || p == kProjectWi || p == kProjectWo || p == kProjectHalf) return 0;
  return static_cast<std::size_t>((p.wi != 0) + (p.wo != 0) + (p.mirror != 0) + (p.n != 0));
}

FactoredBrdf::FactoredBrdf(std::size_t channels, std::vector<Table> tables, std::vector<Lobe> lobes,
                           TableFormat format)
    : FactoredBrdf(channels, in_format(std::move(tables), format), std::move(lobes)) {}

FactoredBrdf::FactoredBrdf(std::size_t channels, std::vector<Table> tables, std::vector<Lobe> lobes)
    : channels_(channels), tables_(std::move(tables)), lobes_(std::move(lobes)) {
  if (channels < 1 || channels > kMaxChannels)
    throw Error(fmt::format("factored BRDF: expected 1 to {} channels, found {}", kMaxChannels, channels));
  if (lobes_.empty()) throw Error("factored BRDF: expected at least one lobe, found none");

  check_tables(tables_, channels);
  for (const Lobe& lobe : lobes_) {
    check_scales(lobe, channels);

    // Swapping wi and wo exchanges some factors of one table. They are put side by side as pairs; a factor that
    // swapping leaves alone is reciprocal by itself, and any other makes the model not reciprocal.
    std::vector<FactorUse> rest = lobe.factors, pairs, singles;
    while (!rest.empty()) {
      const FactorUse use = rest.front();
      rest.erase(rest.begin());
      if (use.table >= tables_.size())
        throw Error(
            fmt::format("lobe: expected a table index below {}, found {}", tables_.size(), use.table));
      const TableLayout& layout = layout_of(use);
      isotropic_ = isotropic_ && !depends_on_azimuth(layout);
      if (depends_on_azimuth(layout) && is_angle_alone(use.projection))
        throw Error("lobe: expected a disk over a projection with an azimuth, found " +
                    to_string(use.projection));
      const std::optional<FactorUse> other = swapped_use(use, layout);
      const auto partner = other && *other != use ? std::find(rest.begin(), rest.end(), *other) : rest.end();
      if (partner != rest.end()) {
        pairs.insert(pairs.end(), {use, *other});
        rest.erase(partner);
      } else {
        reciprocal_ = reciprocal_ && other == use;
        singles.push_back(use);
      }
    }

    // Pairs come first. Lookups that always fall on one place are located once.
    pair_counts_.push_back(pairs.size() / 2);
    pairs.insert(pairs.end(), singles.begin(), singles.end());
    std::vector<std::size_t>& place_of = place_of_.emplace_back();
    for (const FactorUse& use : pairs) {
      const auto known = std::ranges::find_if(places_, [&](const FactorUse& place) {
        return located_alike(layout_of(use), use, layout_of(place), place);
      });
      place_of.push_back(static_cast<std::size_t>(known - places_.begin()));
      if (known == places_.end()) places_.push_back(use);
    }
    ordered_.push_back(std::move(pairs));
  }
}

bool FactoredBrdf::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  std::fill(f.begin(), f.end(), 0.0);
  if (wi.z <= 0 || wo.z <= 0) return true;

  // Every distinct place is located once for the pair of directions.
  std::array<Lookup, kMaxPlaces> places;     // touched up to their count,
  std::array<double, kMaxChannels> product;  // up to channels_ only
  for (std::size_t p = 0; p < std::min(kMaxPlaces, places_.size()); ++p)
    places[p] = locate(layout_of(places_[p]), places_[p], wi, wo);

  // f is the sum over lobes of scale times pairs times the other factors [HomomorphicBrdf, eq. 4]. The two values of
  // a pair are multiplied first, so that swapping wi and wo changes no bit.
  const auto channels = channels_;
  for (std::size_t j = 0; j < lobes_.size(); ++j) {
    for (std::size_t c = 0; c < channels; ++c) product[c] = lobes_[j].scale[c];
    const std::vector<FactorUse>& uses = ordered_[j];
    const auto place = [&](std::size_t k) {
      const std::size_t p = place_of_[j][k];
      return p < kMaxPlaces ? places[p] : locate(layout_of(uses[k]), uses[k], wi, wo);
    };
    std::size_t k = 0;
    for (; k < 2 * pair_counts_[j]; k += 2) {
      const Table& table = table_of(uses[k]);
      const Lookup a = place(k), b = place(k + 1);
      for (std::size_t c = 0; c < channels; ++c) product[c] *= lookup(table, a, c) * lookup(table, b, c);
    }
    for (; k < uses.size(); ++k) {
      const Table& table = table_of(uses[k]);
      const Lookup at = place(k);
      for (std::size_t c = 0; c < channels; ++c) product[c] *= lookup(table, at, c);
    }
    for (std::size_t c = 0; c < channels; ++c) f[c] += product[c];
  }
  return true;
}

double FactoredBrdf::smallest_factor() const noexcept {
  double smallest = 1;
  for (const Table& table : tables_)
    for (const float v : table.values) smallest = std::min(smallest, static_cast<double>(v));
  return smallest;
}

std::size_t FactoredBrdf::table_bytes() const noexcept {
  std::size_t count = 0;
  for (const Table& table : tables_) count += table.byte_count();
  return count;
}

std::size_t FactoredBrdf::bytes() const noexcept {
  ByteCount count;
  for (const Table& table : tables_) count.add_table(table.layout, texel_bytes(table.format, table.channels));
  for (const Lobe& lobe : lobes_) {
    count.add_lobe(lobe.scale.size());
    for (const FactorUse& use : lobe.factors) count.add_use(use, layout_of(use).shape);
  }
  return count.bytes();
}

std::vector<double> store_log_table(Table& table) {
  check_format(table);
  const bool floored = table.format == TableFormat::half || table.format == TableFormat::single;
  // The other formats round a smaller value to their own floor.
  const double floor = floored ? kTableFloor : std::numeric_limits<float>::min();
  std::vector<double> divided = logs_of_one(table);
  // Each channel's largest value becomes 1; smaller values than the floor are raised to it, then all are rounded.
  for (std::size_t i = 0; i < table.values.size(); ++i)
    table.values[i] =
        static_cast<float>(std::max(std::exp(table.values[i] - divided[i % divided.size()]), floor));
  check_positive(table);
  table.values = round_to_format(table.format, table.channels, table.values);
  return divided;
}

FactoredBrdf from_log_tables(std::size_t channels, std::vector<Table> tables, std::vector<Lobe> lobes,
                             TableFormat format) {
  return from_log_tables(channels, in_format(std::move(tables), format), std::move(lobes));
}

FactoredBrdf from_log_tables(std::size_t channels, std::vector<Table> tables, std::vector<Lobe> lobes) {
  std::vector<std::vector<double>> divided;
  for (Table& table : tables) divided.push_back(store_log_table(table));
  return from_stored_tables(channels, std::move(tables), divided, std::move(lobes));
}

FactoredBrdf from_stored_tables(std::size_t channels, std::vector<Table> tables,
                                std::span<const std::vector<double>> divided, std::vector<Lobe> lobes) {
  for (Lobe& lobe : lobes) {
    for (const FactorUse& use : lobe.factors) {
      // A lobe's scale takes back what storing divided out of each of its tables.
      const std::vector<double>& logs = divided[use.table];
      for (std::size_t c = 0; c < lobe.scale.size(); ++c) lobe.scale[c] += logs[logs.size() == 1 ? 0 : c];
    }
    for (double& s : lobe.scale) s = static_cast<float>(std::exp(std::min(s, kMaxLogScale)));
  }
  return FactoredBrdf(channels, std::move(tables), std::move(lobes));
}

std::string model_expression(const FactoredBrdf& brdf) {
  std::string text;
  for (const Lobe& lobe : brdf.lobes()) {
    if (!text.empty()) text += " + ";
    for (std::size_t k = 0; k < lobe.factors.size(); ++k) {
      const FactorUse& use = lobe.factors[k];
      const Table& table = brdf.table_of(use);
      // A line over the difference vector depends on its polar angle alone, which the text says.
      const bool angle = table.layout.shape == TableShape::line && use.projection == kProjectDifference;
      text += fmt::format("{}{}({}", k ? " " : "", table.name, angle ? "theta_d" : to_string(use.projection));
      const int axes = projection_count(table.layout.shape);
      if (axes > 1) text += "," + to_string(use.projection_y);
      if (axes > 2) text += "," + to_string(use.projection_z);
      text += ")";
    }
  }
  return text;
}

}  // namespace burnish
