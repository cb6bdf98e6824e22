// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/factors/cbor.h>
#include <burnish/math/half.h>

namespace burnish {

namespace {

// Major types and marks of an item's head [RFC8949, 3].
enum Major { kUnsigned, kNegative, kBytes, kText, kList, kMap, kTag, kOther };
constexpr int kOneByte = 24, kHalf = 25, kSingle = 26, kDouble = 27;  // 25, 26, 27: also 2, 4 and 8 bytes
constexpr std::uint64_t kDecimalFraction = 4;                         // [RFC8949, 3.4.4]
constexpr int kMaxDecimalExponent = 400;                              // of ten; doubles end before

// `value` in 2^width bytes, the highest first.
void append(std::string& bytes, std::uint64_t value, int width) {
  for (int shift = 8 * ((1 << width) - 1); shift >= 0; shift -= 8)
    bytes.push_back(static_cast<char>(value >> shift & 0xff));
}

char head_byte(int major, int info) {
  return static_cast<char>(major << 5 | info);
}

/// value = mantissa * 10^exponent, in the fewest digits that are read back as `value`.
struct Decimal {
  std::int64_t mantissa;
  int exponent;
};

Decimal decimal_of(double value) {
  std::array<char, 32> text;
  char* const end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::scientific).ptr;
  char* const mark = std::find(text.data(), end, 'e');
  int exponent = 0;
  std::from_chars(mark + (mark[1] == '+' ? 2 : 1), end, exponent);
  // digits after the point move it
  char* const point = std::find(text.data(), mark, '.');
  if (point != mark) exponent -= static_cast<int>(mark - point) - 1;
  char* const digits_end = std::remove(text.data(), mark, '.');
  std::int64_t mantissa = 0;
  std::from_chars(text.data(), digits_end, mantissa);
  return {mantissa, exponent};
}

}  // namespace

