// SPDX-License-Identifier: Apache-2.0
#include <burnish/io/utia.h>

#include "fuzz_reader.h"

// A table's fixed number of bytes is filled with the input, repeated.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kBytes = 3 * 288 * 288 * sizeof(double);
  if (size == 0) return 0;
  std::vector<std::uint8_t> whole(kBytes);
  for (std::size_t i = 0; i < kBytes; ++i) whole[i] = data[i % size];
  return burnish::fuzz(whole.data(), whole.size(),
                       [](const burnish::FileBytes& file, const burnish::OpenOptions&) {
                         burnish::check(burnish::parse_utia(file).table);
                       });
}
