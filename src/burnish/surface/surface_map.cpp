// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/half.h>
#include <burnish/surface/surface_map.h>

namespace burnish {

namespace {

constexpr float kMaxHalf = 65504;
constexpr float kCodes = 255;

std::size_t texels(int width, int height) noexcept {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

}  // namespace

template <class Use>
auto SurfaceMap::with_reader(const Level& from, const Use& use) const noexcept {
  const std::byte* const bytes = from.bytes.data();
  if (format_ == TableFormat::half)
    return use([bytes](std::size_t i) {
      std::uint16_t bits;
      std::memcpy(&bits, bytes + 2 * i, sizeof(bits));
      return static_cast<float>(Imath::half(Imath::half::FromBits, bits));
    });
  return use([bytes, unit = scale_ / kCodes](std::size_t i) { return static_cast<float>(bytes[i]) * unit; });
}

void SurfaceMap::check() const {
  if (width_ < 1 || height_ < 1 || width_ > kMaxMapSide || height_ > kMaxMapSide)
    throw Error(fmt::format("surface map: expected sides of 1 to {} texels, found {} x {}", kMaxMapSide,
                            width_, height_));
  if (channels_ < 1 || channels_ > kMaxMapChannels)
    throw Error(fmt::format("surface map: expected 1 to {} channels, found {}", kMaxMapChannels, channels_));
  if (format_ != TableFormat::unorm8 && format_ != TableFormat::half)
    throw Error(fmt::format("surface map: expected format unorm8 or half, found {}", to_string(format_)));
  if (!(scale_ > 0) || !std::isnormal(scale_))  // a code's share of less would not be told from the next's
    throw Error(fmt::format("surface map: expected a finite scale of at least {}, found {}",
                            std::numeric_limits<float>::min(), scale_));
}

void SurfaceMap::check_values(std::span<const float> values) const {
  const bool half = format_ == TableFormat::half;
  const float least = half ? -kMaxHalf : 0, most = half ? kMaxHalf : scale_;
  for (const float value : values)
    if (!(value >= least && value <= most))
      throw Error(fmt::format("surface map: expected values from {} to {}, found {}", least, most, value));
}

SurfaceMap::SurfaceMap(int width, int height, std::size_t channels, TableFormat format, float scale,
                       std::span<const float> values)
    : width_(width),
      height_(height),
      channels_(channels),
      format_(format),
      scale_(format == TableFormat::half ? 1 : scale) {
  check();
  if (values.size() != texels(width, height) * channels)
    throw Error(fmt::format("surface map: expected {} values, found {}", texels(width, height) * channels,
                            values.size()));
  check_values(values);
  levels_.push_back(stored(width, height, values));
  make_levels();
}

SurfaceMap::SurfaceMap(int width, int height, std::size_t channels, TableFormat format, float scale,
                       std::span<const std::byte> bytes)
    : width_(width), height_(height), channels_(channels), format_(format), scale_(scale) {
  check();
  const std::size_t expected = texels(width, height) * texel_bytes();
  if (bytes.size() != expected)
    throw Error(fmt::format("surface map: expected {} bytes, found {}", expected, bytes.size()));
  if (format == TableFormat::half) {
    if (scale != 1) throw Error(fmt::format("surface map: expected halves of scale 1, found {}", scale));
    constexpr std::uint16_t kExponent = 0x7c00;
    for (std::size_t i = 0; i < bytes.size(); i += 2) {
      std::uint16_t bits;
      std::memcpy(&bits, &bytes[i], sizeof(bits));
      if ((bits & kExponent) == kExponent) throw Error("surface map: expected finite halves, found others");
    }
  }
  levels_.push_back({width, height, {bytes.begin(), bytes.end()}});
  make_levels();
}

SurfaceMap::Level SurfaceMap::stored(int width, int height, std::span<const float> values) const {
  Level level{width, height, std::vector<std::byte>(values.size() * burnish::texel_bytes(format_, 1))};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (format_ == TableFormat::half) {
      const std::uint16_t bits = Imath::half(values[i]).bits();
      std::memcpy(&level.bytes[2 * i], &bits, sizeof(bits));
    } else {
      const float code = std::min(std::round(values[i] / scale_ * kCodes), kCodes);
      level.bytes[i] = static_cast<std::byte>(code);
    }
  }
  return level;
}

void SurfaceMap::make_levels() {
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const int from_width = levels_.back().width, from_height = levels_.back().height;
    const int width = std::max(1, from_width / 2), height = std::max(1, from_height / 2);
    const std::size_t from = levels_.size() - 1;
    std::vector<float> values(texels(width, height) * channels_);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const auto [x0, x1] = covered_texels(x, width, from_width);
        const auto [y0, y1] = covered_texels(y, height, from_height);
        float* const to = &values[(texels(width, y) + static_cast<std::size_t>(x)) * channels_];
        std::array<double, kMaxMapChannels> sum{};
        for (int j = y0; j < y1; ++j)
          for (int i = x0; i < x1; ++i) {
            const Value value = texel(i, j, from);
            for (std::size_t c = 0; c < channels_; ++c) sum[c] += static_cast<double>(value[c]);
          }
        for (std::size_t c = 0; c < channels_; ++c)
          to[c] = static_cast<float>(sum[c] / ((x1 - x0) * (y1 - y0)));
      }
    levels_.push_back(stored(width, height, values));
  }
}

