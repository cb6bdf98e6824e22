// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStdIO.h>
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/render/light/sky_image.h>

namespace burnish {

namespace {

constexpr int kWidest = 8192;
constexpr std::uint64_t kMaxCompressed = 4096;  // bytes of pixels a byte of the file

double sum_of(std::span<const float> rgb) noexcept {
  return static_cast<double>(rgb[0]) + rgb[1] + rgb[2];
}

}  // namespace

SkyImage::SkyImage(Image image) : image_(std::move(image)) {
  const auto& [width, height, channels, pixels] = image_;
  if (channels != 3 || width != 2 * height || height < 1)
    throw Error(
        fmt::format("environment: expected three channels, twice as wide as high, found {} of {} x {}",
                    channels, width, height));
  for (const float value : pixels)
    if (!(value >= 0 && std::isfinite(value)))
      throw Error(fmt::format("environment: expected finite values >= 0, found {}", value));
  // what a texel's neighbours send reaches into it
  until_.resize(pixels.size() / 3);
  double sum = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double light = 0;
      for (int k = 0; k < 9; ++k)
        light += sum_of(image_.at((x + k % 3 - 1 + width) % width, std::clamp(y + k / 3 - 1, 0, height - 1)));
      sum += light * solid_angle(y);
      until_[static_cast<std::size_t>(y * width + x)] = sum;
    }
  for (double& share : until_) share = sum > 0 ? share / sum : 0;
}

SkyImage::PicturePlace SkyImage::place_of(Vec3 w) const noexcept {
  const double phi = std::atan2(w.z, w.x), theta = std::acos(std::clamp(w.y, -1.0, 1.0));
  return {(phi / kTwoPi + 0.5) * image_.width, theta / kPi * image_.height};
}

Rgb SkyImage::radiance(Vec3 w) const noexcept {
  const auto [x, y] = place_of(w);
  const double left = std::floor(x - 0.5), top = std::floor(y - 0.5), fx = x - 0.5 - left, fy = y - 0.5 - top;
  Rgb sum;
  for (int k = 0; k < 4; ++k) {
    const int column = (static_cast<int>(left) + k % 2 + image_.width) % image_.width;
    const int row = std::clamp(static_cast<int>(top) + k / 2, 0, image_.height - 1);
    const auto texel = image_.at(column, row);
    sum = sum + Rgb((k % 2 ? fx : 1 - fx) * (k / 2 ? fy : 1 - fy)) * Rgb(texel[0], texel[1], texel[2]);
  }
  return sum;
}

Vec3 SkyImage::direction(double x, double y) const noexcept {
  const double phi = ((x + 0.5) / image_.width - 0.5) * kTwoPi, theta = (y + 0.5) / image_.height * kPi;
  return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
}

double SkyImage::solid_angle(int y) const noexcept {
  return kTwoPi / image_.width *
         (std::cos(kPi * y / image_.height) - std::cos(kPi * (y + 1) / image_.height));
}

DrawnDirection SkyImage::draw(Point2 u) const noexcept {
  if (until_.back() == 0) return {};
  // the texel whose share of the light holds u.x
  const auto texel = static_cast<int>(std::ranges::upper_bound(until_, u.x) - until_.begin());
  const int last = image_.width * image_.height - 1, at = std::min(texel, last);
  const double before = at > 0 ? until_[static_cast<std::size_t>(at) - 1] : 0,
               share = until_[static_cast<std::size_t>(at)] - before;
  if (!(share > 0)) return {};

  // a place in it, even over its solid angle: the rest of u.x along the row, u.y in the cosine
  const int x = at % image_.width, y = at / image_.width;
  const double fx = std::clamp((u.x - before) / share, 0.0, 1.0);
  const double high = std::cos(kPi * y / image_.height), low = std::cos(kPi * (y + 1) / image_.height);
  const double cosine = high + u.y * (low - high), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double phi = ((x + fx) / image_.width - 0.5) * kTwoPi;
  return {{sine * std::cos(phi), cosine, sine * std::sin(phi)}, share / solid_angle(y)};
}

double SkyImage::pdf(Vec3 w) const noexcept {
  const auto [x, y] = place_of(w);
  const int column = std::clamp(static_cast<int>(x), 0, image_.width - 1),
            row = std::clamp(static_cast<int>(y), 0, image_.height - 1);
  const auto at = static_cast<std::size_t>(row * image_.width + column);
  return (until_[at] - (at > 0 ? until_[at - 1] : 0)) / solid_angle(row);
}

Image smaller_sky(Image image, int width) {
  while (image.width > width && image.height % 2 == 0) {
    Image half(image.width / 2, image.height / 2, 3);
    for (int y = 0; y < half.height; ++y) {
      const double upper = std::sin(kPi * (2 * y + 0.5) / image.height),
                   lower = std::sin(kPi * (2 * y + 1.5) / image.height), share = 0.5 / (upper + lower);
      for (int x = 0; x < half.width; ++x)
        for (std::size_t c = 0; c < 3; ++c)
          half.at(x, y)[c] = static_cast<float>(
              share * (upper * (image.at(2 * x, 2 * y)[c] + image.at(2 * x + 1, 2 * y)[c]) +
                       lower * (image.at(2 * x, 2 * y + 1)[c] + image.at(2 * x + 1, 2 * y + 1)[c])));
    }
    image = std::move(half);
  }
  return image;
}

SkyImage parse_sky(const FileBytes& file) {
  try {
    const auto* bytes = reinterpret_cast<const char*>(file.bytes.data());
    Imf::StdISStream stream;
    stream.str(std::string(bytes, file.bytes.size()));
    Imf::InputFile input(stream, 1);

    // a size that fits a picture of all directions and the bytes there are
    const Imath::Box2i window = input.header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1,
                       height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width != 2 * height || width > kWidest)
      throw Error::in_file(
          file.name,
          fmt::format("a picture of all directions, twice as wide as high, at most {} wide", kWidest),
          fmt::format("{} x {}", width, height));
    const auto stored = static_cast<std::uint64_t>(width * height) * 3 * sizeof(std::uint16_t);
    if (stored / kMaxCompressed > file.bytes.size())
      throw Error::in_file(file.name, fmt::format("data of {} x {} pixels", width, height),
                           fmt::format("{} bytes", file.bytes.size()));

    // three full channels
    for (const char* name : {"R", "G", "B"}) {
      const Imf::Channel* channel = input.header().channels().findChannel(name);
      if (!channel || channel->xSampling != 1 || channel->ySampling != 1)
        throw Error::in_file(file.name, fmt::format("a full channel {}", name), "none");
    }

    // read side by side
    Image image(static_cast<int>(width), static_cast<int>(height), 3);
    Imf::FrameBuffer frame;
    constexpr std::size_t kPixel = 3 * sizeof(float);
    const std::size_t row = kPixel * static_cast<std::size_t>(width);
    float* base = image.pixels.data();
    for (const char* name : {"R", "G", "B"})
      frame.insert(name, Imf::Slice::Make(Imf::FLOAT, base++, window, kPixel, row));
    input.setFrameBuffer(frame);
    input.readPixels(window.min.y, window.max.y);
    for (float& value : image.pixels) value = value < 0 ? 0 : value;
    return SkyImage(std::move(image));
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error::in_file(file.name, "an OpenEXR picture", error.what());
  }
}

}  // namespace burnish
