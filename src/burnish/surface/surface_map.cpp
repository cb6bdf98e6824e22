#include <algorithm>
#include <cmath>
#include <cstring>

#include <Imath/half.h>
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/surface/surface_map.h>

namespace burnish {

namespace {

constexpr float kMaxHalf = 65504;
constexpr float kCodes = 255;

std::size_t texels(int width, int height) noexcept {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

}  // namespace

void SurfaceMap::check() const {
  if (width_ < 1 || height_ < 1 || width_ > kMaxMapSide || height_ > kMaxMapSide)
    throw Error(fmt::format("surface map: expected sides of 1 to {} texels, found {} x {}", kMaxMapSide,
                            width_, height_));
  if (channels_ < 1 || channels_ > kMaxMapChannels)
    throw Error(fmt::format("surface map: expected 1 to {} channels, found {}", kMaxMapChannels, channels_));
  if (format_ != TableFormat::unorm8 && format_ != TableFormat::half)
    throw Error(fmt::format("surface map: expected format unorm8 or half, found {}", to_string(format_)));
  if (!(scale_ > 0) || !std::isfinite(scale_))
    throw Error(fmt::format("surface map: expected a finite scale > 0, found {}", scale_));
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
  Value value{};
  for (std::size_t c = 0; c < channels_; ++c) {
    if (format_ == TableFormat::half) {
      Imath::half half;
      std::uint16_t bits;
      std::memcpy(&bits, &from.bytes[2 * (first + c)], sizeof(bits));
      half.setBits(bits);
      value[c] = half;
    } else {
      value[c] = static_cast<float>(from.bytes[first + c]) * (scale_ / kCodes);
    }
  }
  return value;
}

CoveredTexels covered_texels(int i, int count, int from_count) noexcept {
  const int first = std::min(2 * i, from_count - 1);
  return {first, i + 1 == count ? from_count : std::min(2 * i + 2, from_count)};
}

SurfaceMap::Value SurfaceMap::bilinear(double u, double v, std::size_t level) const noexcept {
  const auto place = [](double coordinate, int side) {
    const double at = (coordinate - std::floor(coordinate)) * side - 0.5, first = std::floor(at);
    const int low = static_cast<int>(first);
    struct Place {
      int low, high;
      float fraction;
    };
    return Place{(low + side) % side, (low + 1) % side, static_cast<float>(at - first)};
  };
  const auto x = place(u, levels_[level].width), y = place(v, levels_[level].height);
  const Value a = texel(x.low, y.low, level), b = texel(x.high, y.low, level);
  const Value c = texel(x.low, y.high, level), d = texel(x.high, y.high, level);
  Value value{};
  for (std::size_t k = 0; k < channels_; ++k) {
    const float low = a[k] + x.fraction * (b[k] - a[k]), high = c[k] + x.fraction * (d[k] - c[k]);
    value[k] = low + y.fraction * (high - low);
  }
  return value;
}

SurfaceMap::Value SurfaceMap::sample(double u, double v, double lod) const noexcept {
  const double most = static_cast<double>(levels() - 1), at = lod > 0 ? std::min(lod, most) : 0;
  const auto level = static_cast<std::size_t>(at);
  const auto fraction = static_cast<float>(at - static_cast<double>(level));
  Value value = bilinear(u, v, level);
  if (fraction == 0) return value;
  const Value next = bilinear(u, v, level + 1);
  for (std::size_t c = 0; c < channels_; ++c) value[c] += fraction * (next[c] - value[c]);
  return value;
}

}  // namespace burnish
