#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/error.h>

namespace burnish {

/// The whole of a file in memory, with the name its errors carry.
struct FileBytes {
  std::string name;
  std::vector<std::byte> bytes;

  std::string_view text() const noexcept {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
};

/// Reads a regular file of at most `limit` bytes. Throws Error if it is missing, no regular file, empty or
/// larger.
FileBytes read_file(const std::filesystem::path& path, std::uint64_t limit = std::uint64_t{4} << 30);

/// Writes `bytes` under a temporary name and renames it to `path`, so that no failure leaves a partial file
/// behind. Throws Error if the folder cannot be written.
void write_then_rename(const std::filesystem::path& path, std::string_view bytes);

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
