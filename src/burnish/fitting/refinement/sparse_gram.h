// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <burnish/fitting/numerics/incomplete_cholesky.h>
#include <burnish/fitting/refinement/lobe_lanes.h>

namespace burnish {

/// The Gauss-Newton matrix of one channel of a model with volumes, formed whole: few pairs of nodes meet in a pair of
/// directions. For a volume that is looked up once, pairs add to sums of its cells: along each axis, the product of
/// two corners' weights is (1-f)^2, f(1-f) or f^2. For two tables, each node of the larger has the range of the
/// smaller's nodes that it meets.
class SparseGram {
 public:
  /// Returns nothing for models without volumes, of several channels, of many lookups, and where too many nodes meet.
  /// `lanes` must outlive the result.
  static std::optional<SparseGram> of(const LobeLanes& lanes);

  /// Sets the constant part of the matrix, which is empty until now: entries of a lower triangle, by unknowns.
  void set_constant(std::span<const Eigen::Triplet<double>> entries);

  void set_zero();
  /// Adds, for the first `count` pairs of a block, curvature times the products of a row's terms, which are slopes
  /// as LobeLanes::differentiate leaves them, times the corners' weights.
  void add(std::size_t block, const LobeLanes::Block& at, const float* curvatures, std::size_t count);
  /// Makes the matrix: the constant, and the sums by the logarithms of the values `lambda`, entries times the values
  /// of their row and column.
  void make(const Eigen::VectorXd& lambda);

  /// The lower triangle in an order of its own: row place()[u] is unknown u's.
  const SparseTriangle& matrix() const noexcept { return matrix_; }
  std::span<const std::uint32_t> place() const noexcept { return place_; }
  /// Returns the number of last rows that have entries for each two of them.
  int dense_rows() const noexcept { return dense_rows_; }

 private:
  /// A lookup of a lobe and where its slopes stand.
  struct Use {
    std::size_t table, slot, lane;
  };
  struct Table {
    std::size_t base = 0, nodes = 0;  ///< of the unknowns
    std::uint32_t corners = 2;        ///< of a lookup
    std::uint32_t steps[3] = {};      ///< from node to node along the axes
    std::size_t sides[3] = {};
    std::vector<float>
        cells;  ///< of a volume looked up once: [cell, by its first node][z][y][x], three products each
  };
  /// Entries of two tables, or of one with b <= a.
  struct Meeting {
    std::size_t a, b;
    std::vector<std::uint32_t> first,
        starts;  ///< of a's nodes: b's first node, and where its range's sums start
    std::vector<float> sums;
  };
  /// Two uses whose products of terms a meeting sums; `first` has the meeting's table a.
  struct UsePair {
    std::size_t meeting, first, second;
  };
  /// The terms of a row that a use has.
  struct Terms {
    std::uint32_t count, node[8];
    float weight[8];
  };

  explicit SparseGram(const LobeLanes& lanes) : lanes_(&lanes) {}
  bool find_uses();
  // Finds the tables whose uses meet.
  void find_pairs();
  // Finds the ranges of nodes that meet; returns false if they have too many entries.
  bool find_meetings();
  void find_order();
  // Returns true if the nodes of a table meet a small part of each volume's nodes.
  bool meets_few(std::size_t table) const noexcept;
  // Calls visit(node a, node b, product of their weights) for each entry that two uses add to.
  template <class Visit>
  static void for_each_product(const UsePair& pair, std::span<const Terms> row, Visit visit);
  Terms terms(const Use& use, const Lookups::Place& place, float slope) const noexcept;
  static void add_to_cell(Table& table, const Lookups::Place& place, float amount) noexcept;
  const Lookups::Place& place_of(const Use& use, std::size_t block, std::size_t pair) const noexcept {
    return lanes_->places(block)[lanes_->slots()[use.slot].place * LobeLanes::kBlock + pair];
  }
  template <class Visit>
  void for_each_entry(Visit visit) const;

  const LobeLanes* lanes_;
  std::vector<Use> uses_;
  std::vector<Table> tables_;
  std::vector<Meeting> meetings_;
  std::vector<UsePair> pairs_;
  std::vector<std::size_t> dense_;  ///< tables all of whose nodes have entries with each other
  std::vector<std::uint32_t> place_;
  int dense_rows_ = 0;
  SparseTriangle matrix_;
  std::vector<double> constant_;      ///< in the order of the matrix
  std::vector<std::uint32_t> slots_;  ///< places of for_each_entry's entries in the matrix
};

}  // namespace burnish
