// SPDX-License-Identifier: Apache-2.0
#include <variant>

#include <burnish/io/ssdd.h>

#include "fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return burnish::fuzz(data, size, [](const burnish::FileBytes& file, const burnish::OpenOptions& options) {
    std::visit([](const auto& brdf) { burnish::check(brdf); }, burnish::parse_ssdd(file, options).brdf);
  });
}
