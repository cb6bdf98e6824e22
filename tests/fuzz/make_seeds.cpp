// SPDX-License-Identifier: Apache-2.0
// make_seeds DIR writes DIR/NAME/NAME, a small valid file for each fuzzed reader. It also writes all of them to
// DIR/source.
#include <filesystem>

#include <burnish/book/book_file.h>
#include <burnish/file.h>
#include <burnish/testing/books.h>
#include <burnish/testing/btf.h>
#include <burnish/testing/checkpoints.h>
#include <burnish/testing/seed_files.h>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto write = [&](const std::string& folder, const std::string& name, const std::string& bytes) {
    std::filesystem::create_directories(std::filesystem::path(argv[1]) / folder);
    burnish::write_then_rename(std::filesystem::path(argv[1]) / folder / name, bytes);
  };
  for (const auto& [name, bytes] : burnish::seeds::all_seeds()) {
    write(name, name, bytes);
    write("source", name, bytes);
  }
  for (const std::string folder : {"rgl", "source"})
    write(folder, "rgl-spectral", burnish::seeds::spectral_rgl_seed());
  for (const std::string folder : {"tensortree", "source"})
    write(folder, "tensortree4", burnish::seeds::kTensorTree4);
  write("illuminant", "illuminant", burnish::seeds::kIlluminant);
  write("surface", "surface", burnish::seeds::surface_seed());
  write("surface", "surface-exr", burnish::seeds::surface_exr_seed());
  write("checkpoint", "weights", burnish::format_checkpoint(burnish::some_checkpoint(true)));
  write("checkpoint", "lobes",
        burnish::format_checkpoint(
            burnish::LobesCheckpoint{.key = 7,
                                     .rounds = 2,
                                     .log_values = {{0.5, -1}, {2}},
                                     .fits = {.weights = {1, 0}, .normals = {}, .trust = {0.5f}},
                                     .normals_of_all = {0.1f, 0}}));
  write("book", "book", burnish::format_book(burnish::random_book()));
  write("capture", "capture", burnish::seeds::kCapture);
  write("csv", "texels", burnish::seeds::kTexelCsv);
  write("csv", "gonio", burnish::seeds::kGonioCsv);
  write("btf", "btf", burnish::btf_bytes(burnish::btf_content()));
  write("utia", "utia", burnish::seeds::kUtia);
  write("np", "np", burnish::seeds::kNpCode);
  write("directions", "directions", burnish::seeds::kDirections);
  return 0;
}
