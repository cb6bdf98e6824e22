// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include <burnish/fitting/refinement/sparse_gram.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxUses = 12;
constexpr std::size_t kMaxEntries = 2'000'000;
// The largest number of nodes whose entries with each other are all kept (dense rows).
constexpr std::size_t kMaxDense = 1000;
// A table stays sparse if its nodes meet a smaller share than this of every volume's nodes.
constexpr double kFewMeetings = 0.25;

constexpr std::size_t kProducts = 27;  // three along each axis

// Two corners a >= b of a cell, as bits x, y, z, and the index of the product of their weights.
struct CornerPair {
  std::uint8_t a, b, product;
};

constexpr std::array<CornerPair, 36> corner_pairs() {
  std::array<CornerPair, 36> pairs{};
  std::size_t k = 0;
  for (std::uint8_t a = 0; a < 8; ++a)
    for (std::uint8_t b = 0; b <= a; ++b) {
      // Along one axis there are three products: 0 both corners lower, 1 one of each, 2 both upper.
      const auto along = [&](int bit) { return (a >> bit & 1) + (b >> bit & 1); };
      pairs[k++] = {a, b, static_cast<std::uint8_t>((along(2) * 3 + along(1)) * 3 + along(0))};
    }
  return pairs;
}
constexpr std::array<CornerPair, 36> kPairs = corner_pairs();

// Returns the products of two linear weights along one axis: (1-f)^2, f(1-f), f^2.
std::array<float, 3> products(float f) {
  const float g = 1 - f;
  return {g * g, f * g, f * f};
}

}  // namespace

std::optional<SparseGram> SparseGram::of(const LobeLanes& lanes) {
  SparseGram gram(lanes);
  if (lanes.channels() != 1 || !gram.find_uses() || !gram.find_meetings()) return {};
  gram.find_order();
  return gram;
}

bool SparseGram::find_uses() {
  // A use is one table looked up by one lane of a slot. A slot whose lanes share one table is one use.
  for (std::size_t s = 0; s < lanes_->slots().size(); ++s) {
    const LobeLanes::Slot& slot = lanes_->slots()[s];
    const std::vector<std::size_t>& of_lanes = lanes_->families()[slot.family].tables;
    for (std::size_t lane = 0; lane < (slot.one_table ? 1 : of_lanes.size()); ++lane)
      if (of_lanes[lane] != LobeLanes::kNone) uses_.push_back({of_lanes[lane], s, lane});
  }
  // Each table gets its strides and sides. A volume with one use sums products by cell, without a meeting.
  bool any_volume = false;
  for (std::size_t t = 0; t < lanes_->tables().size(); ++t) {
    const auto& [number, layout] = lanes_->tables()[t];
    const auto width = static_cast<std::uint32_t>(layout.width),
               height = static_cast<std::uint32_t>(layout.height);
    Table table{.base = number.base, .nodes = layout.node_count(), .cells = {}};
    table.corners = 1u << axis_count(layout.shape);
    std::ranges::copy(std::array{1u, width, width * height}, table.steps);
    std::ranges::copy(std::array{layout.width, layout.height, layout.depth}, table.sides);
    const bool volume = layout.shape == TableShape::volume;
    if (volume && std::ranges::count(uses_, t, &Use::table) == 1) table.cells.resize(table.nodes * kProducts);
    any_volume = any_volume || volume;
    tables_.push_back(std::move(table));
  }
  return any_volume && uses_.size() <= kMaxUses;
}

SparseGram::Terms SparseGram::terms(const Use& use, const Lookups::Place& place, float slope) const noexcept {
  // The terms of a use are the nodes of its cell with slope times the weight of (bi-, tri-)linear interpolation.
  const Table& table = tables_[use.table];
  Terms row;
  row.count = table.corners;
  for (std::uint32_t k = 0; k < row.count; ++k) {
    row.node[k] = place.node + (k & 1) + (k & 2 ? table.steps[1] : 0) + (k & 4 ? table.steps[2] : 0);
    row.weight[k] = slope * (k & 1 ? place.fx : 1 - place.fx);
    if (row.count > 2) row.weight[k] *= k & 2 ? place.fy : 1 - place.fy;
    if (row.count > 4) row.weight[k] *= k & 4 ? place.fz : 1 - place.fz;
  }
  return row;
}

