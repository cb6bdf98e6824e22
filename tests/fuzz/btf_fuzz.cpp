// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include <unistd.h>

#include <burnish/capture/pictures/btf_file.h>

#include "fuzz_reader.h"

// The reader takes texels from a file on disk, so each input becomes a file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("burnish_btf_fuzz_" + std::to_string(getpid()));
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return burnish::fuzz(data, size, [](const burnish::FileBytes&, const burnish::OpenOptions&) {
    const burnish::BtfFile file(path);
    for (const burnish::Vec3 direction : file.lights())
      if (!(std::abs(burnish::length(direction) - 1) < 1e-6) || !(direction.z > 0)) __builtin_trap();
    const burnish::BtfFile::Rows rows = file.rows(file.height() - 1, 1);
    const burnish::Image picture = rows.picture(file.pictures() - 1);
    if (picture.pixels.size() != 3 * static_cast<std::size_t>(file.width())) __builtin_trap();
  });
}
