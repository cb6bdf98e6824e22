// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>

#include <burnish/fitting/refinement/node_band.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxDenseRest = 800;
constexpr std::size_t kMaxBand = 10'000'000;  // entries, which stand there once a channel

/// One axis of a table: nodes along it (0: no axis), the step from node to node, and the warp.
struct Axis {
  std::size_t nodes = 0, stride = 1;  ///< along it, 0: no axis; in nodes from one to the next
  Warp warp = {};
};

Axis axis_of(const TableLayout& layout, int axis) {
  const auto width = static_cast<std::size_t>(layout.width), height = static_cast<std::size_t>(layout.height);
  if (axis == 0) return {width, 1, layout.warp};
  if (axis == 1) return {height, width, layout.warp_y};
  return {static_cast<std::size_t>(layout.depth), width * height, layout.warp_z};
}

const Projection& projection_of(const FactorUse& use, int axis) {
  return axis == 0 ? use.projection : axis == 1 ? use.projection_y : use.projection_z;
}

/// Returns the axis along which every lookup of a table has the projection; without nodes where there is none.
Axis axis_along(const Projection& projection, std::size_t table, const TableLayout& layout,
                const Lookups& lookups) {
  if (layout.shape == TableShape::disk) return {};
  for (int axis = 0; axis < axis_count(layout.shape); ++axis)
    if (std::ranges::all_of(lookups.lookups, [&](const FactorUse& use) {
          return use.table != table || projection_of(use, axis) == projection;
        }))
      return axis_of(layout, axis);
  return {};
}

/// Returns the projection that every volume has along some axis. If there are several, it is the one whose order
/// leaves the fewest nodes at one coordinate, which makes the narrowest band.
std::optional<Projection> key_projection(std::span<const LobeLanes::NumberedTable> tables,
                                         const Lookups& lookups) {
  std::optional<Projection> best;
  std::size_t fewest = static_cast<std::size_t>(-1);
  for (const FactorUse& use : lookups.lookups) {
    if (tables[use.table].layout.shape != TableShape::volume) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const Projection& candidate = projection_of(use, axis);
      std::size_t abreast = 0;
      bool serves = true;
      for (std::size_t t = 0; t < tables.size() && serves; ++t) {
        if (tables[t].layout.shape != TableShape::volume) continue;
        const Axis along = axis_along(candidate, t, tables[t].layout, lookups);
        serves = along.nodes > 0;
        if (serves) abreast += tables[t].layout.node_count() / along.nodes;
      }
      if (serves && abreast < fewest) {
        fewest = abreast;
        best = candidate;
      }
    }
  }
  return best;
}

// Calls visit(unknown) for the nodes that a lookup touches.
template <class Visit>
void for_each_node(const LobeLanes::NumberedTable& table, std::size_t node, std::size_t channel,
                   Visit visit) {
  const TableLayout& layout = table.layout;
  const int axes = axis_count(layout.shape);
  const auto width = static_cast<std::size_t>(layout.width),
             layer = width * static_cast<std::size_t>(layout.height);
  for (std::size_t k = 0; k < std::size_t{1} << axes; ++k)
    visit(static_cast<std::uint32_t>(
        table.number(node + (k & 1) + (k & 2 ? width : 0) + (k & 4 ? layer : 0), channel)));
}

}  // namespace

NodeBand::NodeBand(std::span<const LobeLanes::NumberedTable> tables, const Lookups& lookups,
                   std::size_t channels) {
  // The band is used if it fits the memory limit. Otherwise all unknowns go to the rest.
  order(tables, lookups, key_projection(tables, lookups));
  const std::size_t width = !banded_.empty() ? band_width(tables, lookups, channels) : 0;
  if (banded_.size() * (width + 1) <= kMaxBand)
    band_ = BandMatrix(banded_.size(), width);
  else
    order(tables, lookups, {});
  // The rest keeps its whole matrix while it is small, and its diagonal where it is large.
  const auto rest = static_cast<Eigen::Index>(rest_count_);
  rest_.resize(rest, rest_count_ <= kMaxDenseRest ? rest : 1);
}

