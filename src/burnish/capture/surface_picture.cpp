// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include <burnish/capture/surface_picture.h>
#include <burnish/error.h>
#include <burnish/eval/spatial_eval.h>
#include <burnish/render/picture.h>

namespace burnish {

namespace {

constexpr int kGap = 4;  // pixels, white

/// f cos(theta_i) of every texel.
Image modelled(const CaptureForm& form, const SpatialBrdf& surface, const CapturePicture& picture) {
  const SpatialEvaluator evaluator(surface);
  Image image(form.width, form.height, 3);
  for (int y = 0; y < form.height; ++y)
    for (int x = 0; x < form.width; ++x) {
      const SpatialEvaluator::Place place = evaluator.texel(x, y);
      const Vec3 point = form.point(x, y), light = picture.light.seen_from(point);
      evaluator.eval(place, light, picture.view.seen_from(point), image.at(x, y));
      const auto cosine = static_cast<float>(std::max(0.0, dot(place.frame.normal, light)));
      for (float& value : image.at(x, y)) value *= cosine;
    }
  return image;
}

Image8 weights_of(const SurfaceMap& map) {
  float most = 0;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      for (const float value : map.texel(x, y)) most = std::max(most, value);
  Image image(map.width(), map.height(), 3);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      for (std::size_t c = 0; c < 3; ++c) image.at(x, y)[c] = map.texel(x, y)[map.channels() == 1 ? 0 : c];
  return to_bytes(image, most > 0 ? 1 / static_cast<double>(most) : 1, Tone::srgb);
}

}  // namespace

Image8 surface_picture(const Capture& capture, const SpatialBrdf& surface, std::size_t picture,
                       double exposure) {
  const CaptureForm& form = capture.form();
  if (form.own_directions)
    throw Error::in_file(capture.form_file().string(), "pictures to show beside the surface", "samples");
  if (picture >= form.pictures.size())
    throw Error(
        fmt::format("surface picture: expected a number below {}, found {}", form.pictures.size(), picture));
  if (surface.width() != form.width || surface.height() != form.height || surface.channels() != 3)
    throw Error(fmt::format("surface picture: expected {} x {} texels of 3 channels, found {} x {} of {}",
                            form.width, form.height, surface.width(), surface.height(), surface.channels()));
  Capture::Read read = capture.read(0, form.height);
  if (!read.damaged.empty()) throw Error(read.damaged.front().why);
  Image measured(form.width, form.height, 3);
  std::copy_n(&read.rows.values[picture * measured.pixels.size()], measured.pixels.size(),
              measured.pixels.begin());

  // The panels stand side by side.
  std::vector<Image8> panels{to_bytes(measured, exposure, Tone::srgb),
                             to_bytes(modelled(form, surface, form.pictures[picture]), exposure, Tone::srgb)};
  for (const SurfaceMap& map : std::span(surface.maps().weights).first(surface.own_lobes()))
    panels.push_back(weights_of(map));
  const int step = form.width + kGap;
  Image8 sheet(step * static_cast<int>(panels.size()) - kGap, form.height, 3);
  std::ranges::fill(sheet.pixels, std::uint8_t{255});
  for (std::size_t p = 0; p < panels.size(); ++p)
    for (int y = 0; y < form.height; ++y) {
      const auto from = std::span(panels[p].pixels)
                            .subspan(panels[p].offset(0, y), 3 * static_cast<std::size_t>(form.width));
      std::ranges::copy(from, sheet.at(step * static_cast<int>(p), y).data());
    }
  return sheet;
}

}  // namespace burnish
