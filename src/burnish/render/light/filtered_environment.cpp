// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/parallel.h>
#include <burnish/render/light/filtered_environment.h>
#include <burnish/render/light/parabolic_pair.h>
#include <burnish/render/light/prefiltered_formula.h>

namespace burnish {
namespace {

constexpr int kFinest = 512;  // texels around the horizon that are summed over
constexpr double kTexelsAWidth = 1.3;
constexpr double kReach = 3.5;  // widths where weights end

void store(Rgb value, std::span<float> texel) noexcept {
  texel[0] = static_cast<float>(value.r);
  texel[1] = static_cast<float>(value.g);
  texel[2] = static_cast<float>(value.b);
}

// Returns the part of the environment that is no disc, as a picture.
SkyImage sky_of(const Environment& environment) {
  if (environment.picture) return SkyImage(smaller_sky(environment.picture->image(), kFinest));
  Environment sky = environment;
  sky.discs.clear();
  const SkyImage grid(Image(kFinest, kFinest / 2, 3));
  Image image = grid.image();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb value = sky.radiance(grid.direction(x, y));
      store(value, image.at(x, y));
    }
  return SkyImage(std::move(image));
}

// Texels weighed by a lobe about `axis`.
Rgb blurred(const SkyImage& sky, Vec3 axis, double width) noexcept {
  // rows within reach, and the columns of each that may be
  const Image& image = sky.image();
  const double texel = kPi / image.height, reach = std::max(kReach * width, 1.5 * texel);
  const double theta = std::acos(std::clamp(axis.y, -1.0, 1.0)), phi = std::atan2(axis.z, axis.x);
  const int first = std::max(static_cast<int>((theta - reach) / texel), 0),
            last = std::min(static_cast<int>((theta + reach) / texel), image.height - 1);
  int columns = image.width;
  if (theta > reach && theta < kPi - reach)
    columns = std::min(
        columns, 2 * static_cast<int>(std::ceil(std::asin(std::sin(reach) / std::sin(theta)) / texel)) + 1);
  const int start = static_cast<int>(std::floor((phi / kTwoPi + 0.5) * image.width)) - columns / 2;

  // sums of the colours and of the weights
  std::array<double, 4> sum{};
  for (int y = first; y <= last; ++y) {
    const double area = sky.solid_angle(y);
    for (int i = 0; i < columns; ++i) {
      const int x = (start + i + image.width) % image.width;
      const double weight = area * std::exp((dot(sky.direction(x, y), axis) - 1) / (width * width));
      const auto value = image.at(x, y);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * value[c];
      sum[3] += weight;
    }
  }
  return {sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]};
}

}  // namespace

double blur_weight(double cosine, double width) noexcept {
  const double square = width * width;
  return std::exp((cosine - 1) / square) / (kTwoPi * square * (1 - std::exp(-2 / square)));
}

BlurredEnvironment blur(const Environment& environment, const BlurOptions& options) {
  const auto require = [](const char* what, double value, double least, double most) {
    if (!(value >= least && value <= most))
      throw Error(
          fmt::format("blurred environment: expected {} in [{}, {}], found {}", what, least, most, value));
  };
  require("a side", options.side, 8, 512);
  require("levels", options.levels, 2, 32);
  require("a narrowest width", options.narrowest, 1e-3, 0.5);
  require("a step", options.step, 1.1, 4);

  // the picture ever smaller: wide lobes are summed over coarse ones
  std::vector<SkyImage> skies{sky_of(environment)};
  while (skies.back().image().width > 16 && skies.back().image().height % 2 == 0)
    skies.emplace_back(smaller_sky(skies.back().image(), skies.back().image().width / 2));

  // every texel of every level: the blurred picture and the discs
  const std::vector<DiscPoint> points = disc_points(environment);
  const auto side = static_cast<std::size_t>(options.side);
  BlurredEnvironment result{options,
                            std::vector<float>(static_cast<std::size_t>(options.levels) * side * side * 6)};
  for_each_chunk(
      static_cast<std::size_t>(options.levels) * side, 1, [&](std::size_t row, std::size_t, std::size_t) {
        const double width = options.narrowest * std::pow(options.step, static_cast<double>(row / side));
        std::size_t level = 0;  // the coarsest that shows the lobe
        while (level + 1 < skies.size() && kTexelsAWidth * kTwoPi / skies[level + 1].image().width < width)
          ++level;
        for (int column = 0; column < 2 * options.side; ++column) {
          const int half = column >= options.side;
          const Vec3 axis =
              in_half(half, map_direction(column % options.side, static_cast<int>(row % side), options.side));
          Rgb value = blurred(skies[level], axis, width);
          for (const DiscPoint& point : points)
            value = value + Rgb(blur_weight(dot(point.direction, axis), width)) * point.light;
          store(value,
                std::span(result.maps).subspan(3 * (row * 2 * side + static_cast<std::size_t>(column)), 3));
        }
      });
  return result;
}

Rgb BlurredEnvironment::radiance(Vec3 w, double width) const noexcept {
  const int side = options.side, half = w.y < 0;
  const auto [x, y] = map_place(in_half(half, w), side);
  const double level =
      std::clamp(std::log(width / options.narrowest) / std::log(options.step), 0.0, options.levels - 1.0);
  const int x0 = std::clamp(static_cast<int>(x), 0, side - 2),
            y0 = std::clamp(static_cast<int>(y), 0, side - 2),
            l0 = std::min(static_cast<int>(level), options.levels - 2);

  // linear in place and level
  Rgb sum;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = corner >> 1 & 1, dl = corner >> 2;
    const double weight =
        (dx ? x - x0 : 1 - x + x0) * (dy ? y - y0 : 1 - y + y0) * (dl ? level - l0 : 1 - level + l0);
    const float* texel = maps.data() + 3 * (((l0 + dl) * side + y0 + dy) * 2 * side + half * side + x0 + dx);
    sum = sum + Rgb(weight) * Rgb(texel[0], texel[1], texel[2]);
  }
  return sum;
}

}  // namespace burnish
