// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/baselines/compressive_weight.h>
#include <burnish/fitting/baselines/low_rank.h>
#include <burnish/fitting/baselines/separable_fit.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/mirror_asymmetry.h>

namespace burnish {

namespace {

using enum PairCoordinate;

// ---- one decomposition ----

constexpr int kUpdates = 200;  // of nonnegative factors

// Nodes that are filled in count little.
std::vector<double> node_weights(const Matrix& m, std::span<const std::uint8_t> measured,
                                 std::size_t repeat) {
  constexpr double kFilled = 0.05;
  double mean = 0;
  for (const double x : m.values) mean += x;
  mean = std::max(mean / static_cast<double>(m.values.size()), std::numeric_limits<double>::min());
  std::vector<double> weights(m.values.size());
  for (std::size_t i = 0; i < weights.size(); ++i)
    weights[i] = (measured[i / repeat] ? 1 : kFilled) * compressive_weight(m.values[i], mean);
  return weights;
}

LowRank factor(const Matrix& m, Decomposition method, std::size_t terms,
               std::span<const std::uint8_t> measured, std::size_t repeat) {
  if (method == Decomposition::svd) return singular_values(m, terms);
  if (method == Decomposition::nd) return normalized_decomposition(m);
  return nonnegative_factors(m, node_weights(m, measured, repeat), terms, kUpdates, 1);
}

// Makes u and v of each term as large as each other, so that rounding to halves harms both alike.
void balance(LowRank& factors) {
  const std::size_t terms = factors.terms;
  for (std::size_t k = 0; k < terms; ++k) {
    const auto largest = [&](const std::vector<double>& x) {
      double most = 0;
      for (std::size_t i = k; i < x.size(); i += terms) most = std::max(most, std::abs(x[i]));
      return most;
    };
    const double most_u = largest(factors.u), most_v = largest(factors.v);
    if (most_u <= 0 || most_v <= 0) continue;
    for (std::size_t i = k; i < factors.u.size(); i += terms) factors.u[i] *= std::sqrt(most_v / most_u);
    for (std::size_t i = k; i < factors.v.size(); i += terms) factors.v[i] *= std::sqrt(most_u / most_v);
  }
}

// Copies [node][term] into channel c of a table's [node][channel][term].
void store(const std::vector<double>& x, std::size_t c, NodeTable& table) {
  const auto terms = static_cast<std::size_t>(table.terms), channels = table.channels;
  for (std::size_t i = 0; i < x.size(); ++i)
    table.values[(i / terms * channels + c) * terms + i % terms] = round_to_half(x[i]);
}

NodeTable make_table(const std::vector<NodeAxis>& axes, std::size_t channels, std::size_t terms) {
  NodeTable table{axes, channels, static_cast<int>(terms), {}};
  table.values.resize(table.node_count() * channels * terms);
  return table;
}

/// The grid over its largest value, one a channel.
std::vector<float> channel_scales(const PairGrid& grid) {
  std::vector<float> scales(grid.channels);
  for (std::size_t i = 0; i < grid.values.size(); ++i)
    scales[i % grid.channels] = std::max(scales[i % grid.channels], static_cast<float>(grid.values[i]));
  return scales;
}

}  // namespace

std::string_view to_string(Decomposition method) noexcept {
  return method == Decomposition::svd ? "svd" : method == Decomposition::nd ? "nd" : "nmf";
}

SeparableBrdf decompose(const PairGrid& grid, Decomposition method, Coupling coupling, std::size_t terms) {
  const std::size_t channels = grid.channels, nodes = grid.rows * grid.columns;
  std::vector<float> scale = channel_scales(grid);
  // Coupled channels keep their proportions: they have one scale.
  if (coupling != Coupling::none) std::ranges::fill(scale, *std::max_element(scale.begin(), scale.end()));
  const auto value = [&](std::size_t node, std::size_t c) {
    return scale[c] > 0 ? grid.values[node * channels + c] / scale[c] : 0.0;
  };

  // a matrix a channel, or one of all
  std::vector<LowRank> parts;
  if (coupling == Coupling::none) {
    for (std::size_t c = 0; c < channels; ++c) {
      Matrix m{grid.rows, grid.columns, std::vector<double>(nodes)};
      for (std::size_t i = 0; i < nodes; ++i) m.values[i] = value(i, c);
      parts.push_back(factor(m, method, terms, grid.measured, 1));
    }
  } else {
    // sharing u stacks the channels' columns, as they lie; sharing v their rows
    const bool u_shared = coupling == Coupling::u;
    Matrix m{u_shared ? grid.rows : grid.columns, (u_shared ? grid.columns : grid.rows) * channels,
             std::vector<double>(nodes * channels)};
    std::vector<std::uint8_t> measured(nodes);
    for (std::size_t r = 0; r < grid.rows; ++r)
      for (std::size_t col = 0; col < grid.columns; ++col) {
        const std::size_t from = r * grid.columns + col, to = u_shared ? from : col * grid.rows + r;
        measured[to] = grid.measured[from];
        for (std::size_t c = 0; c < channels; ++c) m.values[to * channels + c] = value(from, c);
      }
    parts.push_back(factor(m, method, terms, measured, channels));
    if (!u_shared) std::swap(parts[0].u, parts[0].v);
  }
  for (LowRank& part : parts) balance(part);

  // as half floats
  const std::size_t kept = parts[0].terms;
  NodeTable u = make_table(grid.row_axes, coupling == Coupling::u ? 1 : channels, kept);
  NodeTable v = make_table(grid.column_axes, coupling == Coupling::v ? 1 : channels, kept);
  // [node][channel][term] is what a stacked side has already
  const auto store_side = [&](std::vector<double> LowRank::*side, NodeTable& table) {
    if (coupling == Coupling::none)
      for (std::size_t c = 0; c < channels; ++c) store(parts[c].*side, c, table);
    else
      std::ranges::transform(parts[0].*side, table.values.begin(), round_to_half);
  };
  store_side(&LowRank::u, u);
  store_side(&LowRank::v, v);
  return SeparableBrdf(std::move(u), std::move(v), std::move(scale));
}

namespace {

// ---- the search for a layout ----

/// The split of coordinates between rows and columns; one axis' size follows from the budget.
struct Split {
  std::vector<PairCoordinate> rows, columns;
};

// The second three, with a whole half turn of phi_d, for those that are not their own mirror image.
const std::array<Split, 6> kIsotropicSplits = {{{{theta_h}, {theta_d, phi_d}},
                                                {{theta_h, theta_d}, {phi_d}},
                                                {{theta_d}, {theta_h, phi_d}},
                                                {{theta_h}, {theta_d, half_turn_d}},
                                                {{theta_h, theta_d}, {half_turn_d}},
                                                {{theta_d}, {theta_h, half_turn_d}}}};
constexpr std::size_t kTwins = 16;  // of 108 starts: the best of all of them in trials as well
const std::array<Split, 2> kAnisotropicSplits = {
    {{{half_x, half_y}, {difference_x, difference_y}}, {{half_x, half_y, theta_d}, {turn_d}}}};

/// Places in the lists of sizes below.
struct Layout {
  std::size_t split = 0;
  Coupling coupling = Coupling::none;
  std::array<int, 3> size = {0, 2, 1};  ///< terms, theta_d nodes, phi_d nodes

