// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/image/block_compression.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

constexpr int kSide = 4;
constexpr std::size_t kTexels = 16, kCodes = 8, kChannelBytes = 8, kBlockBytes = 16;

using Values = std::array<float, kTexels>;

/// The values that the codes of a block stand for, in steps of its integers.
class Palette {
 public:
  Palette(int first, int second, bool has_sign) : first_(first), second_(second) {
    const auto a = static_cast<float>(first), b = static_cast<float>(second);
    steps_[0] = a;
    steps_[1] = b;
    const std::size_t mixtures = first > second ? 6 : 4;
    for (std::size_t k = 1; k <= mixtures; ++k) {
      const float share = static_cast<float>(k) / static_cast<float>(mixtures + 1);
      steps_[k + 1] = a + share * (b - a);
    }
    if (mixtures == 6) return;
    steps_[6] = has_sign ? -127.0f : 0.0f;
    steps_[7] = has_sign ? 127.0f : 255.0f;
  }

  int first() const noexcept { return first_; }
  int second() const noexcept { return second_; }
  float operator[](std::size_t code) const noexcept { return steps_[code]; }
  /// Returns the share of `second` in a code; nothing for codes that have a value of their own.
  float share(std::size_t code) const noexcept {
    if (code < 2) return static_cast<float>(code);
    return static_cast<float>(code - 1) / (first_ > second_ ? 7.0f : 5.0f);
  }
  bool is_mixture(std::size_t code) const noexcept { return first_ > second_ || code < 6; }

 private:
  int first_, second_;
  std::array<float, kCodes> steps_;
};

/// The codes that are nearest to values, in steps, and their squared error.
struct Coded {
  std::array<std::size_t, kTexels> codes;
  float error;
};
Coded nearest(const Values& values, const Palette& palette) noexcept {
  Coded coded{.codes = {}, .error = 0};
  for (std::size_t i = 0; i < kTexels; ++i) {
    float least = INFINITY;
    for (std::size_t k = 0; k < kCodes; ++k)
      if (const float off = values[i] - palette[k]; off * off < least) {
        least = off * off;
        coded.codes[i] = k;
      }
    coded.error += least;
  }
  return coded;
}

/// The best of the palettes that were tried.
class Search {
 public:
  Search(const Values& values, bool has_sign) noexcept
      : values_(values), has_sign_(has_sign), most_(has_sign ? 127 : 255), least_(has_sign ? -127 : 0) {}

  /// From both ends of the values between `low` and `high`, in the order that makes all codes mixtures or not.
  void run(bool all_mixtures, float low, float high) noexcept {
    if (low > high) low = high = 0;  // none lies between
    const auto down = static_cast<int>(std::floor(low)), up = static_cast<int>(std::ceil(high));
    all_mixtures_ = all_mixtures;
    Palette at = ordered(down, up);
    Coded coded = nearest(values_, at);
    // ends that are least squares for the codes, then steps of one
    for (int turn = 0; turn < 4; ++turn)
      if (!improve(at, coded, refined(at, coded))) break;
    for (bool better = true; better;) {
      better = false;
      for (const auto& [first, second] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}})
        better = improve(at, coded, ordered(at.first() + first, at.second() + second)) || better;
    }
    if (coded.error < best_.error) {
      best_ = coded;
      first_ = at.first();
      second_ = at.second();
    }
  }

  std::array<std::byte, kChannelBytes> bytes() const noexcept {
    std::uint64_t bits = static_cast<std::uint8_t>(first_) | std::uint64_t{static_cast<std::uint8_t>(second_)}
                                                                 << 8U;
    for (std::size_t i = 0; i < kTexels; ++i) bits |= std::uint64_t{best_.codes[i]} << (16 + 3 * i);
    std::array<std::byte, kChannelBytes> bytes;
    for (std::size_t i = 0; i < kChannelBytes; ++i) bytes[i] = static_cast<std::byte>(bits >> (8 * i));
    return bytes;
  }

 private:
  Palette ordered(int a, int b) const noexcept {
    a = std::clamp(a, least_, most_);
    b = std::clamp(b, least_, most_);
    if ((a > b) != all_mixtures_) std::swap(a, b);
    return {a, b, has_sign_};
  }

  bool improve(Palette& at, Coded& coded, const Palette& other) const noexcept {
    if ((other.first() > other.second()) != all_mixtures_) return false;  // both ends alike
    const Coded found = nearest(values_, other);
    if (!(found.error < coded.error)) return false;
    at = other;
    coded = found;
    return true;
  }

  Palette refined(const Palette& at, const Coded& coded) const noexcept {
    float aa = 0, ab = 0, bb = 0, av = 0, bv = 0;
    for (std::size_t i = 0; i < kTexels; ++i) {
      if (!at.is_mixture(coded.codes[i])) continue;
      const float b = at.share(coded.codes[i]), a = 1 - b;
      aa += a * a;
      ab += a * b;
      bb += b * b;
      av += a * values_[i];
      bv += b * values_[i];
    }
    const float determinant = aa * bb - ab * ab;
    if (!(determinant > 1e-6f)) return at;
    return ordered(static_cast<int>(std::lround((av * bb - bv * ab) / determinant)),
                   static_cast<int>(std::lround((bv * aa - av * ab) / determinant)));
  }

  const Values& values_;
  bool has_sign_, all_mixtures_ = true;
  int most_, least_, first_ = 0, second_ = 0;
  Coded best_{.codes = {}, .error = INFINITY};
};

