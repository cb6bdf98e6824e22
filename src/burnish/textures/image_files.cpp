#include <cmath>
#include <vector>

#include <Imath/half.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/image/png.h>
#include <burnish/textures/image_files.h>

namespace burnish {

namespace {

void check_channels(const Table& table) {
  if (table.channels != 1 && table.channels != 3)
    throw Error(fmt::format("image: expected a table of 1 or 3 channels, found {}", table.channels));
}

template <class T>
std::string encode(const Table& table, Imf::PixelType type) {
  std::vector<T> pixels(table.values.begin(), table.values.end());
  Imf::Header header(table.layout.width, table.layout.rows());
  Imf::FrameBuffer frame;
  const auto channels = table.channels;
  for (std::size_t c = 0; c < channels; ++c) {
    const char* name = channels == 1 ? "Y" : c == 0 ? "R" : c == 1 ? "G" : "B";
    header.channels().insert(name, Imf::Channel(type));
    frame.insert(name, Imf::Slice(type, reinterpret_cast<char*>(pixels.data() + c), channels * sizeof(T),
                                  channels * sizeof(T) * static_cast<std::size_t>(table.layout.width)));
  }
  Imf::StdOSStream stream;
  {
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(table.layout.rows());
  }
  return stream.str();
}

}  // namespace

std::string encode_exr(const Table& table) {
  check_channels(table);
  const bool halves = table.format == TableFormat::half || table.format == TableFormat::rgb9e5;
  return halves ? encode<half>(table, Imf::HALF) : encode<float>(table, Imf::FLOAT);
}

std::string encode_png_table(const Table& table) {
  check_channels(table);
  Image8 image(table.layout.width, table.layout.rows(), 3);
  const std::size_t step = table.channels == 1 ? 1 : 3;
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<std::uint8_t>(std::lround(255 * table.values[step == 1 ? i / 3 : i]));
  return encode_png(image);
}

}  // namespace burnish
