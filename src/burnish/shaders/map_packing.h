// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <burnish/image/block_compression.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// Maps of a surface side by side: what a texture unit reads at once. The surface repeats, and is read with linear
/// filters within a level and between levels.
struct MapTexture {
  std::string name;  ///< of the sampler
  int width = 0, height = 0;
  TableFormat format = TableFormat::unorm8;  ///< or half
  TexelBlocks blocks = TexelBlocks::none;
  double block_rms = 0;  ///< what blocks lose: the root of the mean square of level 0, of numbers up to 1
  /// [y][x][4], bytes or little-endian halves; or blocks of pairs. Components without a map are 0.
  std::vector<std::vector<std::byte>> levels;
};

/// The place of a map's channel: a texture and one of its four components.
struct MapComponent {
  std::size_t texture = 0, component = 0;
};

/// All maps of a surface: weights lobe by lobe, of coloured ones the channels one after the other, those of bytes
/// first; then normals and tangents. One texture holds four grey lobes.
struct PackedMaps {
  std::vector<MapTexture> textures;
  std::vector<std::array<MapComponent, kMaxMapChannels>> weights;  ///< [lobe][channel]; times the map's scale
  std::optional<std::array<MapComponent, 2>> normals, tangents;    ///< x and y
};

/// Textures NAME0, NAME1, ... Where `in_blocks` two channels a texture, in blocks of BC5 (image/block_compression.h): a
/// byte for two weights, a byte for a normal. Throws Error where weights of halves should be in blocks.
PackedMaps pack_maps(const SpatialBrdf& surface, const std::string& name, bool in_blocks = false);

}  // namespace burnish
