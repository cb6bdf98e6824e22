// SPDX-License-Identifier: Apache-2.0
#include <burnish/io/csv.h>

#include "fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return burnish::fuzz(data, size, [](const burnish::FileBytes& file, const burnish::OpenOptions&) {
    for (const auto& [wi, wo] : burnish::parse_directions(file).pairs)
      if (!(std::abs(burnish::length(wi) - 1) < 1e-9 && std::abs(burnish::length(wo) - 1) < 1e-9))
        __builtin_trap();
  });
}
