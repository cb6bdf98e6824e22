// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/tensor_tree.h>

namespace burnish {

namespace {

constexpr double kBelowOne = 0x1.fffffffffffffp-1;
constexpr double kQuarterPi = kPi / 4;
constexpr double kEdge = 1e-12;  // relative to the square's width

using Coordinates = std::array<double, 4>;

/// Moves a coordinate into [0, 1), so that the last cell holds its end. A coordinate that rounding left just below a
/// cell's edge moves onto it, into the upper cell.
double inside(double x) noexcept {
  return std::clamp(x + kEdge, 0.0, kBelowOne);
}

Coordinates coordinates_of(int rank, Vec3 wi, Vec3 wo) noexcept {
  if (rank == 4) {
    const DiskPoint in = shirley_chiu_square({-wi.x, -wi.y}), out = shirley_chiu_square({wo.x, wo.y});
    return {inside(in.x), inside(in.y), inside(out.x), inside(out.y)};
  }
  // The table stores wo turned until -wi is above +x, since the source is isotropic.
  const double sine = std::hypot(wi.x, wi.y);
  const double c = sine > 0 ? -wi.x / sine : 1, s = sine > 0 ? -wi.y / sine : 0;
  const DiskPoint out = shirley_chiu_square({c * wo.x + s * wo.y, c * wo.y - s * wo.x});
  return {std::min(inside(0.5 - 0.5 * sine), 0.5 * kBelowOne), inside(out.x), inside(out.y), 0};
}

float look_up(const TensorTree& tree, Coordinates x) noexcept {
  const auto rank = static_cast<std::size_t>(tree.rank);
  TensorTree::Node node = tree.nodes.front();
  while (node.log2 < 0) {
    std::size_t child = 0;
    for (std::size_t i = 0; i < rank; ++i) {
      // Each level halves the cube along every axis; the coordinates are rescaled to the half.
      const bool upper = x[i] >= 0.5;
      child |= static_cast<std::size_t>(upper) << i;
      x[i] = 2 * x[i] - upper;
    }
    node = tree.nodes[tree.links[node.first + child]];
  }
  const double count = std::ldexp(1.0, node.log2);
  std::size_t index = 0;
  for (std::size_t i = 0; i < rank; ++i)
    index = (index << node.log2) + static_cast<std::size_t>(count * x[i]);
  return tree.values[node.first + index];
}

/// Walks the tree and lists its leaves; corner and size of each cube are known on the way.
class LeafList {
 public:
  explicit LeafList(const TensorTree& tree) : tree_(tree), rank_(static_cast<std::size_t>(tree.rank)) {}

  void add(std::size_t index, const Coordinates& corner, double size) {
    if (tree_.rank == 3 && corner[0] >= 0.5) return;
    const TensorTree::Node node = tree_.nodes[index];
    if (node.log2 < 0) {
      for (std::size_t child = 0; child < std::size_t{1} << rank_; ++child) {
        Coordinates part = corner;
        for (std::size_t i = 0; i < rank_; ++i) part[i] += child >> i & 1 ? size / 2 : 0;
        add(tree_.links[node.first + child], part, size / 2);
      }
      return;
    }
    const auto log2 = static_cast<std::size_t>(node.log2);
    const std::size_t mask = (std::size_t{1} << log2) - 1;
    const double step = std::ldexp(size, -node.log2);
    for (std::size_t entry = 0; entry < std::size_t{1} << rank_ * log2; ++entry) {
      TreeLeaf leaf{.size = step, .value = tree_.values[node.first + entry]};
      for (std::size_t i = 0; i < rank_; ++i)
        leaf.centre[i] =
            corner[i] + (static_cast<double>(entry >> (rank_ - 1 - i) * log2 & mask) + 0.5) * step;
      if (tree_.rank == 4 || leaf.centre[0] < 0.5 || step > 0.5) list_.push_back(leaf);
    }
  }

  std::vector<TreeLeaf> take() { return std::move(list_); }

 private:
  const TensorTree& tree_;
  const std::size_t rank_;
  std::vector<TreeLeaf> list_;
};

/// Makes a tree of a full grid of rank 4.
class TreeBuilder {
 public:
  TreeBuilder(std::span<const float> grid, int depth, double tolerance)
      : grid_(grid), depth_(static_cast<std::size_t>(depth)), tolerance_(tolerance) {}

  /// Adds the node of the cube at `corner` with 2^log2 cells along its edge; returns its number.
  std::uint32_t add(const std::array<std::size_t, 4>& corner, std::size_t log2) {
    const auto number = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    const std::vector<float> cells = cells_of(corner, log2);
    const auto [low, high] = std::minmax_element(cells.begin(), cells.end());
    const double most = std::max(std::abs(*low), std::abs(*high));
    if (log2 <= 1 || static_cast<double>(*high) - static_cast<double>(*low) <= tolerance_ * most) {
      const bool flat = static_cast<double>(*high) - static_cast<double>(*low) <= tolerance_ * most;
      tree_.nodes[number] = {flat ? 0 : 1, static_cast<std::uint32_t>(tree_.values.size())};
      if (flat)
        tree_.values.push_back(static_cast<float>(std::accumulate(cells.begin(), cells.end(), 0.0) /
                                                  static_cast<double>(cells.size())));
      else
        tree_.values.insert(tree_.values.end(), cells.begin(), cells.end());
      return number;
    }

    const std::size_t first = tree_.links.size();
    tree_.nodes[number] = {-1, static_cast<std::uint32_t>(first)};
    tree_.links.resize(first + 16);
    for (std::size_t child = 0; child < 16; ++child) {
      auto part = corner;
      for (std::size_t i = 0; i < 4; ++i) part[i] += (child >> i & 1) << (log2 - 1);
      const std::uint32_t added = add(part, log2 - 1);
      tree_.links[first + child] = added;
    }
    return number;
  }

