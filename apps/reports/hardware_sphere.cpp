// SPDX-License-Identifier: Apache-2.0
// Draws a sphere shaded by a unit of hw/, pixel by pixel.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/hardware/generate.h>
#include <burnish/image/contact_sheet.h>
#include <burnish/image/png.h>
#include <burnish/metrics/sphere_images.h>

#include "report.h"

namespace burnish::reports {

namespace {

constexpr int kSize = 256, kExponent = 50;
constexpr double kScale = 64;  // levels of 255 at the end of the difference's colours

// Returns Blinn's cosine at a pixel, with the light 30 degrees from the viewer; 0 outside the sphere.
double cosine_at(int x, int y) {
  const auto n = sphere_normal(kSize, x + 0.5, y + 0.5);
  const Vec3 h{std::sin(radians(15)), 0, std::cos(radians(15))};
  return n ? std::max(0.0, dot(*n, h)) : 0;
}

// Returns in levels of 255 a unit's answers from its file, or c^e by pow where `file` is empty.
Image shaded(const std::string& file) {
  Image image(kSize, kSize, 1);
  std::ifstream answers(file);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      double value = 255 * std::pow(cosine_at(x, y), kExponent);
      if (!file.empty() && !(answers >> value))
        throw Error::in_file(file, fmt::format("{} answers", kSize * kSize),
                             fmt::format("{}", y * kSize + x));
      image.at(x, y)[0] = static_cast<float>(value);
    }
  return image;
}

// Fills the surroundings of the sphere with a dark grey, so that its outline shows.
Image8 grey(const Image& levels) {
  Image8 image(kSize, kSize, 3);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const bool inside = sphere_normal(kSize, x + 0.5, y + 0.5).has_value();
      std::ranges::fill(image.at(x, y),
                        static_cast<std::uint8_t>(inside ? std::lround(levels.at(x, y)[0]) : 40));
    }
  return image;
}

}  // namespace

void print_sphere_questions(const std::string& name) {
  const SpecularUnit unit(shipped_unit(name).config);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) fmt::print("{} {}\n", kExponent, unit.input(cosine_at(x, y)));
}

void draw_sphere_answers(const fs::path& folder, const std::vector<std::string>& units) {
  const Image exact = shaded("");
  ContactSheet sheet{fmt::format("c^{} from simulated blocks, 8 bits", kExponent),
                     {"c^e"},
                     {"sphere", "difference"},
                     {{grey(exact)}, {Image8()}},
                     ColorBar{kScale, "levels of 255"}};
  for (const std::string& unit : units) {
    const auto equals = unit.find('=');
    if (equals == std::string::npos) throw Error("picture: expected NAME=FILE, found " + unit);
    const Image image = shaded(unit.substr(equals + 1));
    const Image difference = mean_difference(image, exact);
    const float most = *std::max_element(difference.pixels.begin(), difference.pixels.end());
    sheet.column_labels.push_back(fmt::format("{}\nat most {:.2f}", unit.substr(0, equals), most));
    sheet.cells[0].push_back(grey(image));
    sheet.cells[1].push_back(heat_map(difference, kScale));
    fmt::print("{} {:.2f}\n", unit.substr(0, equals), most);
  }
  write_png(folder / "hardware_sphere.png", compose(sheet));
}

}  // namespace burnish::reports
