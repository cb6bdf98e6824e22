// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/shaders/shader.h>

namespace burnish {

/// Layers of a 3-D texture that volumes share with something else, behind it.
struct LayersBefore {
  std::string name;  ///< of the texture
  int width = 0, height = 0, depth = 0;
  std::size_t channels = 3;  ///< the least that the texture has
};

/// The tables of a model in two textures at most: `NAME_tables`, 2-D, with every line a row and disks and
/// grids beside and above each other, and `NAME_volumes`, 3-D, with volumes behind each other. Around each
/// table, up to the next one or the texture's edge, its own outermost texels are repeated, so that a filtered
/// read of it takes none of another; a texture with lines in rows is 2^n rows high, so that a row's middle is
/// a coordinate without rounding. Channels are those of the widest table (others have theirs repeated), the
/// format is the tables' or, of tables in several, half or else single. Values are multiplied by
/// 2^table_exponents (half_range.h). With `before` the 3-D texture has its name, and the volumes stand behind its
/// layers and one more, whose values are left 0. Throws Error for sides above 16384.
std::vector<ShaderTexture> pack_tables(const FactoredBrdf& brdf, const std::string& name,
                                       const LayersBefore* before = nullptr);

/// Every table in a texture of its own, texel (x, z * height + y) node (x, y, z): what arrays hold.
std::vector<ShaderTexture> tables_apart(const FactoredBrdf& brdf, const std::string& name);

}  // namespace burnish
