// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <burnish/parameterization/hemisphere_map.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Point of the unit disk that stands for a point of the square [0, 1]^2; areas keep their ratio. Source:
/// [Shirley 1997], as Radiance has it.
DiskPoint shirley_chiu_disk(DiskPoint square) noexcept;
/// Inverse of shirley_chiu_disk to 1e-15.
DiskPoint shirley_chiu_square(DiskPoint disk) noexcept;

/// A cube of one value, in the coordinates of TensorTree.
struct TreeLeaf {
  std::array<double, 4> centre{};  ///< the first `rank` count
  double size = 1;                 ///< of its edge
  float value = 0;
};

/// A BRDF of constant cubes of different sizes, as Radiance and WINDOW have it: a tree that halves every axis at a
/// time, [Ward 2012]. Rank 4 has as coordinates the squares of (-wi.x, -wi.y) and (wo.x, wo.y), so that the mirror
/// direction has the light's coordinates; rank 3 is isotropic and has (1 - sin theta_i) / 2 and the square of wo
/// turned about the normal until -wi is above +x. Grey; exactly what Radiance's bsdf_t.c looks up.
struct TensorTree {
  /// A branch of 2^rank nodes, links[first + k], k with bit i set in the upper half of axis i; or 2^(rank log2) values
  /// from values[first], axis 0 slowest.
  struct Node {
    int log2 = -1;  ///< of the values along an axis; -1 for a branch
    std::uint32_t first = 0;
  };

  int rank = 4;
  std::vector<Node> nodes;  ///< node 0 is the root
  std::vector<std::uint32_t> links;
  std::vector<float> values;  ///< 1/sr

  std::size_t channels() const noexcept { return 1; }
  bool isotropic() const noexcept { return rank == 3; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
  bool eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
};

static_assert(HasRawValues<TensorTree>);

/// Every cube; of rank 3 without those beyond (1 - sin theta_i) / 2 = 1/2, which stand for nothing.
std::vector<TreeLeaf> leaves(const TensorTree& tree);

/// The directions at a leaf's centre, above the horizon.
DirectionPair leaf_directions(const TensorTree& tree, const TreeLeaf& leaf) noexcept;

/// A leaf's share of the products of projected solid angles, up to one factor for all leaves of a tree.
double leaf_weight(const TensorTree& tree, const TreeLeaf& leaf) noexcept;

/// A tree of rank 4 from a grey source at the centres of 2^depth cells along each axis; cubes whose values differ by
/// at most `tolerance` times the largest become one, their mean. Zero where the source knows nothing.
/// Precondition: depth in [1, 6], one channel.
TensorTree tabulate_tree(BrdfRef source, int depth, double tolerance);

}  // namespace burnish