template <class Visit>
void SparseGram::for_each_product(const UsePair& pair, std::span<const Terms> row, Visit visit) {
  // Visits all products of two uses' terms; those of a use with itself once for each unordered pair.
  const Terms &a = row[pair.first], &b = row[pair.second];
  const bool same = pair.first == pair.second;
  for (std::uint32_t i = 0; i < a.count; ++i)
    for (std::uint32_t j = 0; j < (same ? i + 1 : b.count); ++j)
      visit(a.node[i], b.node[j], a.weight[i] * b.weight[j]);
}

void SparseGram::find_pairs() {
  for (std::size_t u = 0; u < uses_.size(); ++u)
    for (std::size_t v = 0; v <= u; ++v) {
      // Each pair of uses adds to the meeting of their tables. The larger table is the meeting's table a.
      std::size_t first = u, second = v;
      if (u == v && !tables_[uses_[u].table].cells.empty()) continue;
      if (tables_[uses_[first].table].nodes < tables_[uses_[second].table].nodes) std::swap(first, second);
      const std::size_t a = uses_[first].table, b = uses_[second].table;
      const auto known = std::ranges::find_if(
          meetings_, [&](const Meeting& m) { return (m.a == a && m.b == b) || (m.a == b && m.b == a); });
      const auto meeting = static_cast<std::size_t>(known - meetings_.begin());
      if (known == meetings_.end()) {
        meetings_.push_back({.a = a, .b = b, .first = {}, .starts = {}, .sums = {}});
        meetings_.back().first.assign(tables_[a].nodes, static_cast<std::uint32_t>(tables_[b].nodes));
        meetings_.back().starts.assign(tables_[a].nodes + 1, 0);
      } else if (known->a != a) {
        std::swap(first, second);
      }
      pairs_.push_back({meeting, first, second});
    }
}

bool SparseGram::find_meetings() {
  find_pairs();

  // One pass over all pairs finds for each node of table a the range of b's nodes that it meets. Until the pass ends,
  // starts[a + 1] holds the end of a's range.
  constexpr std::size_t kBlock = LobeLanes::kBlock;
  std::vector<Terms> row(uses_.size());  // counts are 0 before the first pair
  for (std::size_t block = 0; block < lanes_->blocks(); ++block)
    for (std::size_t i = 0; i < kBlock; ++i) {
      // Pairs are in the order of cells, so a pair often touches the nodes of the one before. Then nothing changes.
      bool as_before = true;
      for (std::size_t u = 0; u < uses_.size(); ++u) {
        const Lookups::Place& place = place_of(uses_[u], block, i);
        as_before = as_before && row[u].count > 0 && row[u].node[0] == place.node;
        row[u] = terms(uses_[u], place, 1);
      }
      if (as_before) continue;
      for (const UsePair& pair : pairs_) {
        Meeting& meeting = meetings_[pair.meeting];
        for_each_product(pair, row, [&](std::uint32_t a, std::uint32_t b, float) {
          if (meeting.a == meeting.b && a < b) std::swap(a, b);
          meeting.first[a] = std::min(meeting.first[a], b);
          meeting.starts[a + 1] = std::max(meeting.starts[a + 1], b + 1);
        });
      }
    }
  // The ranges' lengths become the places where their sums start. Too many entries make the sparse matrix useless.
  std::size_t entries = 0;
  for (Meeting& meeting : meetings_) {
    for (std::size_t a = 0; a < tables_[meeting.a].nodes; ++a) {
      const std::uint32_t end = meeting.starts[a + 1];
      meeting.starts[a + 1] = meeting.starts[a] + (end > meeting.first[a] ? end - meeting.first[a] : 0);
    }
    entries += meeting.starts.back();
  }
  if (entries > kMaxEntries) return false;
  for (Meeting& meeting : meetings_) meeting.sums.resize(meeting.starts.back());
  return true;
}

