// SPDX-License-Identifier: Apache-2.0
#include <burnish/factors/compact_file.h>

#include "fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return burnish::fuzz(data, size, [](const burnish::FileBytes& file, const burnish::OpenOptions&) {
    const burnish::Model model = burnish::parse_compact(file);
    burnish::check_values(model.brdf);
    // A parsed model can be written, and reads back equal.
    const std::string again = burnish::format_compact(model, burnish::CompactContent::model_and_notes);
    const auto* bytes = reinterpret_cast<const std::byte*>(again.data());
    if (burnish::parse_compact({"written file", {bytes, bytes + again.size()}}) != model) __builtin_trap();
  });
}
