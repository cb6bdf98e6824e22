// SPDX-License-Identifier: Apache-2.0
#include <burnish/io/lighttools.h>

#include "fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return burnish::fuzz(data, size, [](const burnish::FileBytes& file, const burnish::OpenOptions& options) {
    burnish::check(burnish::parse_lighttools(file, options).table);
  });
}