bool SparseGram::meets_few(std::size_t table) const noexcept {
  return std::ranges::all_of(meetings_, [&](const Meeting& meeting) {
    if (meeting.b != table || tables_[meeting.a].corners != 8) return true;
    const auto all =
        static_cast<double>(tables_[meeting.a].nodes) * static_cast<double>(tables_[table].nodes);
    return meeting.starts.back() < kFewMeetings * all;
  });
}

void SparseGram::find_order() {
  // Unknowns are ordered for little fill-in: lines looked up once and grids that meet few nodes, then volumes. The
  // tables that nearly everything meets come last, as dense rows.
  const auto rank = [&](std::size_t t) {
    if (tables_[t].corners == 8) return 1;
    if (std::ranges::count(uses_, t, &Use::table) != 1) return 2;
    return tables_[t].corners == 2 || meets_few(t) ? 0 : 2;
  };
  std::uint32_t next = 0;
  std::size_t nodes = 0;
  for (int r = 0; r < 3; ++r)
    for (std::size_t t = 0; t < tables_.size(); ++t) {
      if (rank(t) != r) continue;
      place_.resize(std::max(place_.size(), tables_[t].base + tables_[t].nodes));
      for (std::size_t n = 0; n < tables_[t].nodes; ++n) place_[tables_[t].base + n] = next++;
      if (r < 2) continue;
      dense_.push_back(t);
      nodes += tables_[t].nodes;
    }
  if (nodes > kMaxDense) dense_.clear();
  dense_rows_ = dense_.empty() ? 0 : static_cast<int>(nodes);
}

void SparseGram::set_zero() {
  for (Table& table : tables_) std::ranges::fill(table.cells, 0.0f);
  for (Meeting& meeting : meetings_) std::ranges::fill(meeting.sums, 0.0f);
}

void SparseGram::add_to_cell(Table& table, const Lookups::Place& place, float amount) noexcept {
  // Adds the 27 products of the corners' weights along z, y and x, times `amount`, to the sums of the cell.
  const std::array<float, 3> x = products(place.fx), y = products(place.fy), z = products(place.fz);
  float plane[9];
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) plane[3 * j + i] = y[j] * x[i];
  float* cell = table.cells.data() + place.node * kProducts;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t j = 0; j < 9; ++j) cell[9 * k + j] += amount * z[k] * plane[j];
}

void SparseGram::add(std::size_t block, const LobeLanes::Block& at, const float* curvatures,
                     std::size_t count) {
  Terms row[kMaxUses];
  for (std::size_t i = 0; i < count; ++i) {
    // A pair adds curvature * slope_u w_u slope_v w_v to the entry of every two nodes u and v that it touches.
    const float curvature = curvatures[i];
    if (!(curvature > 0)) continue;
    for (std::size_t u = 0; u < uses_.size(); ++u) {
      const Use& use = uses_[u];
      const Lookups::Place& place = place_of(use, block, i);
      const float slope = at.factor[use.slot * LobeLanes::kBlockLanes + i * LobeLanes::kLanes + use.lane];
      row[u] = terms(use, place, slope);
      Table& table = tables_[use.table];
      if (!table.cells.empty()) add_to_cell(table, place, curvature * slope * slope);
    }
    for (const UsePair& pair : pairs_) {
      Meeting& meeting = meetings_[pair.meeting];
      const auto sum = [&](std::uint32_t a, std::uint32_t b) -> float& {
        return meeting.sums[meeting.starts[a] + b - meeting.first[a]];
      };
      if (meeting.a != meeting.b || pair.first == pair.second)
        for_each_product(pair, {row, uses_.size()},
                         [&](std::uint32_t a, std::uint32_t b, float w) { sum(a, b) += curvature * w; });
      else  // Two uses of one table: each product stands twice in the matrix, on both sides of the diagonal.
        for_each_product(pair, {row, uses_.size()}, [&](std::uint32_t a, std::uint32_t b, float w) {
          sum(std::max(a, b), std::min(a, b)) += (a == b ? 2 : 1) * curvature * w;
        });
    }
  }
}