  friend auto operator<=>(const Layout&, const Layout&) = default;
};

constexpr std::array kTerms = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64};
constexpr std::array kThetaNodes = {4, 6, 8, 12, 16, 24, 32, 48, 64};
constexpr std::array kPhiNodes = {2, 3, 5, 9, 17, 33};
constexpr int kMinHalfNodes = 8, kMaxHalfNodes = 512, kMaxDiskNodes = 96;

class Search {
 public:
  Search(BrdfRef source, Decomposition method, const SeparableOptions& options)
      : source_(source),
        method_(method),
        options_(options),
        unfolded_(source.isotropic() && mirror_asymmetry(source) > kMinAsymmetry ? kIsotropicSplits.size() / 2
                                                                                 : 0),
        splits_(!source.isotropic()
                    ? std::span<const Split>(kAnisotropicSplits)
                    : std::span(kIsotropicSplits).first(kIsotropicSplits.size() / 2 + unfolded_)),
        scorer_(source, {.count = 500, .seed = options.seed, .image_size = options.image_size}) {}

  SeparableFit run() {
    // every split and coupling from one start, then the best few climb
    std::vector<Layout> starts;
    for (std::size_t split = 0; split < splits_.size() - unfolded_; ++split)
      for (const Coupling coupling : {Coupling::none, Coupling::u, Coupling::v}) {
        if (coupling != Coupling::none && source_.channels() == 1) continue;
        starts.push_back({.split = split, .coupling = coupling});
      }
    std::vector<std::pair<double, Layout>> ranked;
    for (std::size_t i = 0; i < starts.size(); ++i) {
      for (const int terms : {0, 1, 2})
        for (const int nodes : {0, 1, 2, 4}) {
          Layout start = starts[i];
          start.size[0] = terms;
          start.size[1] = nodes;
          ranked.emplace_back(-quality(start), start);
        }
      report(0.3 * static_cast<double>(i + 1) / static_cast<double>(starts.size()));
    }
    std::sort(ranked.begin(), ranked.end());
    // the best also with phi_d over half a circle
    if (unfolded_ > 0) {
      for (std::size_t i = 0, count = std::min(kTwins, ranked.size()); i < count; ++i) {
        Layout twin = ranked[i].second;
        twin.split += unfolded_;
        ranked.emplace_back(-quality(twin), twin);
      }
      std::sort(ranked.begin(), ranked.end());
    }

    constexpr std::size_t kClimbers = 4;
    for (std::size_t i = 0; i < std::min(kClimbers, ranked.size()); ++i) {
      climb(ranked[i].second);
      report(0.3 + 0.7 * static_cast<double>(i + 1) / kClimbers);
    }
    if (!best_)
      throw Error(fmt::format("{}: expected a budget for tables of 8 nodes or more a side, found {} bytes",
                              to_string(method_), options_.budget));
    return {std::move(*best_), tried_.size()};
  }

