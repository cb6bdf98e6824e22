// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace burnish {

/// The parts that the library is built of, and the machine that it runs on.
struct BuildInfo {
  std::vector<std::string>
      instruction_sets;  ///< that kernels are compiled for and this processor has, the best first
  unsigned threads = 1;  ///< that work is spread over
  std::vector<std::pair<std::string, std::string>> libraries;  ///< names and versions they were compiled with
};

BuildInfo build_info();

}  // namespace burnish
