// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <burnish/reflectance/patch_table.h>
#include <burnish/reflectance/tensor_tree.h>

namespace burnish {

/// Two shares of the light from one direction that add up to the albedo.
struct LightShares {
  double direct = 0;     ///< goes into the mirror direction, or straight on, as narrowly as a patch
  double scattered = 0;  ///< goes anywhere else
};

/// Returns the shares of light from wi, of one channel, which are exact sums over patches. The patch in the mirror
/// direction holds direct light if its value is more than twice that of every patch around it. The direct share is then
/// its excess over the largest of them.
LightShares light_shares(const PatchTable& table, Vec3 wi, std::size_t channel = 0) noexcept;

/// Returns the same of a tree. A cone of 5 degrees around the mirror direction stands in place of the patch. Directions
/// 10 degrees from its axis stand in place of the patches around. Trees of up to 7 halvings are summed exactly.
LightShares light_shares(const TensorTree& tree, Vec3 wi) noexcept;

}  // namespace burnish
