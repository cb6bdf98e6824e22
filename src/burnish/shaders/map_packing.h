#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// Maps of a surface side by side: what a texture unit reads at once. The surface repeats, and is read with linear
/// filters within a level and between levels.
struct MapTexture {
  std::string name;  ///< of the sampler
  int width = 0, height = 0;
  TableFormat format = TableFormat::unorm8;  ///< or half
  std::vector<std::vector<std::byte>>
      levels;  ///< [y][x][4], bytes or little-endian halves; what no map has is 0
};

/// Where a map's channel is: a texture and one of its four components.
struct MapComponent {
  std::size_t texture = 0, component = 0;
};

/// All maps of a surface: weights lobe by lobe, of coloured ones the channels one after the other, those of bytes first;
/// then normals and tangents. One texture holds four grey lobes.
struct PackedMaps {
  std::vector<MapTexture> textures;
  std::vector<std::array<MapComponent, kMaxMapChannels>> weights;  ///< [lobe][channel]; times the map's scale
  std::optional<std::array<MapComponent, 2>> normals, tangents;    ///< x and y
};

/// Textures NAME0, NAME1, ...
PackedMaps pack_maps(const SpatialBrdf& surface, const std::string& name);

}  // namespace burnish
