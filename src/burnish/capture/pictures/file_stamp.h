// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>

#include <fmt/format.h>

namespace burnish {

/// Returns the size and last write time of a file, or "missing". The text changes when the file is replaced.
inline std::string file_stamp(const std::filesystem::path& path) {
  std::error_code no_size, no_time;
  const std::uintmax_t size = std::filesystem::file_size(path, no_size);
  const auto time = std::filesystem::last_write_time(path, no_time);
  if (no_size || no_time) return "missing";
  return fmt::format("{} {}", size, static_cast<std::int64_t>(time.time_since_epoch().count()));
}

}  // namespace burnish
