// SPDX-License-Identifier: Apache-2.0
#pragma once

// Helpers of the readers' tests.

#include <cstdlib>
#include <filesystem>

#include <burnish/testing/tools.h>

namespace burnish {

/// Returns the folder of real measurements, empty if BURNISH_DATA names none.
inline std::filesystem::path data_folder() {
  const char* folder = std::getenv("BURNISH_DATA");
  return folder ? folder : "";
}

}  // namespace burnish

/// Skips the test if there are no real measurements.
#define BURNISH_NEEDS_DATA() \
  if (burnish::data_folder().empty()) GTEST_SKIP() << "BURNISH_DATA is not set"