 private:
  void report(double fraction) const {
    if (options_.progress) options_.progress(fraction);
  }

  // Nodes along one side of the half vector that the budget leaves; 0 if too few.
  int half_nodes(const Layout& layout, const std::array<std::vector<NodeAxis>, 2>& sides) const {
    const auto channels = source_.channels();
    const auto values_with = [&](int n) {
      std::size_t values = 0;
      for (std::size_t side = 0; side < 2; ++side) {
        const bool shared = layout.coupling == (side == 0 ? Coupling::u : Coupling::v);
        std::size_t count = static_cast<std::size_t>(kTerms[static_cast<std::size_t>(layout.size[0])]) *
                            (shared ? 1 : channels);
        for (const NodeAxis& axis : sides[side])
          count *= static_cast<std::size_t>(axis.count > 0 ? axis.count : n);
        values += count;
      }
      return values;
    };
    const std::size_t most_values = (options_.budget - std::min(options_.budget, 4 * channels)) / 2;
    int n = source_.isotropic() ? kMaxHalfNodes : kMaxDiskNodes;
    while (n >= kMinHalfNodes && values_with(n) > most_values) --n;
    return n >= kMinHalfNodes ? n : 0;
  }

  std::array<std::vector<NodeAxis>, 2> axes(const Layout& layout) const {
    const int theta = kThetaNodes[static_cast<std::size_t>(layout.size[1])],
              phi = kPhiNodes[static_cast<std::size_t>(layout.size[2])];
    std::array<std::vector<NodeAxis>, 2> sides;
    for (std::size_t side = 0; side < 2; ++side)
      for (const PairCoordinate c : side == 0 ? splits_[layout.split].rows : splits_[layout.split].columns) {
        const bool half = c == theta_h || c == half_x || c == half_y;
        // a half disk of d is twice as wide as high
        const int count = half                                            ? 0
                          : c == phi_d || c == half_turn_d || c == turn_d ? phi
                          : c == difference_x                             ? 2 * theta - 1
                                                                          : theta;
        sides[side].push_back({c, count});
      }
    const int n = half_nodes(layout, sides);
    for (auto& side : sides)
      for (NodeAxis& axis : side)
        if (axis.count == 0) axis.count = n;
    return sides;
  }

  // psnr of the layout, -1 where the budget does not allow it.
  double quality(const Layout& layout) {
    const auto [known, fresh] = tried_.try_emplace(layout, -1.0);
    if (!fresh) return known->second;
    if (method_ == Decomposition::nd && layout.size[0] > 0) return -1;
    const auto sides = axes(layout);
    for (const auto& side : sides)
      for (const NodeAxis& axis : side)
        if (axis.count == 0) return -1;
    const SeparableBrdf brdf =
        decompose(sample_pair_grid(source_, sides[0], sides[1]), method_, layout.coupling,
                  static_cast<std::size_t>(kTerms[static_cast<std::size_t>(layout.size[0])]));
    const double psnr = scorer_.picture_psnr(scorer_.pictures(brdf));
    if (!best_ || psnr > best_psnr_) {
      best_ = brdf;
      best_psnr_ = psnr;
    }
    return known->second = psnr;
  }

  void climb(Layout at) {
    constexpr std::array kLengths = {kTerms.size(), kThetaNodes.size(), kPhiNodes.size()};
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t k = 0; k < kLengths.size(); ++k)
        for (const int step : {1, -1}) {
          Layout next = at;
          next.size[k] += step;
          if (next.size[k] < 0 || next.size[k] >= static_cast<int>(kLengths[k])) continue;
          if (quality(next) <= quality(at)) continue;
          at = next;
          moved = true;
        }
    }
  }

  BrdfRef source_;
  Decomposition method_;
  const SeparableOptions& options_;
  std::size_t unfolded_;  // of the splits
  std::span<const Split> splits_;
  Scorer scorer_;
  std::map<Layout, double> tried_;
  std::optional<SeparableBrdf> best_;
  double best_psnr_ = 0;
};

}  // namespace

SeparableFit fit_separable(BrdfRef source, Decomposition method, const SeparableOptions& options) {
  return Search(source, method, options).run();
}

}  // namespace burnish