bool is_utf8(const std::string& text) {
  try {
    return !nlohmann::json(text).dump().empty();
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

void CborWriter::head(int major, std::uint64_t value) {
  if (value < kOneByte) {
    bytes_.push_back(head_byte(major, static_cast<int>(value)));
    return;
  }
  const int width = value >> 8 == 0 ? 0 : value >> 16 == 0 ? 1 : value >> 32 == 0 ? 2 : 3;
  bytes_.push_back(head_byte(major, kOneByte + width));
  append(bytes_, value, width);
}

void CborWriter::integer(std::int64_t value) {
  if (value < 0)
    head(kNegative, ~static_cast<std::uint64_t>(value));  // -1 - value
  else
    head(kUnsigned, static_cast<std::uint64_t>(value));
}

void CborWriter::text(std::string_view utf8) {
  head(kText, utf8.size());
  bytes_ += utf8;
}

void CborWriter::bytes(std::span<const std::byte> content) {
  head(kBytes, content.size());
  bytes_.append(reinterpret_cast<const char*>(content.data()), content.size());
}

void CborWriter::list(std::size_t count) {
  head(kList, count);
}

void CborWriter::tag(std::uint64_t number) {
  head(kTag, number);
}

void CborWriter::number(double value) {
  // three bytes: integers and halves
  constexpr double kShortInteger = 65536;
  if (value == std::trunc(value) && std::abs(value) < kShortInteger && !(value == 0 && std::signbit(value)))
    return integer(static_cast<std::int64_t>(value));
  const bool in_range = std::abs(value) <= std::numeric_limits<float>::max();
  const float single = in_range ? static_cast<float>(value) : 0;
  if (const Imath::half half(single); in_range && half == value) {
    bytes_.push_back(head_byte(kOther, kHalf));
    return append(bytes_, half.bits(), 1);
  }

  // four or more: 0.8 is a short decimal fraction, but no float
  CborWriter fraction;
  const Decimal decimal = decimal_of(value);
  fraction.tag(kDecimalFraction);
  fraction.list(2);
  fraction.integer(decimal.exponent);
  fraction.integer(decimal.mantissa);
  const bool is_single = in_range && single == value;
  if (fraction.bytes_.size() < 1 + (is_single ? sizeof(float) : sizeof(double))) {
    bytes_ += fraction.bytes_;
  } else if (is_single) {
    bytes_.push_back(head_byte(kOther, kSingle));
    append(bytes_, std::bit_cast<std::uint32_t>(single), 2);
  } else {
    bytes_.push_back(head_byte(kOther, kDouble));
    append(bytes_, std::bit_cast<std::uint64_t>(value), 3);
  }
}

void CborReader::fail(std::uint64_t offset, const std::string& expected, const std::string& found) const {
  throw Error(file_->name, offset, expected, found);
}

void CborReader::refuse(std::string_view what, const Head& found) const {
  const auto name = [&]() -> std::string {
    switch (found.major) {
      case kUnsigned:
        return fmt::format("the integer {}", found.value);
      case kNegative:
        return fmt::format("the integer -1 - {}", found.value);
      case kBytes:
        return fmt::format("a string of {} bytes", found.value);
      case kText:
        return fmt::format("a text of {} bytes", found.value);
      case kList:
        return fmt::format("a list of {}", found.value);
      case kMap:
        return fmt::format("a map of {}", found.value);
      case kTag:
        return fmt::format("the tag {}", found.value);
      default:
        return found.info >= kHalf ? "a floating-point number"
                                   : fmt::format("the simple value {}", found.value);
    }
  };
  fail(found.at, std::string(what), name());
}

std::span<const std::byte> CborReader::take(std::string_view what, std::uint64_t count) {
  if (count > remaining())
    fail(at_, fmt::format("{} bytes of {}", count, what),
         fmt::format("{} to the end of the file", remaining()));
  const auto bytes = std::span(file_->bytes).subspan(at_, count);
  at_ += count;
  return bytes;
}

CborReader::Head CborReader::head(std::string_view what) {
  if (remaining() == 0) fail(at_, std::string(what), "the end of the file");
  Head head{.at = at_};
  const auto first = std::to_integer<int>(take(what, 1)[0]);
  head.major = first >> 5;
  head.info = first & 31;
  head.value = static_cast<std::uint64_t>(head.info);
  if (head.info < kOneByte) return head;
  if (head.info > kDouble)
    fail(head.at, fmt::format("{} of definite length", what), fmt::format("the byte {:#04x}", first));
  head.value = 0;
  for (const std::byte byte : take(what, std::uint64_t{1} << (head.info - kOneByte)))
    head.value = head.value << 8 | std::to_integer<std::uint64_t>(byte);
  return head;
}

std::int64_t CborReader::integer(std::string_view what, std::int64_t least, std::int64_t most) {
  const Head found = head(fmt::format("{}, an integer", what));
  const bool whole = found.major == kUnsigned || found.major == kNegative;
  const bool fits = found.value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  const auto value = static_cast<std::int64_t>(found.major == kNegative ? ~found.value : found.value);
  if (!whole || !fits || value < least || value > most)
    refuse(fmt::format("{}, an integer from {} to {}", what, least, most), found);
  return value;
}

std::string CborReader::text(std::string_view what, std::size_t most) {
  const Head found = head(fmt::format("{}, a text", what));
  if (found.major != kText || found.value > most)
    refuse(fmt::format("{}, a text of at most {} bytes", what, most), found);
  const auto taken = take(what, found.value);
  std::string utf8(reinterpret_cast<const char*>(taken.data()), taken.size());
  if (!is_utf8(utf8)) fail(found.at, fmt::format("{} in UTF-8", what), "other bytes");
  return utf8;
}

std::span<const std::byte> CborReader::bytes(std::string_view what, std::uint64_t length) {
  const Head found = head(fmt::format("{}, a byte string", what));
  if (found.major != kBytes || found.value != length)
    refuse(fmt::format("{}, a string of {} bytes", what, length), found);
  return take(what, length);
}

std::size_t CborReader::list(std::string_view what, std::size_t least, std::size_t most) {
  const Head found = head(fmt::format("{}, a list", what));
  if (found.major != kList || found.value < least || found.value > most)
    refuse(fmt::format("{}, a list of {} to {} items", what, least, most), found);
  if (found.value > remaining())
    fail(found.at, fmt::format("{}, a list that the file's end leaves room for", what),
         fmt::format("one of {} items and {} bytes", found.value, remaining()));
  return static_cast<std::size_t>(found.value);
}

void CborReader::tag(std::string_view what, std::uint64_t number) {
  if (const Head found = head(what); found.major != kTag || found.value != number)
    refuse(fmt::format("{}, the tag {}", what, number), found);
}

double CborReader::number(std::string_view what) {
  const Head found = head(fmt::format("{}, a number", what));
  constexpr std::uint64_t kExact = std::uint64_t{1} << 53;
  if (found.major == kOther) return floating(what, found);
  if (found.major == kTag && found.value == kDecimalFraction) return decimal_fraction(what, found);
  if ((found.major != kUnsigned && found.major != kNegative) || found.value >= kExact)
    refuse(fmt::format("{}, a number that a double holds", what), found);
  const auto value = static_cast<double>(found.value);
  return found.major == kNegative ? -1 - value : value;
}

double CborReader::floating(std::string_view what, const Head& head) const {
  double value = 0;
  if (head.info == kHalf) {
    Imath::half half;
    half.setBits(static_cast<std::uint16_t>(head.value));
    value = half;
  } else if (head.info == kSingle) {
    value = std::bit_cast<float>(static_cast<std::uint32_t>(head.value));
  } else if (head.info == kDouble) {
    value = std::bit_cast<double>(head.value);
  } else {
    refuse(fmt::format("{}, a number", what), head);
  }
  if (!std::isfinite(value))
    fail(head.at, fmt::format("{}, a finite number", what), fmt::format("{}", value));
  return value;
}

double CborReader::decimal_fraction(std::string_view what, const Head& head) {
  list(fmt::format("the decimal fraction of {}", what), 2, 2);
  const auto exponent = integer("an exponent of ten", -kMaxDecimalExponent, kMaxDecimalExponent);
  const auto mantissa = integer("the digits of a decimal fraction", std::numeric_limits<std::int64_t>::min(),
                                std::numeric_limits<std::int64_t>::max());
  const std::string text = fmt::format("{}e{}", mantissa, exponent);
  double value = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc{})
    fail(head.at, fmt::format("{}, a number that a double holds", what), text);
  return value;
}

bool CborReader::list_is_next() const noexcept {
  return remaining() > 0 && std::to_integer<int>(file_->bytes[at_]) >> 5 == kList;
}

void CborReader::end() const {
  if (remaining() > 0) fail(at_, "the end of the file", fmt::format("{} more bytes", remaining()));
}

}  // namespace burnish
