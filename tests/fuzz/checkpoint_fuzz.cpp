// SPDX-License-Identifier: Apache-2.0
#include <burnish/capture/ranks/fit_checkpoint.h>
#include <burnish/testing/checkpoints.h>

#include "fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return burnish::fuzz(data, size, [](const burnish::FileBytes& file, const burnish::OpenOptions&) {
    // A parsed checkpoint can be written, and reads back equal.
    const auto again = [](const std::string& text) {
      const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
      return burnish::FileBytes{"written file", {bytes, bytes + text.size()}};
    };
    if (const auto lobes = burnish::parse_lobes_checkpoint(file)) {
      const std::string text = burnish::format_checkpoint(*lobes);
      const auto second = burnish::parse_lobes_checkpoint(again(text));
      if (!second || burnish::format_checkpoint(*second) != text) __builtin_trap();
      return;
    }
    const std::string text =
        burnish::format_checkpoint(burnish::parse_checkpoint(file, burnish::kCheckpointWidth));
    if (burnish::format_checkpoint(burnish::parse_checkpoint(again(text), burnish::kCheckpointWidth)) != text)
      __builtin_trap();
  });
}
