// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <burnish/error.h>
#include <burnish/fitting/energy.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/metrics/albedo.h>

namespace burnish {

namespace {

// At the horizon itself f is 0 by definition and the albedo has no meaning.
constexpr double kMaxTheta = radians(89.5);
// Gains stay above this: a table that should vanish is left to the scaling of whole lobes.
constexpr double kMinGain = 1e-3;
// Kept below 1, so that rounding of the scales cannot lead above it.
constexpr double kLimit = 1 - 1e-6;

/// Polar angles and azimuths of wi, with a value a channel at each.
struct Grid {
  std::size_t thetas, phis, channels;

  std::size_t size() const { return thetas * phis; }
  // Steps shrink towards grazing, where albedos change fastest.
  double theta(std::size_t i) const {
    const double left = 1 - static_cast<double>(i) / static_cast<double>(thetas - 1);
    return kMaxTheta * (1 - std::pow(left, 1.5));
  }
  double phi(std::size_t j) const { return kTwoPi * static_cast<double>(j) / static_cast<double>(phis); }
  Vec3 direction(std::size_t k) const { return spherical_direction(theta(k / phis), phi(k % phis)); }
  // Interpolates linearly in the index that theta() maps from and in the azimuth. Beyond the last polar angle, its
  // values hold.
  double interpolate(const std::vector<double>& values, Vec3 w, std::size_t channel) const {
    const double share = std::clamp(1 - theta_of(w) / kMaxTheta, 0.0, 1.0);
    const double y = (1 - std::pow(share, 1 / 1.5)) * static_cast<double>(thetas - 1);
    const double x = phi_of(w) / kTwoPi * static_cast<double>(phis);
    const auto row = std::min(static_cast<std::size_t>(y), thetas - 2);
    const auto column = static_cast<std::size_t>(x) % phis;
    const auto at = [&](std::size_t i, std::size_t j) {
      return values[(i * phis + j % phis) * channels + channel];
    };
    const double fx = x - std::floor(x), fy = y - static_cast<double>(row);
    const auto along = [&](std::size_t i) { return std::lerp(at(i, column), at(i, column + 1), fx); };
    return std::lerp(along(row), along(row + 1), fy);
  }
};

// Updates the albedos of the chosen directions, a row of channels for each direction of the grid.
void update_albedos(const FactoredBrdf& brdf, const Grid& grid, double tolerance,
                    const std::vector<bool>& chosen, std::vector<double>& albedo) {
  const auto row = [&](std::size_t k) { return std::span(albedo).subspan(k * grid.channels, grid.channels); };
  for_each_chunk(grid.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
    const bool another_normal = k > 0 && k < grid.phis;  // the normal has one albedo for all azimuths
    if (!another_normal && chosen[k])
      std::ranges::copy(directional_albedo(brdf, grid.direction(k), tolerance).albedo, row(k).begin());
  });
  for (std::size_t k = 1; k < grid.phis; ++k) std::ranges::copy(row(0), row(k).begin());
}

std::vector<bool> directions_above_one(const std::vector<double>& albedo, std::size_t channels) {
  std::vector<bool> above(albedo.size() / channels, false);
  for (std::size_t i = 0; i < albedo.size(); ++i)
    if (albedo[i] > 1) above[i / channels] = true;
  return above;
}

std::vector<double> largest_of(const std::vector<double>& albedo, std::size_t channels) {
  std::vector<double> largest(channels, 0);
  for (std::size_t i = 0; i < albedo.size(); ++i)
    largest[i % channels] = std::max(largest[i % channels], albedo[i]);
  return largest;
}

// Returns the first table that a lobe looks up by both directions alike, and by nothing else.
std::optional<std::size_t> damping_table(const FactoredBrdf& brdf, const Lobe& lobe) {
  for (const FactorUse& use : lobe.factors) {
    if (projection_count(brdf.table_of(use).layout.shape) > 1) continue;
    FactorUse other = use;
    other.projection = kProjectWo;
    if (use.projection == kProjectWi && std::ranges::find(lobe.factors, other) != lobe.factors.end())
      return use.table;
  }
  return std::nullopt;
}

/// The gains on the nodes of the damped tables.
class Damper {
 public:
  Damper(const FactoredBrdf& brdf, Grid grid) : brdf_(brdf), grid_(grid), gains_(brdf.tables().size()) {
    for (const Lobe& lobe : brdf.lobes())
      if (const auto table = damping_table(brdf, lobe)) {
        gains_[*table].assign(brdf.tables()[*table].values.size(), 1.0);
      }
    for (const Lobe& lobe : brdf.lobes()) most_uses_ = std::max(most_uses_, damped_uses(lobe));
  }