void NodeBand::order(std::span<const LobeLanes::NumberedTable> tables, const Lookups& lookups,
                     const std::optional<Projection>& key) {
  banded_.clear();
  rest_count_ = 0;
  struct Placed {
    double coordinate;
    std::uint32_t unknown;
  };
  std::vector<Placed> banded;
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const auto& [number, layout] = tables[t];
    const std::size_t unknowns = layout.node_count() * number.copies;
    place_.resize(std::max(place_.size(), number.base + unknowns));
    // Unknowns of tables along the key get a coordinate, tan(theta / 2) of their node; all others go to the rest.
    const Axis axis = key ? axis_along(*key, t, layout, lookups) : Axis{};
    for (std::size_t i = 0; i < unknowns; ++i) {
      const auto unknown = static_cast<std::uint32_t>(number.base + i);
      if (axis.nodes == 0) {
        place_[unknown] = kInRest | static_cast<std::uint32_t>(rest_count_++);
        continue;
      }
      const std::size_t along = i / number.copies / axis.stride % axis.nodes;
      banded.push_back(
          {axis.warp.inverse(static_cast<double>(along) / static_cast<double>(axis.nodes - 1)), unknown});
    }
  }
  // Sorted by that coordinate, nodes that a pair couples stand near each other.
  std::ranges::stable_sort(banded, {}, &Placed::coordinate);
  for (const Placed& placed : banded) {
    place_[placed.unknown] = static_cast<std::uint32_t>(banded_.size());
    banded_.push_back(placed.unknown);
  }
}

std::size_t NodeBand::band_width(std::span<const LobeLanes::NumberedTable> tables, const Lookups& lookups,
                                 std::size_t channels) const {
  std::size_t width = 0;
  constexpr std::size_t kBlock = Lookups::kBlock;
  for (std::size_t i = 0; i < lookups.pairs; ++i)
    for (std::size_t c = 0; c < channels; ++c) {
      // The width is the largest distance between two banded unknowns that one pair touches.
      std::uint32_t least = kInRest, most = 0;
      for (std::size_t k = 0; k < lookups.lookups.size(); ++k) {
        const auto t = lookups.lookups[k].table;
        const Lookups::Place& place =
            lookups.places[(i / kBlock * lookups.place_count + lookups.place_of[k]) * kBlock + i % kBlock];
        if (!is_banded(static_cast<std::uint32_t>(tables[t].number.base))) continue;
        for_each_node(tables[t], place.node, c, [&](std::uint32_t unknown) {
          least = std::min(least, place_[unknown]);
          most = std::max(most, place_[unknown]);
        });
      }
      if (most > least) width = std::max<std::size_t>(width, most - least);
    }
  return width;
}

void NodeBand::set_zero() {
  nodes_.clear();
  band_.set_zero();
  rest_.setZero();
}

void NodeBand::add(std::uint32_t a, std::uint32_t b, double value) {
  // kInRest is the highest bit, so the larger place is in the rest if either is. Entries that couple band and rest
  // are dropped.
  const std::uint32_t row = std::max(place_[a], place_[b]), column = std::min(place_[a], place_[b]);
  if ((row & kInRest) == 0) {
    band_(row, column) += value;
  } else if ((column & kInRest) != 0) {
    const auto i = static_cast<Eigen::Index>(row & ~kInRest),
               j = static_cast<Eigen::Index>(column & ~kInRest);
    if (rest_.cols() == rest_.rows())
      rest_(i, j) += value;
    else if (i == j)
      rest_(i, 0) += value;
  }
}

