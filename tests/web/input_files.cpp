// SPDX-License-Identifier: Apache-2.0
// Writes the files that a page opens in tests/web/studio.mjs. They are a small valid one of every format, and pictures
// of light in every OpenEXR compression that the studio reads. Beside each picture stands OpenEXR's reading of it.

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
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>
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

// A picture of three channels: halves in red and green, floats in blue.
struct Picture {
  static constexpr int kWidth = 801, kHeight = 45;  // sides that no block divides

  std::vector<half> red, green;
  std::vector<float> blue;

  Picture() : red(kWidth * kHeight), green(kWidth * kHeight), blue(kWidth * kHeight) {}

  Imf::FrameBuffer frame() {
    Imf::FrameBuffer slices;
    slices.insert("R", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(red.data()), 2, 2 * kWidth));
    slices.insert("G", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(green.data()), 2, 2 * kWidth));
    slices.insert("B", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(blue.data()), 4, 4 * kWidth));
    return slices;
  }
};

Imf::Header header_of(Imf::Compression compression) {
  Imf::Header header(Picture::kWidth, Picture::kHeight);
  header.compression() = compression;
  for (const auto& [name, type] :
       {std::pair("R", Imf::HALF), std::pair("G", Imf::HALF), std::pair("B", Imf::FLOAT)})
    header.channels().insert(name, Imf::Channel(type));
  return header;
}

// Returns light that differs at every pixel.
Picture light() {
  Picture picture;
  for (int y = 0, i = 0; y < Picture::kHeight; ++y)
    for (int x = 0; x < Picture::kWidth; ++x, ++i) {
      const auto at = static_cast<std::size_t>(i);
      picture.red[at] = half(0.25f * static_cast<float>(x % 75));
      picture.green[at] = half(static_cast<float>(std::exp(0.1 * y)));
      picture.blue[at] = static_cast<float>(1 + std::sin(0.3 * x * y));
    }
  return picture;
}

void write_lines(const fs::path& file, Picture picture, Imf::Compression compression) {
  Imf::OutputFile output(file.c_str(), header_of(compression));
  output.setFrameBuffer(picture.frame());
  output.writePixels(Picture::kHeight);
}

void write_tiles(const fs::path& file, Picture picture, Imf::Compression compression, Imf::LevelMode levels) {
  Imf::Header header = header_of(compression);
  header.setTileDescription(Imf::TileDescription(64, 32, levels));
  Imf::TiledOutputFile output(file.c_str(), header);
  output.setFrameBuffer(picture.frame());
  // Smaller levels hold the picture's corner; the studio shows the largest level.
  for (int y = 0; y < output.numYLevels(); ++y)
    for (int x = 0; x < output.numXLevels(); ++x)
      if (levels == Imf::RIPMAP_LEVELS || x == y)
        output.writeTiles(0, output.numXTiles(x) - 1, 0, output.numYTiles(y) - 1, x, y);
}

// Writes OpenEXR's reading of a file, without compression.
void write_read(const fs::path& from, const fs::path& to) {
  Picture picture;
  Imf::InputFile input(from.c_str());
  input.setFrameBuffer(picture.frame());
  input.readPixels(0, Picture::kHeight - 1);
  write_lines(to, std::move(picture), Imf::NO_COMPRESSION);
}

void write_pictures(const fs::path& folder) {
  using Pair = std::pair<const char*, Imf::Compression>;
  std::vector<std::string> names;
  const auto at = [&](std::string_view name) {
    return folder / fmt::format("light-{}.exr", names.emplace_back(name));
  };
  for (const auto& [name, compression] :
       {Pair("none", Imf::NO_COMPRESSION), Pair("rle", Imf::RLE_COMPRESSION),
        Pair("zips", Imf::ZIPS_COMPRESSION), Pair("zip", Imf::ZIP_COMPRESSION),
        Pair("piz", Imf::PIZ_COMPRESSION), Pair("pxr24", Imf::PXR24_COMPRESSION),
        Pair("b44", Imf::B44_COMPRESSION), Pair("b44a", Imf::B44A_COMPRESSION),
        Pair("dwaa", Imf::DWAA_COMPRESSION), Pair("dwab", Imf::DWAB_COMPRESSION)})
    write_lines(at(name), light(), compression);
  write_tiles(at("tiles"), light(), Imf::PIZ_COMPRESSION, Imf::ONE_LEVEL);
  write_tiles(at("mips"), light(), Imf::ZIP_COMPRESSION, Imf::MIPMAP_LEVELS);
  write_tiles(at("rips"), light(), Imf::B44_COMPRESSION, Imf::RIPMAP_LEVELS);
  for (const std::string& name : names)
    write_read(folder / fmt::format("light-{}.exr", name), folder / fmt::format("read-{}.exr", name));
}

// Writes a surface without frames, and its value for reflection straight back at one pixel's place and level. The
// surface is seen and lit from the front with 8 x 8 pixels. The pixel lies right of and below the middle.
void write_flat(const fs::path& folder) {
  const SpatialBrdf framed = random_surface(32, 16);
  const SpatialBrdf flat(framed.lobes(), {.weights = framed.maps().weights, .normals = {}, .tangents = {}});
  write(folder / "flat.burnish", format_surface({.brdf = flat, .notes = "{}"}));
  std::vector<double> f(flat.channels());
  flat.eval(4.5 / 8, 4.5 / 8, 2, {0, 0, 1}, {0, 0, 1}, f);
  write(folder / "flat.txt", fmt::format("{:.9g}", f[0]));
}

// Writes a code of Neural Processes beside a decoder, as the command line reads them.
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
  write_pictures(folder);
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