  bool damps(const Lobe& lobe) const { return damped_uses(lobe) > 0; }

  // Returns the model of the lobes that no gain reaches; all other lobes are made black.
  FactoredBrdf rest() const {
    std::vector<Lobe> lobes(brdf_.lobes().begin(), brdf_.lobes().end());
    for (Lobe& lobe : lobes)
      if (damps(lobe)) std::ranges::fill(lobe.scale, 0.0);
    return FactoredBrdf(brdf_.channels(), {brdf_.tables().begin(), brdf_.tables().end()}, std::move(lobes));
  }

  // Takes a Sinkhorn step [SinkhornKnopp1967]: towards albedo 1 where it is above, and back towards gain 1 where it
  // is below. Returns the largest relative change of a gain.
  double step(const std::vector<double>& albedo, const std::vector<double>& rest) {
    std::vector<double> change(albedo.size(), 1.0);
    for (std::size_t i = 0; i < albedo.size(); ++i) {
      const double damped = albedo[i] - rest[i], room = std::max(kLimit - rest[i], 0.0);
      // Both directions of a pair are damped, so each takes a root of the change.
      if (damped > 0) change[i] = std::pow(room / damped, 1 / static_cast<double>(most_uses_));
    }
    double largest = 0;
    for (std::size_t t = 0; t < gains_.size(); ++t) {
      if (gains_[t].empty()) continue;
      const std::vector<double> changes = node_changes(brdf_.tables()[t], change);
      for (std::size_t i = 0; i < gains_[t].size(); ++i) {
        const double before =
            std::exchange(gains_[t][i], std::clamp(gains_[t][i] * changes[i], kMinGain, 1.0));
        largest = std::max(largest, std::abs(gains_[t][i] / before - 1));
      }
    }
    return largest;
  }

  // Returns the damped tables times the gains, unrounded.
  FactoredBrdf apply(std::span<const Lobe> lobes) const {
    std::vector<Table> tables(brdf_.tables().begin(), brdf_.tables().end());
    for (std::size_t t = 0; t < tables.size(); ++t) {
      if (gains_[t].empty()) continue;
      tables[t].format = TableFormat::single;
      for (std::size_t i = 0; i < gains_[t].size(); ++i)
        tables[t].values[i] *= static_cast<float>(gains_[t][i]);
    }
    return FactoredBrdf(brdf_.channels(), std::move(tables), {lobes.begin(), lobes.end()});
  }

  // Returns the damped model in the tables' formats; the scales take the factors that storing divides out.
  FactoredBrdf store(std::span<const Lobe> lobes) const {
    std::vector<Table> tables(brdf_.tables().begin(), brdf_.tables().end());
    std::vector<Lobe> scaled(lobes.begin(), lobes.end());
    for (std::size_t t = 0; t < tables.size(); ++t) {
      if (gains_[t].empty()) continue;
      for (std::size_t i = 0; i < gains_[t].size(); ++i)
        tables[t].values[i] = static_cast<float>(std::log(tables[t].values[i] * gains_[t][i]));
      const std::vector<double> divided = store_log_table(tables[t]);
      for (Lobe& lobe : scaled)
        for (const FactorUse& use : lobe.factors)
          if (use.table == t)
            for (std::size_t c = 0; c < lobe.scale.size(); ++c)
              lobe.scale[c] =
                  static_cast<float>(lobe.scale[c] * std::exp(divided[divided.size() == 1 ? 0 : c]));
    }
    return FactoredBrdf(brdf_.channels(), std::move(tables), std::move(scaled));
  }

 private:
  std::ptrdiff_t damped_uses(const Lobe& lobe) const {
    return std::ranges::count_if(lobe.factors,
                                 [&](const FactorUse& use) { return !gains_[use.table].empty(); });
  }

