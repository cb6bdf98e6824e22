// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <burnish/io/csv.h>

#include "fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return burnish::fuzz(data, size, [](const burnish::FileBytes& file, const burnish::OpenOptions& options) {
    if (!burnish::looks_like_texel_csv(file.text())) {
      burnish::check(burnish::parse_csv(file, options).samples);
      return;
    }
    constexpr int kMost = 99;
    const burnish::TexelCsv read = burnish::parse_texel_csv(file, kMost);
    if (read.pairs.size() != read.texels.size() || read.f.size() != read.texels.size()) __builtin_trap();
    if (!read.held_out.empty() && read.held_out.size() != read.texels.size()) __builtin_trap();
    for (std::size_t i = 0; i < read.texels.size(); ++i) {
      for (const int place : read.texels[i])
        if (place < 0 || place > kMost) __builtin_trap();
      for (const float value : read.f[i])
        if (!std::isfinite(value)) __builtin_trap();
      if (!(read.pairs[i].wi.z > 0 && read.pairs[i].wo.z > 0)) __builtin_trap();
    }
  });
}