SurfaceMap SurfaceMap::with_coarse_levels(std::span<const std::vector<float>> values) const {
  if (values.size() + 1 != levels_.size())
    throw Error(fmt::format("surface map: expected values of {} levels, found {}", levels_.size() - 1,
                            values.size()));
  SurfaceMap map = *this;
  for (std::size_t l = 0; l < values.size(); ++l) {
    const int width = level_width(l + 1), height = level_height(l + 1);
    if (values[l].size() != texels(width, height) * channels_)
      throw Error(fmt::format("surface map: expected {} values of a level, found {}",
                              texels(width, height) * channels_, values[l].size()));
    check_values(values[l]);
    map.levels_[l + 1] = stored(width, height, values[l]);
  }
  return map;
}

SurfaceMap::Value SurfaceMap::texel(int x, int y, std::size_t level) const noexcept {
  const Level& from = levels_[level];
  const std::size_t first = (texels(from.width, y) + static_cast<std::size_t>(x)) * channels_;
  return with_reader(from, [&](const auto& read) {
    Value value{};
    for (std::size_t c = 0; c < channels_; ++c) value[c] = read(first + c);
    return value;
  });
}

CoveredTexels covered_texels(int i, int count, int from_count) noexcept {
  const int first = std::min(2 * i, from_count - 1);
  return {first, i + 1 == count ? from_count : std::min(2 * i + 2, from_count)};
}

SurfaceMap::Place SurfaceMap::place(double u, double v, double lod) const noexcept {
  struct Along {
    std::size_t low, high;
    float fraction;
  };
  const double column = u - std::floor(u), row = v - std::floor(v);
  const auto along = [](double coordinate, int side) {
    const double at = coordinate * side - 0.5, first = std::floor(at);
    const int low = static_cast<int>(first), high = low + 1 == side ? 0 : low + 1;
    return Along{static_cast<std::size_t>(low < 0 ? side - 1 : low), static_cast<std::size_t>(high),
                 static_cast<float>(at - first)};
  };
  const auto of_level = [&](std::size_t number) {
    const Level& level = levels_[number];
    const Along x = along(column, level.width), y = along(row, level.height);
    const std::size_t upper = texels(level.width, 1) * y.low, lower = texels(level.width, 1) * y.high;
    return Place::OfLevel{.level = number,
                          .texels = {upper + x.low, upper + x.high, lower + x.low, lower + x.high},
                          .x = x.fraction,
                          .y = y.fraction};
  };
  const double most = static_cast<double>(levels() - 1), at = lod > 0 ? std::min(lod, most) : 0;
  const auto level = static_cast<std::size_t>(at);
  Place place{.levels = {of_level(level)}, .fraction = static_cast<float>(at - static_cast<double>(level))};
  if (place.fraction != 0) place.levels[1] = of_level(level + 1);
  return place;
}

SurfaceMap::Place SurfaceMap::place_of_texel(int x, int y) const noexcept {
  const std::size_t texel = texels(width_, y) + static_cast<std::size_t>(x);
  return {.levels = {Place::OfLevel{.level = 0, .texels = {texel, texel, texel, texel}, .x = 0, .y = 0}},
          .fraction = 0};
}

SurfaceMap::Value SurfaceMap::bilinear(const Place::OfLevel& place) const noexcept {
  return with_reader(levels_[place.level], [&](const auto& read) {
    Value value{};
    const bool one_texel = place.x == 0 && place.y == 0;
    for (std::size_t c = 0; c < channels_; ++c) {
      const auto at = [&](std::size_t k) { return read(place.texels[k] * channels_ + c); };
      const float a = at(0);
      value[c] = a;
      if (one_texel) continue;
      const float low = a + place.x * (at(1) - a), next = at(2), high = next + place.x * (at(3) - next);
      value[c] = low + place.y * (high - low);
    }
    return value;
  });
}

SurfaceMap::Value SurfaceMap::sample(const Place& place) const noexcept {
  Value value = bilinear(place.levels[0]);
  if (place.fraction == 0) return value;
  const Value next = bilinear(place.levels[1]);
  for (std::size_t c = 0; c < channels_; ++c) value[c] += place.fraction * (next[c] - value[c]);
  return value;
}

SurfaceMap::Value SurfaceMap::sample(double u, double v, double lod) const noexcept {
  return sample(place(u, v, lod));
}

}  // namespace burnish
