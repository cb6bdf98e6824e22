// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <burnish/factors/table_format.h>

namespace burnish {

/// The most channels of a map.
inline constexpr std::size_t kMaxMapChannels = 3;
/// The longest side of a map, in texels.
inline constexpr int kMaxMapSide = 16'384;

/// A picture of numbers over a surface, rows from v = 0 on, channels side by side, with its mip levels: unorm8 or
/// half. Level l + 1 has half the texels of level l along each side, rounded down, at least one, each the mean of
/// what it covers, rounded to the format. The surface repeats: u and v may be any number.
class SurfaceMap {
 public:
  SurfaceMap() = default;
  /// The map that holds `values`, width * height * channels of them, [row][column][channel], to the nearest. unorm8
  /// stores code / 255 times `scale`, for values in [0, scale]; half ignores the scale. Throws Error for other
  /// formats, sides out of [1, kMaxMapSide], channels out of [1, 3], values not finite or too large for the format,
  /// of unorm8 below 0.
  SurfaceMap(int width, int height, std::size_t channels, TableFormat format, float scale,
             std::span<const float> values);
  /// The map that these bytes are: of level 0, as stored_bytes() gives them. Throws Error likewise.
  SurfaceMap(int width, int height, std::size_t channels, TableFormat format, float scale,
             std::span<const std::byte> bytes);

  /// The same map with other values in the levels from 1 on, as many as it has, to the nearest. Throws Error for
  /// other counts, and values as the constructor does.
  SurfaceMap with_coarse_levels(std::span<const std::vector<float>> values) const;

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  std::size_t channels() const noexcept { return channels_; }
  TableFormat format() const noexcept { return format_; }
  float scale() const noexcept { return scale_; }
  /// Level 0 is the map itself, the last one texel.
  std::size_t levels() const noexcept { return levels_.size(); }
  int level_width(std::size_t level) const noexcept { return levels_[level].width; }
  int level_height(std::size_t level) const noexcept { return levels_[level].height; }

  /// Bytes of a texel as stored.
  std::size_t texel_bytes() const noexcept { return burnish::texel_bytes(format_, channels_); }
  /// A level, row by row: bytes, or halves in little-endian order.
  std::span<const std::byte> stored_bytes(std::size_t level = 0) const noexcept {
    return levels_[level].bytes;
  }

  using Value = std::array<float, kMaxMapChannels>;  ///< channels that the map has not are 0
  /// Returns the value of one texel. Precondition: it is within the level.
  Value texel(int x, int y, std::size_t level = 0) const noexcept;

  /// Which texels a place lies between, and where: the same of all maps of one size.
  struct Place {
    struct OfLevel {
      std::size_t level;
      std::array<std::size_t, 4> texels;  ///< row by row, those of two rows
      float x, y;                         ///< how far from the first to the others
    };
    std::array<OfLevel, 2> levels;
    float fraction;  ///< from the first level to the second; 0: the second is not read
  };
  /// Returns the place of finite u and v, as sample() takes them.
  Place place(double u, double v, double lod = 0) const noexcept;
  /// Returns the place of one texel of level 0, unfiltered. Precondition: it is within the map.
  Place place_of_texel(int x, int y) const noexcept;
  /// sample() at a place of this map or another of its size.
  Value sample(const Place& place) const noexcept;
  /// At (u, v), texel centres at (x + 1/2) / width: bilinear within a level, linear between levels `lod` lies
  /// between, as a texture unit filters. lod is clamped to the levels. Weights of texels are rounded to floats.
  Value sample(double u, double v, double lod = 0) const noexcept;

  friend bool operator==(const SurfaceMap&, const SurfaceMap&) = default;

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<std::byte> bytes;
    friend bool operator==(const Level&, const Level&) = default;
  };
  void check() const;
  void check_values(std::span<const float> values) const;
  void make_levels();
  Level stored(int width, int height, std::span<const float> values) const;
  /// use(read), read(i) the i-th number of a level.
  template <class Use>
  auto with_reader(const Level& from, const Use& use) const noexcept;
  Value bilinear(const Place::OfLevel& place) const noexcept;

  int width_ = 0, height_ = 0;
  std::size_t channels_ = 0;
  TableFormat format_ = TableFormat::unorm8;
  float scale_ = 1;
  std::vector<Level> levels_;
};

/// The texels of the level before, `from_count` long, that texel i of `count` along a side covers: the first and the
/// one behind the last. On odd sides the last texel covers three.
struct CoveredTexels {
  int begin, end;
};
CoveredTexels covered_texels(int i, int count, int from_count) noexcept;

}  // namespace burnish
