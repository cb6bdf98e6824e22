// SPDX-License-Identifier: Apache-2.0
#include <burnish/baselines/baseline_file.h>

#include "fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return burnish::fuzz(data, size, [](const burnish::FileBytes& file, const burnish::OpenOptions&) {
    const burnish::Baseline baseline = burnish::parse_baseline(file);
    burnish::check_values(burnish::baseline_ref(baseline.brdf));
    // A parsed baseline can be written.
    burnish::format_baseline(baseline);
  });
}
