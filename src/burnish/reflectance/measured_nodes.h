// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <burnish/reflectance/angle_table.h>
#include <burnish/reflectance/half_diff_table.h>
#include <burnish/reflectance/patch_table.h>
#include <burnish/reflectance/rgl_table.h>
#include <burnish/reflectance/samples.h>
#include <burnish/reflectance/tensor_tree.h>

namespace burnish {

/// The values that an instrument measured, before any interpolation: the entries of a table at their own directions,
/// or the samples of a scattered set. Both directions of every node lie above the horizon.
struct MeasuredNodes {
  Samples samples;              ///< f_r in 1/sr as stored, negative values kept
  std::vector<double> weights;  ///< one a node, > 0: 1, or of patches how much of both hemispheres they are
  /// One a node. Nodes that are one measurement have one number: of an RGL table mirror twins, which it stores both;
  /// of other sources what rotation about the normal, reflection (both if isotropic) and exchange of the directions
  /// lead to one another. Whoever holds nodes out holds all of a group out.
  std::vector<std::uint32_t> groups;
  /// One a node, 0 or 1: a checkerboard over the rows and columns of an RGL slice, in which mirror twins fall
  /// together; of other sources a coin for each group.
  std::vector<std::uint8_t> half;
  /// One a node: which of theta_i it was measured at.
  std::vector<std::uint32_t> incidence;
  std::vector<double> theta_i;  ///< the distinct incident polar angles, increasing, radians

  std::size_t size() const noexcept { return samples.size(); }
  std::uint32_t group_count() const noexcept;
};

/// The nodes of spectra that were measured at their directions through the warp by visible normals, and what eval
/// returns there: spectra ndf / (4 sigma cos theta_o). Nodes that `valid` says were filled in are left out, unless it
/// says so of most. Where rows meet (phi of -pi and pi, the normal) several nodes have one direction and values of
/// their own. A checkerboard half is made by (column + row counted from the nearer end of the rows) mod 2.
/// [Dupuy 2018, sec. 4]
MeasuredNodes measured_nodes(const RglTable& table);
/// The entries at the centres of their cells that are no holes, phi_h = 0.
MeasuredNodes measured_nodes(const HalfDiffTable& table);
/// The entries at their nodes that are no holes.
MeasuredNodes measured_nodes(const AngleTable& table);
/// The pairs of patches at the patches' centres, weighted by the product of both projected solid angles, the
/// mean weight 1.
MeasuredNodes measured_nodes(const PatchTable& table);
/// The cubes at their centres, weighted by the products of projected solid angles, the mean weight 1.
MeasuredNodes measured_nodes(const TensorTree& table);
/// The samples themselves that lie above the horizon; the numbers of groups do not depend on their order.
MeasuredNodes measured_nodes(const Samples& samples);

/// Returns true if rotation about the normal, reflection (both of isotropic sources) and exchange of the directions
/// lead from one pair to the other, to within 1e-6 of the directions' components.
bool are_one_measurement(const DirectionPair& a, const DirectionPair& b, bool isotropic) noexcept;

/// The number of nodes that measured_nodes returns, and of their distinct theta_i.
struct NodeCount {
  std::size_t nodes = 0;
  std::size_t incidences = 0;
};

/// The same as measured_nodes would say, in the memory of the angles alone: tables have millions of nodes.
NodeCount count_nodes(const RglTable& table);
NodeCount count_nodes(const HalfDiffTable& table);
NodeCount count_nodes(const AngleTable& table);
NodeCount count_nodes(const PatchTable& table);
NodeCount count_nodes(const TensorTree& table);
NodeCount count_nodes(const Samples& samples);

/// The chosen nodes in the order given; groups, incidences and theta_i keep their meaning.
/// Precondition: indices below nodes.size().
MeasuredNodes select(const MeasuredNodes& nodes, std::span<const std::size_t> subset);

/// Part of a source's nodes: one half, or one incidence.
struct NodePart {
  enum class Kind { half, incidence };

  Kind kind = Kind::half;
  std::uint32_t number = 1;  ///< what `half` or `incidence` of the node is

  bool holds(const MeasuredNodes& nodes, std::size_t node) const noexcept {
    return (kind == Kind::half ? nodes.half[node] : nodes.incidence[node]) == number;
  }
};

/// Reads "half=0", "half=1" or "theta_i=K", K counted from 0. Throws Error on anything else.
NodePart parse_node_part(std::string_view text);

/// The nodes of the part, or all others. Throws Error where that leaves none.
MeasuredNodes nodes_of(const MeasuredNodes& nodes, const NodePart& part);
MeasuredNodes nodes_without(const MeasuredNodes& nodes, const NodePart& part);

}  // namespace burnish
