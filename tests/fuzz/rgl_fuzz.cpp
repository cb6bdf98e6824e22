// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <vector>

#include <burnish/error.h>
#include <burnish/io/rgl.h>
#include <burnish/math/angles.h>

using namespace burnish;

// Checks that any bytes either throw Error or make a table with finite values that survives writing.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  const FileBytes file{"fuzz.bsdf", {bytes, bytes + size}};
  OpenOptions options;
  options.keep_spectral = size % 2 == 0;
  try {
    const RglTable table = parse_rgl(file, options).table;
    std::vector<double> f(table.channels());
    for (double theta : {0.0, 0.7, 1.5707})
      for (double phi : {-kPi, 0.1, 3.0}) {
        table.eval(spherical_direction(theta, phi), spherical_direction(0.5, 1), f);
        for (double value : f)
          if (!(value - value == 0)) __builtin_trap();
      }
    const std::string written = format_rgl(table);
    const auto* again = reinterpret_cast<const std::byte*>(written.data());
    parse_rgl({"again.bsdf", {again, again + written.size()}}, options);
  } catch (const Error&) {
  }
  return 0;
}
