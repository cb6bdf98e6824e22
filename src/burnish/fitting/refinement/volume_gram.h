#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include <burnish/fitting/numerics/incomplete_cholesky.h>
#include <burnish/fitting/refinement/lobe_lanes.h>
#include <burnish/fitting/refinement/lookups.h>

namespace burnish {

/// The Gauss-Newton matrix of one lobe that looks up a volume once and at most one line besides, along one of the
/// volume's axes. Few nodes meet in a pair of directions, so the matrix is formed whole and sparse. Pairs add to
/// sums of the volume's cells: the product of two corners' weights is one, over the axes, of (1-f)^2, f(1-f), f^2.
class VolumeGram {
 public:
  /// None for other models. The unknowns are those of one channel.
  static std::optional<VolumeGram> of(std::span<const LobeLanes::NumberedTable> tables,
                                      const Lookups& lookups);

  bool has_line() const noexcept { return line_.lookup != kNone; }

  std::size_t volume_lookup() const noexcept { return volume_.lookup; }
  /// kNone where there is no line.
  std::size_t line_lookup() const noexcept { return line_.lookup; }
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// What all is added to from now on, until now zero: entries of a lower triangle.
  void set_constant(std::vector<Eigen::Triplet<double>> entries);

  void set_zero();
  /// Adds `curvature` times the products of a row's terms, which are slopes by the lookups times the corners'
  /// weights; without a line, its slope is 0.
  void add(const Lookups::Place& in_volume, const Lookups::Place& in_line, float volume_slope,
           float line_slope, float curvature) noexcept;

  /// The constant, and the sums by the logarithms of the values `lambda`: entries times the values of their row and
  /// column. The lower triangle, which stays until the next call.
  void by_logarithms(const Eigen::VectorXd& lambda);
  const SparseTriangle& matrix() const noexcept { return matrix_; }

 private:
  struct Part {
    std::size_t lookup = kNone, nodes = 0, base = 0;  ///< of the unknowns
  };
  VolumeGram() = default;
  void find_reach(const Lookups& lookups);
  template <class Visit>
  void for_each_entry(Visit visit) const;

  Part volume_, line_;
  std::size_t size_ = 0;
  std::size_t sides_[3] = {},
              steps_[3] = {};  ///< the volume's nodes along its axes, and from one to the next
  std::size_t along_step_ = 1, along_nodes_ = 1;  ///< of the axis that the line has
  std::vector<std::uint32_t> first_;              ///< of the line's nodes that meet a layer across that axis
  std::size_t reach_ = 0;                         ///< how many these are at most

  std::vector<float> cells_;   ///< [cell, numbered by its first node][z][y][x], three products each
  std::vector<float> across_;  ///< [node of the volume][line's node from first_ on]
  std::vector<double> ends_;   ///< [interval of the line][3]
  SparseTriangle matrix_;
  std::vector<double> constant_;      ///< what all is added to, in the order of the matrix
  std::vector<std::uint32_t> slots_;  ///< where for_each_entry's entries stand in it
};

}  // namespace burnish