std::array<std::byte, kChannelBytes> encode_channel(const Values& values, bool has_sign) noexcept {
  const float most = has_sign ? 127 : 255, least = has_sign ? -127 : 0;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  Search search(values, has_sign);
  search.run(true, *low, *high);
  float inner_low = INFINITY, inner_high = -INFINITY;
  for (const float value : values)
    if (value > least && value < most) {
      inner_low = std::min(inner_low, value);
      inner_high = std::max(inner_high, value);
    }
  search.run(false, inner_low, inner_high);
  return search.bytes();
}

Values decode_channel(std::span<const std::byte> bytes, bool has_sign) noexcept {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < kChannelBytes; ++i) bits |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
  const auto end = [&](unsigned shift) {
    const auto raw = static_cast<std::uint8_t>(bits >> shift);
    return has_sign ? std::max<int>(static_cast<std::int8_t>(raw), -127) : int{raw};  // -128 stands for -127
  };
  const Palette palette(end(0), end(8), has_sign);
  Values values;
  for (std::size_t i = 0; i < kTexels; ++i)
    values[i] = palette[bits >> (16 + 3 * i) & 7U] / (has_sign ? 127.0f : 255.0f);
  return values;
}

std::size_t blocks_along(int side) noexcept {
  return static_cast<std::size_t>((side + kSide - 1) / kSide);
}

std::size_t texels_of(int width, int height) noexcept {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

/// The texel of a picture that texel i of a block is; at edges the last there is.
std::size_t texel_at(std::size_t block_x, std::size_t block_y, std::size_t i, int width,
                     int height) noexcept {
  const std::size_t x = std::min(block_x * kSide + i % kSide, static_cast<std::size_t>(width) - 1),
                    y = std::min(block_y * kSide + i / kSide, static_cast<std::size_t>(height) - 1);
  return y * static_cast<std::size_t>(width) + x;
}

}  // namespace

std::string_view to_string(TexelBlocks blocks) noexcept {
  if (blocks == TexelBlocks::none) return "none";
  return blocks == TexelBlocks::bc5_snorm ? "bc5_snorm" : "bc5_unorm";
}

std::vector<std::byte> encode_bc5(int width, int height, std::span<const float> pairs, bool has_sign) {
  if (width < 0 || height < 0)
    throw Error(fmt::format("BC5: expected sides of at least 0, found {} x {}", width, height));
  if (pairs.size() != 2 * texels_of(width, height))
    throw Error(
        fmt::format("BC5: expected {} numbers, found {}", 2 * texels_of(width, height), pairs.size()));
  const std::size_t across = blocks_along(width);
  const float steps = has_sign ? 127 : 255, least = has_sign ? -127 : 0;
  std::vector<std::byte> bytes(across * blocks_along(height) * kBlockBytes);
  for_each_chunk(blocks_along(height), 1, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (std::size_t column = 0; column < across; ++column)
        for (std::size_t c = 0; c < 2; ++c) {
          Values values;
          for (std::size_t i = 0; i < kTexels; ++i) {
            const float value = steps * pairs[2 * texel_at(column, row, i, width, height) + c];
            values[i] = std::isnan(value) ? 0 : std::clamp(value, least, steps);
          }
          const auto coded = encode_channel(values, has_sign);
          std::ranges::copy(coded, &bytes[(row * across + column) * kBlockBytes + c * kChannelBytes]);
        }
  });
  return bytes;
}

std::vector<float> decode_bc5(int width, int height, std::span<const std::byte> blocks, bool has_sign) {
  if (width < 0 || height < 0)
    throw Error(fmt::format("BC5: expected sides of at least 0, found {} x {}", width, height));
  const std::size_t across = blocks_along(width), count = across * blocks_along(height);
  if (blocks.size() != count * kBlockBytes)
    throw Error(fmt::format("BC5: expected {} bytes, found {}", count * kBlockBytes, blocks.size()));
  std::vector<float> pairs(2 * texels_of(width, height));
  for (std::size_t block = 0; block < count; ++block)
    for (std::size_t c = 0; c < 2; ++c) {
      const Values values =
          decode_channel(blocks.subspan(block * kBlockBytes + c * kChannelBytes, kChannelBytes), has_sign);
      for (std::size_t i = kTexels; i-- > 0;)  // what repeats an edge comes before the edge itself
        pairs[2 * texel_at(block % across, block / across, i, width, height) + c] = values[i];
    }
  return pairs;
}

}  // namespace burnish
