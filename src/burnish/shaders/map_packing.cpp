// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include <burnish/error.h>
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

/// Puts channels of maps into textures, two into each, in blocks.
class PairPacker {
 public:
  explicit PairPacker(std::string name) : name_(std::move(name)) {}

  MapComponent add(const SurfaceMap& map, std::size_t channel) {
    waiting_.push_back({&map, channel});
    const MapComponent place{textures_.size(), waiting_.size() - 1};
    if (waiting_.size() == 2) flush();
    return place;
  }

  /// Ends the texture at hand: what comes next is of another one.
  void flush() {
    if (waiting_.empty()) return;
    const SurfaceMap& first = *waiting_.front().map;
    const bool has_sign = first.format() == TableFormat::half;
    MapTexture texture{.name = fmt::format("{}{}", name_, textures_.size()),
                       .width = first.width(),
                       .height = first.height(),
                       .format = first.format(),
                       .blocks = has_sign ? TexelBlocks::bc5_snorm : TexelBlocks::bc5_unorm,
                       .levels = {}};
    for (std::size_t l = 0; l < first.levels(); ++l) {
      const int width = first.level_width(l), height = first.level_height(l);
      std::vector<float> pairs;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          for (std::size_t c = 0; c < 2; ++c)
            pairs.push_back(c < waiting_.size() ? waiting_[c].value(x, y, l) : 0.0f);
      texture.levels.push_back(encode_bc5(width, height, pairs, has_sign));
      if (l == 0)
        texture.block_rms =
            rms(pairs, decode_bc5(width, height, texture.levels[0], has_sign), waiting_.size());
    }
    textures_.push_back(std::move(texture));
    waiting_.clear();
  }

  std::vector<MapTexture> take() && { return std::move(textures_); }

 private:
  /// Over the first channels of pairs.
  static double rms(std::span<const float> a, std::span<const float> b, std::size_t channels) noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (i % 2 >= channels) continue;
      const double off = static_cast<double>(a[i]) - static_cast<double>(b[i]);
      sum += off * off;
    }
    return std::sqrt(2 * sum / static_cast<double>(channels * a.size()));
  }

  struct Channel {
    const SurfaceMap* map;
    std::size_t channel;

    float value(int x, int y, std::size_t level) const noexcept {
      return map->texel(x, y, level)[channel] / map->scale();
    }
  };

  std::string name_;
  std::vector<MapTexture> textures_;
  std::vector<Channel> waiting_;  // of the texture at hand
};

PackedMaps pack_pairs(const SpatialBrdf& surface, const std::string& name) {
  const SurfaceMaps& maps = surface.maps();
  PackedMaps packed;
  PairPacker packer(name);
  for (const SurfaceMap& map : maps.weights) {
    if (map.format() != TableFormat::unorm8) throw Error("blocks: expected weights of bytes, found halves");
    auto& places = packed.weights.emplace_back();
    for (std::size_t c = 0; c < map.channels(); ++c) places[c] = packer.add(map, c);
  }
  packer.flush();
  for (const auto& [map, places] :
       {std::pair(&maps.normals, &packed.normals), {&maps.tangents, &packed.tangents}}) {
    if (!*map) continue;
    const MapComponent x = packer.add(**map, 0);
    *places = {x, packer.add(**map, 1)};
  }
  packed.textures = std::move(packer).take();
  return packed;
}

}  // namespace

PackedMaps pack_maps(const SpatialBrdf& surface, const std::string& name, bool in_blocks) {
  if (in_blocks) return pack_pairs(surface, name);
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
