// Files that a page is given: a small valid one of every format, and pictures of light in every compression of OpenEXR
// that the studio reads. For tests/web/studio.mjs.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <fmt/format.h>

#include <burnish/book/book_file.h>
#include <burnish/error.h>
#include <burnish/testing/books.h>
#include <burnish/testing/np_model.h>
#include <burnish/testing/seed_files.h>
#include <burnish/testing/surfaces.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

// Light that differs at every pixel, halves in red and floats in blue; sides that no block divides.
void write_picture(const fs::path& file, Imf::Compression compression) {
  constexpr int kWidth = 801, kHeight = 45;
  Imf::Header header(kWidth, kHeight);
  header.compression() = compression;
  for (const auto& [name, type] :
       {std::pair("R", Imf::HALF), std::pair("G", Imf::HALF), std::pair("B", Imf::FLOAT)})
    header.channels().insert(name, Imf::Channel(type));
  std::vector<half> red, green;
  std::vector<float> blue;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      red.emplace_back(0.25f * static_cast<float>(x % 75));
      green.emplace_back(static_cast<float>(std::exp(0.1 * y)));
      blue.push_back(static_cast<float>(1 + std::sin(0.3 * x * y)));
    }
  Imf::FrameBuffer frame;
  frame.insert("R", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(red.data()), 2, 2 * kWidth));
  frame.insert("G", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(green.data()), 2, 2 * kWidth));
  frame.insert("B", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(blue.data()), 4, 4 * kWidth));
  Imf::OutputFile output(file.c_str(), header);
  output.setFrameBuffer(frame);
  output.writePixels(kHeight);
}

// A surface without frames, and what it reflects straight back at the place and level of a pixel: of one seen and lit
// from the front, 8 x 8 pixels, the one right of and below the middle.
void write_flat(const fs::path& folder) {
  const SpatialBrdf framed = random_surface(32, 16);
  const SpatialBrdf flat(framed.lobes(), {.weights = framed.maps().weights, .normals = {}, .tangents = {}});
  write(folder / "flat.burnish", format_surface({.brdf = flat, .notes = "{}"}));
  std::vector<double> f(flat.channels());
  flat.eval(4.5 / 8, 4.5 / 8, 2, {0, 0, 1}, {0, 0, 1}, f);
  write(folder / "flat.txt", fmt::format("{:.9g}", f[0]));
}

// A code of Neural Processes beside a decoder, as the command line takes them.
void write_np(const fs::path& folder) {
  fs::create_directories(folder);
  write(folder / "codes.csv", seeds::kNpCode);
  const std::vector<float> weights = random_np_weights(1);
  write(folder / "decoder.f32", {reinterpret_cast<const char*>(weights.data()), NpDecoder::bytes()});
}

void write_all(const fs::path& folder) {
  fs::create_directories(folder);
  for (const auto& [name, bytes] : seeds::all_seeds()) write(folder / ("seed." + name), bytes);
  write(folder / "seed.book", format_book(random_book()));
  write_np(folder / "np");
  write(folder / "seed.surface", seeds::surface_seed());
  write(folder / "wall.burnish", format_surface({.brdf = random_surface(32, 16), .notes = "{}"}));
  write_flat(folder);
  using Pair = std::pair<const char*, Imf::Compression>;
  for (const auto& [name, compression] :
       {Pair("none", Imf::NO_COMPRESSION), Pair("rle", Imf::RLE_COMPRESSION),
        Pair("zips", Imf::ZIPS_COMPRESSION), Pair("zip", Imf::ZIP_COMPRESSION),
        Pair("piz", Imf::PIZ_COMPRESSION), Pair("b44", Imf::B44_COMPRESSION)})
    write_picture(folder / fmt::format("light-{}.exr", name), compression);
}

}  // namespace
}  // namespace burnish

int main(int count, char** arguments) {
  try {
    if (count != 2) throw burnish::Error("expected FOLDER");
    burnish::write_all(arguments[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "burnish_input_files: {}\n", error.what());
    return 1;
  }
}
