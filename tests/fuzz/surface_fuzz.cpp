// SPDX-License-Identifier: Apache-2.0
#include <burnish/surface/surface_file.h>

#include "fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return burnish::fuzz(data, size, [](const burnish::FileBytes& file, const burnish::OpenOptions&) {
    const burnish::SurfaceModel surface = burnish::parse_surface(file);
    burnish::check_values(surface.brdf.at(0.3, 0.7, 0.5));
    // A parsed surface can be written, and reads back equal.
    for (const std::string& again :
         {burnish::format_surface(surface), burnish::format_surface_exr(surface)}) {
      const auto* bytes = reinterpret_cast<const std::byte*>(again.data());
      try {
        if (burnish::parse_surface({"written file", {bytes, bytes + again.size()}}) != surface)
          __builtin_trap();
      } catch (const burnish::Error&) {
        __builtin_trap();
      }
    }
  });
}
