// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <span>
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

void check_channels(std::size_t channels) {
  if (channels != 1 && channels != 3)
    throw Error(fmt::format("image: expected a table of 1 or 3 channels, found {}", channels));
}

template <class T>
std::string encode(std::span<const float> values, int width, int height, std::size_t channels,
                   Imf::PixelType type) {
  std::vector<T> pixels(values.begin(), values.end());
  Imf::Header header(width, height);
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < channels; ++c) {
    const char* name = channels == 1 ? "Y" : c == 0 ? "R" : c == 1 ? "G" : "B";
    header.channels().insert(name, Imf::Channel(type));
    frame.insert(name, Imf::Slice(type, reinterpret_cast<char*>(pixels.data() + c), channels * sizeof(T),
                                  channels * sizeof(T) * static_cast<std::size_t>(width)));
  }
  Imf::StdOSStream stream;
  {
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(height);
  }
  return stream.str();
}

std::string encode(std::span<const float> values, int width, int height, std::size_t channels,
                   TableFormat format) {
  check_channels(channels);
  return format == TableFormat::half || format == TableFormat::rgb9e5
             ? encode<half>(values, width, height, channels, Imf::HALF)
             : encode<float>(values, width, height, channels, Imf::FLOAT);
}

}  // namespace

std::string encode_exr(const Table& table) {
  return encode(table.values, table.layout.width, table.layout.rows(), table.channels, table.format);
}

std::string encode_exr(const Image& picture, TableFormat format) {
  return encode(picture.pixels, picture.width, picture.height, picture.channels, format);
}

std::string encode_png_table(const Table& table) {
  check_channels(table.channels);
  Image8 image(table.layout.width, table.layout.rows(), 3);
  const std::size_t step = table.channels == 1 ? 1 : 3;
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<std::uint8_t>(std::lround(255 * table.values[step == 1 ? i / 3 : i]));
  return encode_png(image, PngValues::linear);
}

}  // namespace burnish
