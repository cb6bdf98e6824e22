// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <burnish/io/np.h>

#include "fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto decoder =
      std::make_shared<const burnish::NpDecoder>(std::vector<float>(burnish::NpDecoder::kWeights, 0.01f));
  return burnish::fuzz(data, size, [](const burnish::FileBytes& file, const burnish::OpenOptions&) {
    burnish::check_values(burnish::parse_np(file, file.bytes.size() % 2 == 0 ? "" : "seed", decoder).brdf);
  });
}
