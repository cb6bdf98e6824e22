// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include <burnish/error.h>
#include <burnish/file.h>

namespace burnish {

/// Reads little-endian numbers front to back; every step is checked against the end of the file.
class ByteReader {
 public:
  explicit ByteReader(const FileBytes& file) noexcept : file_(&file) {}

  std::uint64_t offset() const noexcept { return offset_; }
  std::uint64_t size() const noexcept { return file_->bytes.size(); }
  std::uint64_t remaining() const noexcept { return size() - offset_; }

  /// Throws Error at the current offset: "expected E, found F".
  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    throw Error(file_->name, offset_, expected, found);
  }

  void seek(std::uint64_t offset);
  /// Throws unless `count` bytes remain.
  void require(std::uint64_t count, const std::string& what) const;
  std::span<const std::byte> take(std::uint64_t count, const std::string& what);

  template <class T>
  requires std::integral<T> || std::floating_point<T> T number(const std::string& what) {
    static_assert(std::endian::native == std::endian::little);
    T value;
    std::memcpy(&value, take(sizeof(T), what).data(), sizeof(T));
    return value;
  }

 private:
  const FileBytes* file_;
  std::uint64_t offset_ = 0;
};

}  // namespace burnish
