#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <burnish/factors/table.h>
#include <burnish/fitting/lookups.h>

namespace burnish {

/// Products of J^T J and vectors, in single precision, where a row of J is a sum over lookups of a slope
/// times the weights of the lookup's interpolation. Tables of one layout lie side by side, lanes of a vector,
/// so that lookups at one place are one interpolation of vectors.
class LaneProduct {
 public:
  /// A table's unknowns: of node n, copy c number base + n stride + c. It has one copy, or one a channel.
  struct Unknowns {
    std::size_t base, stride, copies;
    TableLayout layout;
  };
  /// Rows are those of the training set that `lookups` was made for, `channels` a pair. Keeps a reference.
  LaneProduct(std::span<const Unknowns> tables, const Lookups& lookups, std::size_t channels);

  /// Slopes of all rows, zeros.
  std::vector<float> slopes() const;
  /// Where the slope of a pair's lookup stands in them.
  std::size_t slot(std::size_t pair, std::size_t channel, std::size_t lookup) const noexcept {
    constexpr std::size_t kBlock = Lookups::kBlock;
    const auto [group, lane] = slot_[lookup];
    return (pair / kBlock * channels_ + channel) * slots_ * kBlock + groups_[group].slot * kBlock +
           pair % kBlock * groups_[group].lanes + lane;
  }

  /// J^T J v, the same for any number of threads.
  Eigen::VectorXd times(const std::vector<float>& slopes, const Eigen::VectorXd& v) const;

  /// Lookups at one place of the tables of one family.
  struct Group {
    std::size_t base, channel_stride, next_row;  ///< of its tables' values; next_row 0: a line
    std::size_t place;
    std::size_t slot, lanes;  ///< its slopes; a family of one lane has nodes that follow each other
  };

 private:
  const Lookups& lookups_;
  std::size_t channels_, slots_ = 0, values_ = 0;
  struct Slot {
    std::size_t group, lane;
  };
  std::vector<Slot> slot_;  // of the lookups
  std::vector<Group> groups_;
  std::vector<std::uint32_t> value_of_;  // where an unknown stands among the values
};

}  // namespace burnish
