// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/srgb.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/render/picture.h>

namespace burnish {

namespace {

void require_rgb(const Image& image) {
  if (image.channels != 3) throw Error(fmt::format("picture: expected 3 channels, found {}", image.channels));
}

double filmic(double x) noexcept {  // [Narkowicz 2016]
  return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

}  // namespace

Image8 to_bytes(const Image& image, double exposure, Tone tone) {
  require_rgb(image);
  Image8 shown(image.width, image.height, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    double x = std::max(exposure * image.pixels[i], 0.0);
    if (tone == Tone::aces) x = filmic(std::min(x, 1e6));
    shown.pixels[i] = static_cast<std::uint8_t>(std::lround(255 * srgb_encoded(std::min(x, 1.0))));
  }
  return shown;
}

double automatic_exposure(const Image& image, Rgb background) {
  require_rgb(image);
  const std::array<float, 3> behind{static_cast<float>(background.r), static_cast<float>(background.g),
                                    static_cast<float>(background.b)};
  std::vector<float> values;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3)
    if (!std::equal(behind.begin(), behind.end(), &image.pixels[i]))
      values.insert(values.end(), &image.pixels[i], &image.pixels[i] + 3);
  const double white = values.empty() ? 0 : percentile(std::move(values), 0.97);
  return white > 0 ? 1 / white : 1;
}

std::string encode_exr(const Image& image) {
  require_rgb(image);
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer frame;
  constexpr std::size_t kPixel = 3 * sizeof(float);
  auto* base = const_cast<float*>(image.pixels.data());  // it is only read
  for (const char* name : {"R", "G", "B"}) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    frame.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(base++), kPixel,
                                  kPixel * static_cast<std::size_t>(image.width)));
  }
  Imf::StdOSStream stream;
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
  }
  return stream.str();
}

}  // namespace burnish