template <class Visit>
void SparseGram::for_each_entry(Visit visit) const {
  // The sums of a cell are entries of its 36 pairs of corners.
  for (const Table& table : tables_) {
    if (table.cells.empty()) continue;
    for (std::size_t z = 0; z + 1 < table.sides[2]; ++z)
      for (std::size_t y = 0; y + 1 < table.sides[1]; ++y)
        for (std::size_t x = 0; x + 1 < table.sides[0]; ++x) {
          const std::size_t first = z * table.steps[2] + y * table.steps[1] + x;
          const auto corner = [&](unsigned k) {
            return table.base + first + (k & 1) + (k & 2 ? table.steps[1] : 0) + (k & 4 ? table.steps[2] : 0);
          };
          for (const CornerPair& pair : kPairs)
            visit(corner(pair.a), corner(pair.b), table.cells[first * kProducts + pair.product]);
        }
  }
  // The sums of a meeting are entries of its tables' nodes.
  for (const Meeting& meeting : meetings_)
    for (std::size_t a = 0; a < tables_[meeting.a].nodes; ++a)
      for (std::uint32_t k = meeting.starts[a]; k < meeting.starts[a + 1]; ++k)
        visit(tables_[meeting.a].base + a,
              tables_[meeting.b].base + meeting.first[a] + (k - meeting.starts[a]), meeting.sums[k]);
}

void SparseGram::set_constant(std::span<const Eigen::Triplet<double>> entries) {
  // The pattern is the union of the constant's entries, the sums' entries, the diagonal and all pairs of dense rows.
  using Triplet = Eigen::Triplet<double>;
  std::vector<Triplet> all;
  const auto lower = [&](std::size_t a, std::size_t b) {
    return std::pair(static_cast<int>(std::max(place_[a], place_[b])),
                     static_cast<int>(std::min(place_[a], place_[b])));
  };
  const auto add = [&](std::size_t a, std::size_t b, double value) {
    const auto [row, column] = lower(a, b);
    all.emplace_back(row, column, value);
  };
  for (const Triplet& entry : entries)
    add(static_cast<std::size_t>(entry.row()), static_cast<std::size_t>(entry.col()), entry.value());
  for_each_entry([&](std::size_t a, std::size_t b, float) { add(a, b, 0); });
  for (std::size_t u = 0; u < place_.size(); ++u) add(u, u, 0);
  for (const std::size_t s : dense_)
    for (const std::size_t t : dense_)
      for (std::size_t a = 0; a < tables_[s].nodes; ++a)
        for (std::size_t b = 0; b < (s == t ? a : s > t ? tables_[t].nodes : 0); ++b)
          add(tables_[s].base + a, tables_[t].base + b, 0);
  const auto size = static_cast<int>(place_.size());
  matrix_.resize(size, size);
  matrix_.setFromTriplets(all.begin(), all.end());
  constant_.assign(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros());

  // The place of each sum among the matrix's values is found once, so that make() only adds.
  slots_.clear();
  for_each_entry([&](std::size_t a, std::size_t b, float) {
    const auto [row, column] = lower(a, b);
    const int *columns = matrix_.innerIndexPtr(), *starts = matrix_.outerIndexPtr();
    slots_.push_back(static_cast<std::uint32_t>(
        std::lower_bound(columns + starts[row], columns + starts[row + 1], column) - columns));
  });
}

void SparseGram::make(const Eigen::VectorXd& lambda) {
  // The sums are by lambda. By x = ln lambda, entry (a, b) is multiplied by lambda_a lambda_b.
  std::ranges::copy(constant_, matrix_.valuePtr());
  std::size_t k = 0;
  for_each_entry([&](std::size_t a, std::size_t b, float sum) {
    matrix_.valuePtr()[slots_[k++]] += static_cast<double>(sum) * lambda[static_cast<Eigen::Index>(a)] *
                                       lambda[static_cast<Eigen::Index>(b)];
  });
}

}  // namespace burnish
