// A sphere shaded by a unit of hw/, pixel by pixel.
//   burnish_hardware_sphere questions UNIT          the `exponent input` line of every pixel, for a
//   simulation burnish_hardware_sphere picture OUT NAME=FILE...  the answers of units, beside c^e and their
//   differences
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <string_view>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/hardware/generate.h>
#include <burnish/image/contact_sheet.h>
#include <burnish/image/png.h>
#include <burnish/metrics/sphere_images.h>

namespace burnish {
namespace {

constexpr int kSize = 256, kExponent = 50;
constexpr double kScale = 64;  // levels of 255 at the end of the difference's colours

// Blinn's cosine at a pixel, the light 30 degrees from the viewer; 0 outside the sphere.
double cosine_at(int x, int y) {
  const auto n = sphere_normal(kSize, x + 0.5, y + 0.5);
  const Vec3 h{std::sin(radians(15)), 0, std::cos(radians(15))};
  return n ? std::max(0.0, dot(*n, h)) : 0;
}

// c^e from the powers themselves, or a unit's answers, in levels of 255.
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

// Beside the sphere a dark grey, so that its outline shows.
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

void print_questions(const SpecularUnit& unit) {
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) fmt::print("{} {}\n", kExponent, unit.input(cosine_at(x, y)));
}

void write_picture(const std::string& out, const std::vector<std::string>& units) {
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
  write_png(out, compose(sheet));
}

}  // namespace
}  // namespace burnish

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  try {
    if (words.size() == 2 && words[0] == "questions")
      burnish::print_questions(burnish::SpecularUnit(burnish::shipped_unit(words[1]).config));
    else if (words.size() > 2 && words[0] == "picture")
      burnish::write_picture(words[1], {words.begin() + 2, words.end()});
    else
      return std::cerr << "usage: burnish_hardware_sphere questions UNIT | picture OUT NAME=FILE...\n", 2;
  } catch (const burnish::Error& error) {
    return std::cerr << error.what() << "\n", 1;
  }
}