  // Returns the changes of a table's nodes for the changes of the grid. Each node takes the least change of the
  // directions that it contributes to; a damping change is raised to the power of its share. So no direction stays
  // above 1 because its nodes follow other directions.
  std::vector<double> node_changes(const Table& table, const std::vector<double>& change) const {
    const auto step = table.channels;
    std::vector<double> result(table.values.size(), std::numeric_limits<double>::infinity());
    const auto limit = [&](std::size_t node, std::size_t channel, double value) {
      double& least = result[node * step + (step == 1 ? 0 : channel)];
      least = std::min(least, value);
    };
    for (int y = 0; y < table.layout.height; ++y)
      for (int x = 0; x < table.layout.width; ++x) {
        const Vec3 w = node_direction(table.layout, x, y);
        for (std::size_t j = 0; j < (table.layout.shape == TableShape::line ? grid_.phis : 1); ++j)
          for (std::size_t c = 0; c < grid_.channels; ++c)
            limit(static_cast<std::size_t>(y * table.layout.width + x), c,
                  grid_.interpolate(change, j == 0 ? w : spherical_direction(theta_of(w), grid_.phi(j)), c));
      }
    const FactorUse use{.table = 0, .projection = kProjectWi, .projection_y = {}};
    for (std::size_t k = 0; k < grid_.size(); ++k) {
      const Lookup at = locate(table.layout, use, grid_.direction(k), {0, 0, 1});
      for (const int corner : {0, 1, 2, 3}) {
        const double share = (corner & 1 ? at.fx : 1 - at.fx) * (corner & 2 ? at.fy : 1 - at.fy);
        if (share <= 0) continue;
        const int node = at.node + (corner & 1) + (corner & 2 ? table.layout.width : 0);
        for (std::size_t c = 0; c < grid_.channels; ++c) {
          const double value = change[k * grid_.channels + c];
          limit(static_cast<std::size_t>(node), c, value < 1 ? std::pow(value, share) : value);
        }
      }
    }
    return result;
  }

  const FactoredBrdf& brdf_;
  Grid grid_;
  std::vector<std::vector<double>> gains_;  // laid out like the tables' values; none for a table that stays
  std::ptrdiff_t most_uses_ = 1;
};

// Divides the scales of the chosen lobes by the largest albedo where that exceeds 1.
template <class Chosen>
void limit_scales(std::vector<Lobe>& lobes, const std::vector<double>& largest, const Chosen& chosen) {
  for (Lobe& lobe : lobes)
    for (std::size_t c = 0; c < lobe.scale.size(); ++c)
      if (chosen(lobe) && largest[c] > 1)
        lobe.scale[c] = static_cast<float>(lobe.scale[c] * kLimit / largest[c]);
}

bool within_one(const std::vector<double>& largest) {
  return std::ranges::all_of(largest, [](double a) { return a <= 1; });
}

}  // namespace

EnergyConservation conserve_energy(const FactoredBrdf& brdf, const EnergyOptions& options) {
  if (options.theta_count < 2 || options.phi_count < 1 || !(options.tolerance > 0) ||
      options.max_iterations < 0)
    throw Error("energy: expected at least 2 polar angles and 1 azimuth, a tolerance > 0, iterations >= 0");
  const auto channels = brdf.channels();
  const Grid grid{static_cast<std::size_t>(options.theta_count),
                  brdf.isotropic() ? 1 : static_cast<std::size_t>(options.phi_count), channels};
  const auto albedos_of = [&](const FactoredBrdf& of) {
    std::vector<double> albedo(grid.size() * channels);
    update_albedos(of, grid, options.tolerance, std::vector<bool>(grid.size(), true), albedo);
    return albedo;
  };
  std::vector<double> albedo = albedos_of(brdf);
  EnergyConservation result{.brdf = brdf, .largest_before = largest_of(albedo, channels)};
  result.largest_after = result.largest_before;
  if (within_one(result.largest_before)) return result;

  // Lobes that no gain reaches are scaled until they alone are within 1.
  Damper damper(brdf, grid);
  std::vector<Lobe> lobes(brdf.lobes().begin(), brdf.lobes().end());
  std::vector<double> rest = albedos_of(damper.rest());
  const std::vector<double> largest_rest = largest_of(rest, channels);
  limit_scales(lobes, largest_rest, [&](const Lobe& lobe) { return !damper.damps(lobe); });
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] /= std::max(largest_rest[i % channels], 1.0);

  // The gains of the other lobes are iterated. Gains are at most 1, so an albedo that is at most 1 without them stays
  // so.
  const std::vector<bool> above = directions_above_one(albedo, channels);
  for (; result.iterations < options.max_iterations; ++result.iterations) {
    update_albedos(damper.apply(lobes), grid, options.tolerance, above, albedo);
    if (damper.step(albedo, rest) < options.tolerance) break;
  }

  // Rounding may leave an albedo above 1: then all lobes are scaled.
  const FactoredBrdf stored = damper.store(lobes);
  result.largest_after = largest_of(albedos_of(stored), channels);
  lobes = {stored.lobes().begin(), stored.lobes().end()};
  limit_scales(lobes, result.largest_after, [](const Lobe&) { return true; });
  for (double& a : result.largest_after) a = a > 1 ? kLimit : a;
  result.brdf =
      FactoredBrdf(brdf.channels(), {stored.tables().begin(), stored.tables().end()}, std::move(lobes));
  return result;
}

}  // namespace burnish
