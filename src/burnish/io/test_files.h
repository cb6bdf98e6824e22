#pragma once

// Helpers of the readers' tests.

#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include <burnish/io/byte_reader.h>

namespace burnish {

/// A file in memory.
inline FileBytes memory_file(std::string_view content) {
  const auto* data = reinterpret_cast<const std::byte*>(content.data());
  return {"test.file", {data, data + content.size()}};
}

/// The message of the Error that `parse` throws; empty if it throws none.
template <class Parse>
std::string error_of(const Parse& parse) {
  try {
    parse();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// The folder of real measurements, empty where the environment names none.
inline std::filesystem::path data_folder() {
  const char* folder = std::getenv("BURNISH_DATA");
  return folder ? folder : "";
}

}  // namespace burnish

/// Skips the test where there are no real measurements.
#define BURNISH_NEEDS_DATA() \
  if (burnish::data_folder().empty()) GTEST_SKIP() << "BURNISH_DATA is not set"
