// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <burnish/factors/table.h>
#include <burnish/fitting/numerics/aligned_vector.h>
#include <burnish/fitting/numerics/node_numbers.h>
#include <burnish/fitting/refinement/lookups.h>

namespace burnish {

/// Sums over pairs are taken in at most so many groups, joined in their order: the same bits for any number of
/// threads.
inline constexpr std::size_t kMaxGroups = 16;

/// A model's lobes side by side as lanes of vectors: what they look up at one place is one interpolation of
/// vectors, in single precision. Tables that lobes look up so form a family, whose values stand node by node;
/// a lane without a table has one that is 1 everywhere.
class LobeLanes {
 public:
  static constexpr std::size_t kLanes = 8, kBlock = Lookups::kBlock;
  static constexpr std::size_t kBlockLanes = kBlock * kLanes;

  /// A table and the numbers of its nodes among the unknowns; it has one copy, or one for each channel.
  struct NumberedTable {
    NodeNumbers number;
    TableLayout layout;
  };
  /// Prepares the lanes. Rows are those of the training set that `lookups` was made for, with `channels` for each
  /// pair. Keeps a reference.
  LobeLanes(std::span<const NumberedTable> tables, const Lookups& lookups, std::size_t channels);

  /// Tables, one a lane; kNone where there is none.
  struct Family {
    std::vector<std::size_t> tables;
    bool one_table;    ///< the same in all lanes
    std::size_t base;  ///< of its values
  };
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  /// The lookups of up to kLanes lobes at one place.
  struct Slot {
    std::size_t place, family;
    std::size_t base;                  ///< of the family's values
    std::size_t next_row, next_layer;  ///< 0: a line; 0: no volume
    std::size_t part;                  ///< of the lobes, kLanes each
    bool one_table;
  };
  std::span<const NumberedTable> tables() const noexcept { return tables_; }
  std::size_t channels() const noexcept { return channels_; }
  std::span<const Family> families() const noexcept { return families_; }
  std::span<const Slot> slots() const noexcept { return slots_; }
  std::size_t blocks() const noexcept { return lookups_.places.size() / kBlock / lookups_.place_count; }
  /// A block's places; slot s has those from s.place * kBlock.
  const Lookups::Place* places(std::size_t block) const noexcept {
    return lookups_.places.data() + block * kBlock * lookups_.place_count;
  }

  /// A model's values. Each table's are divided by exp(the mean of its logarithms); these make the lobes' scales.
  struct Values {
    Eigen::VectorXd lambda;        ///< of the unknowns
    AlignedVector<float> lambdas;  ///< the same as lanes, 1 where there is no table
    AlignedVector<float> scales;   ///< [channel][part][lane], 0 where there is no lobe
  };
  /// Computes the values from the logarithms.
  Values values(const Eigen::VectorXd& x) const;
  /// Adds what lanes hold to their unknowns.
  void gather(const AlignedVector<float>& lanes, Eigen::VectorXd& v) const;

  /// Room for a block's [slot][pair][lane], [part][pair][lane] and [pair].
  struct Block {
    AlignedVector<float> factor, product, total;
  };
  Block block() const;
  /// Computes factors, products and totals of a block of one channel.
  void evaluate(const Values& values, std::size_t block, std::size_t channel, Block& at) const noexcept;
  /// Turns products into shares of the total, and factors into d ln(total) / d factor. For one table, the first lane
  /// has the sum.
  void differentiate(Block& at) const noexcept;
  /// Adds amounts times the transposed row of each pair, `factor` being slopes by the lookups, to `sums`.
  void add_transposed(const Block& at, const float* amounts, std::size_t block, std::size_t channel,
                      AlignedVector<float>& sums) const noexcept;
  /// Adds amounts times the squares of the rows' terms.
  void add_squares(const Block& at, const float* amounts, std::size_t block, std::size_t channel,
                   AlignedVector<float>& sums) const noexcept;

  /// Returns J^T J v, where rows of J are `roots` times d ln(total) / d value. It takes the shares as differentiate
  /// leaves them, times roots: [block][channel][part][pair][lane]. The same bits for any number of threads.
  Eigen::VectorXd times(const Values& values, const AlignedVector<float>& shares,
                        const Eigen::VectorXd& v) const;
  std::size_t shares_of_block() const noexcept { return parts_ * kBlockLanes; }

 private:
  // Returns the unknowns' numbers as lanes, `empty` where there is no table.
  AlignedVector<float> spread(const Eigen::VectorXd& v, float empty) const;

  const Lookups& lookups_;
  std::size_t channels_, parts_, channel_size_ = 0;
  std::vector<NumberedTable> tables_;
  std::vector<Family> families_;
  std::vector<Slot> slots_;
  struct Link {
    std::uint32_t unknown, value;
  };
  std::vector<Link> links_;
};

}  // namespace burnish
