// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <burnish/io/byte_reader.h>

namespace burnish {

void ByteReader::seek(std::uint64_t offset) {
  if (offset > size())
    fail(fmt::format("an offset within {} bytes", size()), fmt::format("offset {}", offset));
  offset_ = offset;
}

void ByteReader::require(std::uint64_t count, const std::string& what) const {
  if (count > remaining())
    fail(fmt::format("{} bytes of {}", count, what), fmt::format("{} bytes to the end", remaining()));
}

std::span<const std::byte> ByteReader::take(std::uint64_t count, const std::string& what) {
  require(count, what);
  const auto part = std::span(file_->bytes).subspan(offset_, count);
  offset_ += count;
  return part;
}

}  // namespace burnish
