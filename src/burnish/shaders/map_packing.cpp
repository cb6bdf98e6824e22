#include <algorithm>

#include <fmt/format.h>

#include <burnish/shaders/map_packing.h>

namespace burnish {

namespace {

constexpr std::size_t kComponents = 4;

/// Puts channels of maps into textures, four into each.
class MapPacker {
 public:
  explicit MapPacker(std::string name) : name_(std::move(name)) {}

  /// The next free components, of a new texture where none of this format is open.
  MapComponent add(const SurfaceMap& map, std::size_t channel) {
    if (textures_.empty() || used_ == kComponents || textures_.back().format != map.format()) begin(map);
    const MapComponent place{textures_.size() - 1, used_++};
    MapTexture& texture = textures_.back();
    const std::size_t bytes = texel_bytes(map.format(), 1);
    for (std::size_t l = 0; l < map.levels(); ++l) {
      const auto from = map.stored_bytes(l);
      for (std::size_t i = 0; i * kComponents * bytes < texture.levels[l].size(); ++i)
        std::copy_n(&from[(i * map.channels() + channel) * bytes], bytes,
                    &texture.levels[l][(i * kComponents + place.component) * bytes]);
    }
    return place;
  }

  std::vector<MapTexture> take() && { return std::move(textures_); }

 private:
  void begin(const SurfaceMap& map) {
    MapTexture texture{.name = fmt::format("{}{}", name_, textures_.size()),
                       .width = map.width(),
                       .height = map.height(),
                       .format = map.format(),
                       .levels = {}};
    for (std::size_t l = 0; l < map.levels(); ++l)
      texture.levels.emplace_back(map.stored_bytes(l).size() / map.channels() * kComponents);
    textures_.push_back(std::move(texture));
    used_ = 0;
  }

  std::string name_;
  std::vector<MapTexture> textures_;
  std::size_t used_ = 0;
};

}  // namespace

PackedMaps pack_maps(const SpatialBrdf& surface, const std::string& name) {
  const SurfaceMaps& maps = surface.maps();
  PackedMaps packed;
  packed.weights.resize(maps.weights.size());
  MapPacker packer(name);
  for (const TableFormat format : {TableFormat::unorm8, TableFormat::half})
    for (std::size_t j = 0; j < maps.weights.size(); ++j)
      for (std::size_t c = 0; c < maps.weights[j].channels() && maps.weights[j].format() == format; ++c)
        packed.weights[j][c] = packer.add(maps.weights[j], c);
  const auto vectors = [&](const std::optional<SurfaceMap>& map) {
    std::optional<std::array<MapComponent, 2>> places;
    if (map) {
      const MapComponent x = packer.add(*map, 0);
      places = {x, packer.add(*map, 1)};
    }
    return places;
  };
  packed.normals = vectors(maps.normals);
  packed.tangents = vectors(maps.tangents);
  packed.textures = std::move(packer).take();
  return packed;
}

}  // namespace burnish