void NodeBand::add_row(std::span<const Term> row, double weight) {
  // Rows of the same nodes are summed in a small dense triangle before they go to their places.
  if (!std::ranges::equal(row, nodes_, {}, &Term::unknown)) {
    add_sums();
    nodes_.clear();
    for (const Term& term : row) nodes_.push_back(term.unknown);
    sums_.assign(row.size() * row.size(), 0);
  }
  slopes_.clear();
  for (const Term& term : row) slopes_.push_back(term.slope);
  double* sums = sums_.data();
  for (std::size_t a = 0; a < row.size(); ++a, sums += row.size()) {
    const double scale = weight * slopes_[a];
    for (std::size_t b = 0; b <= a; ++b) sums[b] += scale * slopes_[b];
  }
}

void NodeBand::add_sums() {
  const double* sums = sums_.data();
  for (std::size_t a = 0; a < nodes_.size(); ++a, sums += nodes_.size()) {
    add(nodes_[a], nodes_[a], sums[a]);
    // A row may touch one node twice. Both orders of that product fall on the diagonal.
    for (std::size_t b = 0; b < a; ++b) add(nodes_[a], nodes_[b], (nodes_[a] == nodes_[b] ? 2 : 1) * sums[b]);
  }
  nodes_.clear();
}

void NodeBand::add_wide_row(std::span<const Term> row, double weight) {
  // A product is inside if the band, or the whole matrix of the rest, has a place for it.
  const auto inside = [&](std::uint32_t a, std::uint32_t b) {
    if (!is_banded(a)) return rest_.cols() == rest_.rows();
    return std::max(place_[a], place_[b]) - std::min(place_[a], place_[b]) <= band_.width();
  };
  for (std::size_t a = 0; a < row.size(); ++a) {
    const double scale = weight * row[a].slope;
    add(row[a].unknown, row[a].unknown, scale * row[a].slope);
    for (std::size_t b = 0; b < a; ++b) {
      const double product = scale * row[b].slope;
      if (inside(row[a].unknown, row[b].unknown)) {
        add(row[a].unknown, row[b].unknown, product);
      } else {
        // A product p outside becomes |p| on both diagonals: |p| (x_a^2 + x_b^2) >= 2 p x_a x_b, so the matrix stays
        // positive.
        add(row[a].unknown, row[a].unknown, std::abs(product));
        add(row[b].unknown, row[b].unknown, std::abs(product));
      }
    }
  }
}

bool NodeBand::factorize(const Eigen::VectorXd& extra) {
  // The damping goes on the diagonal; then rest and band are factorized, each by Cholesky.
  add_sums();
  for (std::uint32_t u = 0; u < place_.size(); ++u) add(u, u, extra[static_cast<Eigen::Index>(u)]);
  if (rest_.cols() == rest_.rows() && rest_count_ > 0) {
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(rest_);
    if (in_place.info() != Eigen::Success) return false;
  }
  return banded_.empty() || band_.factorize();
}

Eigen::VectorXd NodeBand::solve(const Eigen::VectorXd& b) const {
  Eigen::VectorXd banded(static_cast<Eigen::Index>(banded_.size())),
      rest(static_cast<Eigen::Index>(rest_count_));
  // The vector is split into band and rest, each is solved by its factor, and the solutions are joined.
  const auto at = [&](Eigen::VectorXd& of_band, Eigen::VectorXd& of_rest, std::size_t u) -> double& {
    return place_[u] & kInRest ? of_rest[static_cast<Eigen::Index>(place_[u] & ~kInRest)]
                               : of_band[static_cast<Eigen::Index>(place_[u])];
  };
  for (std::size_t u = 0; u < place_.size(); ++u) at(banded, rest, u) = b[static_cast<Eigen::Index>(u)];
  if (!banded_.empty()) banded = band_.solve(std::move(banded));
  if (rest_.cols() == rest_.rows()) {
    rest_.triangularView<Eigen::Lower>().solveInPlace(rest);
    rest_.triangularView<Eigen::Lower>().transpose().solveInPlace(rest);
  } else {
    rest = rest.cwiseQuotient(rest_.col(0));
  }
  Eigen::VectorXd x(b.size());
  for (std::size_t u = 0; u < place_.size(); ++u) x[static_cast<Eigen::Index>(u)] = at(banded, rest, u);
  return x;
}

}  // namespace burnish
