// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/table_format.h>
#include <burnish/math/closest_name.h>
#include <burnish/math/half.h>

namespace burnish {

namespace {

static_assert(std::endian::native == std::endian::little, "packed tables are little-endian");

constexpr std::array<std::string_view, 4> kNames{"half", "float", "rgb9e5", "unorm8"};

std::uint16_t to_half(float value) noexcept {
  const auto bits = Imath::half(std::min(value, 65504.0f)).bits();
  return std::max<std::uint16_t>(bits, 1);  // the smallest subnormal, as values stay positive
}

float from_half(std::uint16_t bits) noexcept {
  Imath::half value;
  value.setBits(bits);
  return value;
}

std::uint8_t to_unorm8(float value) noexcept {
  return static_cast<std::uint8_t>(std::clamp(std::lround(255.0 * std::min(value, 1.0f)), 1l, 255l));
}

float from_unorm8(std::uint8_t byte) noexcept {
  return static_cast<float>(byte) / 255.0f;
}

// Names of [EXT_texture_shared_exponent]: mantissas of N bits, exponents of bias B, the largest exponent E.
constexpr int kMantissaBits = 9, kExponentBias = 15, kMaxExponent = 31;
constexpr int kMantissaMask = (1 << kMantissaBits) - 1;

// Returns the value of one mantissa step.
float step_of(int exponent) noexcept {
  return std::ldexp(1.0f, exponent - kExponentBias - kMantissaBits);
}

std::uint32_t to_rgb9e5(const float* rgb) noexcept {
  // The shared exponent is the smallest that holds the largest channel, also after rounding.
  const float most = static_cast<float>(kMantissaMask) * step_of(kMaxExponent);
  const float largest = std::min(std::max({rgb[0], rgb[1], rgb[2]}), most);
  int exponent = std::max(-kExponentBias - 1, std::ilogb(largest)) + 1 + kExponentBias;
  if (std::lround(largest / step_of(exponent)) > kMantissaMask) ++exponent;
  auto packed = static_cast<std::uint32_t>(exponent) << (3 * kMantissaBits);
  for (int c = 0; c < 3; ++c) {
    // Mantissas are at least 1, as values stay positive.
    const long mantissa = std::clamp(std::lround(std::min(rgb[c], most) / step_of(exponent)), 1l,
                                     static_cast<long>(kMantissaMask));
    packed |= static_cast<std::uint32_t>(mantissa) << (c * kMantissaBits);
  }
  return packed;
}

void from_rgb9e5(std::uint32_t packed, float* rgb) noexcept {
  const float step = step_of(static_cast<int>(packed >> (3 * kMantissaBits)));
  for (int c = 0; c < 3; ++c)
    rgb[c] = step * static_cast<float>((packed >> (c * kMantissaBits)) & kMantissaMask);
}

template <class Word, class Encode>
std::vector<std::byte> encode_all(std::span<const float> values, std::size_t step, const Encode& encode) {
  std::vector<std::byte> bytes(values.size() / step * sizeof(Word));
  for (std::size_t i = 0; i < values.size() / step; ++i) {
    const Word word = encode(values.data() + i * step);
    std::memcpy(bytes.data() + i * sizeof(Word), &word, sizeof(Word));
  }
  return bytes;
}

template <class Word, class Decode>
std::vector<float> decode_all(std::span<const std::byte> bytes, std::size_t step, const Decode& decode) {
  std::vector<float> values(bytes.size() / sizeof(Word) * step);
  for (std::size_t i = 0; i < bytes.size() / sizeof(Word); ++i) {
    Word word;
    std::memcpy(&word, bytes.data() + i * sizeof(Word), sizeof(Word));
    decode(word, values.data() + i * step);
  }
  return values;
}

}  // namespace

std::string_view to_string(TableFormat format) noexcept {
  return kNames[static_cast<std::size_t>(format)];
}

std::optional<TableFormat> find_table_format(std::string_view name) noexcept {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<TableFormat>(found - kNames.begin());
}

TableFormat parse_table_format(std::string_view name) {
  if (const auto format = find_table_format(name)) return *format;
  throw Error("table format: " + expected_one_of(kNames, name));
}

bool holds_channels(TableFormat format, std::size_t channels) noexcept {
  return format != TableFormat::rgb9e5 || channels == 3;
}

std::size_t texel_bytes(TableFormat format, std::size_t channels) noexcept {
  assert(holds_channels(format, channels));
  if (format == TableFormat::rgb9e5) return 4;
  const std::size_t value = format == TableFormat::unorm8 ? 1 : format == TableFormat::half ? 2 : 4;
  return value * channels;
}

std::vector<std::byte> pack(TableFormat format, [[maybe_unused]] std::size_t channels,
                            std::span<const float> values) {
  assert(holds_channels(format, channels) && values.size() % channels == 0);
  switch (format) {
    case TableFormat::half:
      return encode_all<std::uint16_t>(values, 1, [](const float* v) { return to_half(*v); });
    case TableFormat::rgb9e5:
      return encode_all<std::uint32_t>(values, 3, to_rgb9e5);
    case TableFormat::unorm8:
      return encode_all<std::uint8_t>(values, 1, [](const float* v) { return to_unorm8(*v); });
    case TableFormat::single:
      break;
  }
  return encode_all<float>(values, 1, [](const float* v) { return *v; });
}

std::vector<float> unpack(TableFormat format, [[maybe_unused]] std::size_t channels,
                          std::span<const std::byte> bytes) {
  assert(bytes.size() % texel_bytes(format, channels) == 0);
  switch (format) {
    case TableFormat::half:
      return decode_all<std::uint16_t>(bytes, 1, [](std::uint16_t h, float* v) { *v = from_half(h); });
    case TableFormat::rgb9e5:
      return decode_all<std::uint32_t>(bytes, 3, from_rgb9e5);
    case TableFormat::unorm8:
      return decode_all<std::uint8_t>(bytes, 1, [](std::uint8_t b, float* v) { *v = from_unorm8(b); });
    case TableFormat::single:
      break;
  }
  return decode_all<float>(bytes, 1, [](float f, float* v) { *v = f; });
}

std::vector<float> round_to_format(TableFormat format, std::size_t channels, std::span<const float> values) {
  return unpack(format, channels, pack(format, channels, values));
}

}  // namespace burnish
