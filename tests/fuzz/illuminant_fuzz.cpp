// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <burnish/io/illuminant.h>

#include "fuzz_reader.h"

// Checks that a light gives finite weights at any wavelengths, and that they sum to white.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return burnish::fuzz(data, size, [](const burnish::FileBytes& file, const burnish::OpenOptions&) {
    const burnish::Illuminant light = burnish::parse_illuminant(file);
    std::array<double, 3> sum{};
    for (const std::array<double, 3>& weights :
         burnish::rec709_weights(std::array{400.0, 450.5, 550.0, 700.0}, light))
      for (std::size_t c = 0; c < 3; ++c) sum[c] += weights[c];
    for (const double channel : sum)
      if (!(std::abs(channel - 1) < 1e-6)) __builtin_trap();
  });
}