  TensorTree take() { return std::move(tree_); }

 private:
  std::vector<float> cells_of(const std::array<std::size_t, 4>& corner, std::size_t log2) const {
    std::vector<float> cells(std::size_t{1} << 4 * log2);
    const std::size_t mask = (std::size_t{1} << log2) - 1;
    for (std::size_t entry = 0; entry < cells.size(); ++entry) {
      std::size_t index = 0;
      for (std::size_t i = 0; i < 4; ++i)
        index = (index << depth_) + corner[i] + (entry >> (3 - i) * log2 & mask);
      cells[entry] = grid_[index];
    }
    return cells;
  }

  std::span<const float> grid_;
  std::size_t depth_;
  double tolerance_;
  TensorTree tree_;
};

}  // namespace

DiskPoint shirley_chiu_disk(DiskPoint square) noexcept {
  const double a = 2 * square.x - 1, b = 2 * square.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  // Concentric squares map to circles [Shirley 1997]: the larger coordinate is the radius, the ratio gives the angle.
  const bool along_x = std::abs(a) > std::abs(b);
  const double radius = along_x ? a : b;  // signed by its side
  const double angle = along_x ? kQuarterPi * (b / a) : kHalfPi - kQuarterPi * (a / b);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

DiskPoint shirley_chiu_square(DiskPoint disk) noexcept {
  const double radius = std::hypot(disk.x, disk.y);
  if (radius == 0) return {0.5, 0.5};
  const bool along_x = std::abs(disk.x) > std::abs(disk.y);
  const double side = std::copysign(radius, along_x ? disk.x : disk.y);
  const double angle = along_x ? std::atan(disk.y / disk.x) : std::atan(disk.x / disk.y);
  const double across = side * angle / kQuarterPi;
  return along_x ? DiskPoint{0.5 + 0.5 * side, 0.5 + 0.5 * across}
                 : DiskPoint{0.5 + 0.5 * across, 0.5 + 0.5 * side};
}

bool TensorTree::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  const bool known = eval_raw(wi, wo, f);
  cut_negatives(f);
  return known;
}

bool TensorTree::eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  f[0] = wi.z <= 0 || wo.z <= 0 ? 0 : static_cast<double>(look_up(*this, coordinates_of(rank, wi, wo)));
  return true;
}

std::vector<TreeLeaf> leaves(const TensorTree& tree) {
  LeafList list(tree);
  list.add(0, {}, 1);
  return list.take();
}

DirectionPair leaf_directions(const TensorTree& tree, const TreeLeaf& leaf) noexcept {
  const auto direction = [](DiskPoint square) {
    const DiskPoint disk = shirley_chiu_disk(square);
    return Vec3{disk.x, disk.y, std::sqrt(std::max(1 - disk.x * disk.x - disk.y * disk.y, 0.0))};
  };
  const auto& x = leaf.centre;
  if (tree.rank == 4) {
    const Vec3 travels = direction({x[0], x[1]});
    return {mirror(travels), direction({x[2], x[3]})};
  }
  // A cube that covers all of the axis has an unused half, which is no part of it.
  const double sine = 1 - 2 * (leaf.size > 0.5 ? 0.25 : x[0]);
  return {{-sine, 0, std::sqrt(1 - sine * sine)}, direction({x[1], x[2]})};
}

double leaf_weight(const TensorTree& tree, const TreeLeaf& leaf) noexcept {
  if (tree.rank == 4) return leaf.size * leaf.size * leaf.size * leaf.size;
  // The projected solid angle of a ring is proportional to sin theta_i d sin theta_i.
  const double sine = 1 - 2 * (leaf.size > 0.5 ? 0.25 : leaf.centre[0]);
  return leaf.size * leaf.size * leaf.size * sine;
}

TensorTree tabulate_tree(BrdfRef source, int depth, double tolerance) {
  assert(depth >= 1 && depth <= 6 && source.channels() == 1);
  const std::size_t along = std::size_t{1} << depth, side = along * along;
  const TensorTree layout{.rank = 4, .nodes = {}, .links = {}, .values = {}};
  const auto place = [&](std::size_t i) {
    return (static_cast<double>(i) + 0.5) / static_cast<double>(along);
  };

  // The full grid is filled slice by slice of incident directions.
  std::vector<float> grid(side * side);
  for_each_chunk(side, 1, [&](std::size_t in, std::size_t, std::size_t) {
    for (std::size_t out = 0; out < side; ++out) {
      const TreeLeaf cell{
          .centre = {place(in / along), place(in % along), place(out / along), place(out % along)}};
      const auto [wi, wo] = leaf_directions(layout, cell);
      double f = 0;
      source.eval(wi, wo, {&f, 1});
      grid[in * side + out] = static_cast<float>(f);
    }
  });
  TreeBuilder builder(grid, depth, tolerance);
  builder.add({}, static_cast<std::size_t>(depth));
  return builder.take();
}

}  // namespace burnish
