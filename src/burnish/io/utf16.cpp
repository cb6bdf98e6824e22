// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>

#include <burnish/io/utf16.h>

namespace burnish {

namespace {

void append_utf8(std::vector<std::byte>& bytes, std::uint32_t character) {
  const auto put = [&](std::uint32_t byte) { bytes.push_back(static_cast<std::byte>(byte)); };
  const auto rest = [&](int shift) { put(0x80 | (character >> shift & 0x3f)); };
  if (character < 0x80) {
    put(character);
  } else if (character < 0x800) {
    put(0xc0 | character >> 6);
    rest(0);
  } else if (character < 0x10000) {
    put(0xe0 | character >> 12);
    rest(6);
    rest(0);
  } else {
    put(0xf0 | character >> 18);
    rest(12);
    rest(6);
    rest(0);
  }
}

}  // namespace

std::optional<FileBytes> from_utf16(const FileBytes& file) {
  const std::vector<std::byte>& bytes = file.bytes;
  if (bytes.size() < 4 || bytes.size() % 2 != 0) return std::nullopt;
  const auto at = [&](std::size_t i) { return std::to_integer<std::uint32_t>(bytes[i]); };
  const bool little = at(0) == 0xff && at(1) == 0xfe, big = at(0) == 0xfe && at(1) == 0xff;
  if (!little && !big) return std::nullopt;
  const auto unit = [&](std::size_t i) { return little ? at(i) | at(i + 1) << 8 : at(i) << 8 | at(i + 1); };

  FileBytes text{.name = file.name, .bytes = {}};
  text.bytes.reserve(bytes.size() / 2);
  for (std::size_t i = 2; i < bytes.size(); i += 2) {
    std::uint32_t character = unit(i);
    if (character >= 0xd800 && character < 0xe000) {
      // The upper half of a pair comes first, then the lower.
      if (character >= 0xdc00 || i + 2 == bytes.size()) return std::nullopt;
      const std::uint32_t lower = unit(i += 2);
      if (lower < 0xdc00 || lower >= 0xe000) return std::nullopt;
      character = 0x10000 + ((character - 0xd800) << 10 | (lower - 0xdc00));
    }
    if (character == 0) return std::nullopt;
    append_utf8(text.bytes, character);
  }
  return text;
}

}  // namespace burnish
