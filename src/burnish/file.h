// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

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

/// Before long work: throws Error where write_then_rename would not write to `path`, whose folder there has to be.
/// Touches nothing.
void check_writable(const std::filesystem::path& path);

/// Writes `bytes` under a temporary name and renames it to `path`, so that no failure leaves a partial file
/// behind. Follows links. Throws Error if the folder cannot be written or the path is
/// a folder, device or pipe.
void write_then_rename(const std::filesystem::path& path, std::string_view bytes);

}  // namespace burnish
