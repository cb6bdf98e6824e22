// SPDX-License-Identifier: Apache-2.0
#include <burnish/capture/pictures/capture.h>

#include "fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return burnish::fuzz(data, size, [](const burnish::FileBytes& file, const burnish::OpenOptions&) {
    const burnish::CaptureForm form = burnish::parse_capture(file);
    // A parsed capture can be written, and reads back equal.
    const std::string again = burnish::format_capture(form);
    const auto* bytes = reinterpret_cast<const std::byte*>(again.data());
    const burnish::CaptureForm second =
        burnish::parse_capture({"written file", {bytes, bytes + again.size()}});
    if (second.pictures.size() != form.pictures.size() || second.width != form.width) __builtin_trap();
    for (std::size_t p = 0; p < form.pictures.size(); ++p) {
      const burnish::Vec3 light = second.pictures[p].light.seen_from(second.point(0, 0));
      if (!(std::abs(burnish::length(light) - 1) < 1e-9) || !(light.z > 0)) __builtin_trap();
      if (second.pictures[p].file != form.pictures[p].file) __builtin_trap();
    }
  });
}
