// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/spectrum.h>

namespace burnish {
namespace {

using Rgb = std::array<double, 3>;

std::vector<double> wavelengths(double first, double last, double step) {
  std::vector<double> l;
  for (double v = first; v <= last + 1e-9; v += step) l.push_back(v);
  return l;
}

template <class Spectrum>
Rgb colour(const std::vector<double>& lambda_nm, std::string_view illuminant, Spectrum f) {
  const auto weights = rec709_weights(lambda_nm, illuminant);
  Rgb rgb{};
  for (std::size_t k = 0; k < lambda_nm.size(); ++k)
    for (int c = 0; c < 3; ++c) rgb[c] += weights[k][c] * f(lambda_nm[k]);
  return rgb;
}

TEST(Spectrum, FlatSpectrumIsWhiteForEveryListOfWavelengthsAndLight) {
  const std::vector<std::vector<double>> lists = {wavelengths(360, 1000, 4),
                                                  wavelengths(400, 700, 10),
                                                  {450, 550, 650},
                                                  {550},
                                                  {383.3, 401, 555.5, 555.6, 700, 900},
                                                  {900, 1000},
                                                  {100, 2000}};
  for (const auto& list : lists)
    for (const char* light : {"E", "D65"})
      for (double channel : colour(list, light, [](double) { return 1.0; }))
        EXPECT_NEAR(channel, 1, 1e-12) << light << ' ' << list.front();
}

TEST(Spectrum, ObserverHasThePublishedChromaticities) {
  // Spectrum locus of the CIE 1931 observer.
  const double published[][3] = {
      {460, 0.1440, 0.0297}, {520, 0.0743, 0.8338}, {600, 0.6270, 0.3725}, {700, 0.7347, 0.2653}};
  for (const auto& [lambda_nm, x, y] : published) {
    const auto xyz = cie_1931_xyz(lambda_nm);
    const double sum = xyz[0] + xyz[1] + xyz[2];
    EXPECT_NEAR(xyz[0] / sum, x, 1e-4) << lambda_nm;
    EXPECT_NEAR(xyz[1] / sum, y, 1e-4) << lambda_nm;
  }
  EXPECT_DOUBLE_EQ(cie_1931_xyz(555)[1], 1);
  EXPECT_EQ(cie_1931_xyz(379.9), (Rgb{}));
  EXPECT_EQ(cie_1931_xyz(780.1), (Rgb{}));
}

TEST(Spectrum, DaylightHasThePublishedWhitePoint) {
  Rgb xyz{};
  for (double l = 380; l <= 780; l += 5)
    for (int c = 0; c < 3; ++c) xyz[c] += cie_d65(l) * cie_1931_xyz(l)[c];
  const double sum = xyz[0] + xyz[1] + xyz[2];
  EXPECT_NEAR(xyz[0] / sum, 0.3127, 1e-4);
  EXPECT_NEAR(xyz[1] / sum, 0.3290, 1e-4);
  EXPECT_DOUBLE_EQ(cie_d65(560), 100);
}

TEST(Spectrum, MonochromaticBandsFallOnTheirSideOfTheGamut) {
  const auto band = [](double centre_nm) {
    return colour(wavelengths(380, 780, 5), "D65",
                  [=](double l) { return std::max(0.0, 1 - std::abs(l - centre_nm) / 10); });
  };
  const Rgb red = band(630), green = band(530), blue = band(450), cyan = band(495), yellow = band(575);
  EXPECT_GT(red[0], 0);
  EXPECT_LT(red[1], 0);
  EXPECT_LT(green[0], 0);
  EXPECT_GT(green[1], 0);
  EXPECT_LT(green[2], 0);
  EXPECT_GT(blue[2], 0);
  EXPECT_LT(blue[1], 0);
  EXPECT_LT(cyan[0], 0);
  EXPECT_GT(yellow[0], 0);
  EXPECT_GT(yellow[1], 0);
  EXPECT_LT(yellow[2], 0);
}

TEST(Spectrum, RedPatchOfTheColourCheckerHasItsPublishedColour) {
  // Reflectance of patch 15, 380 nm to 730 nm every 10 nm, the average of 30 charts (BabelColor).
  const double patch[] = {.050, .049, .048, .047, .047, .047, .047, .047, .046, .045, .044, .044,
                          .045, .046, .047, .048, .049, .050, .054, .060, .072, .104, .178, .312,
                          .467, .581, .644, .675, .690, .698, .706, .715, .724, .730, .734, .738};
  const auto lambda_nm = wavelengths(380, 730, 10);
  const auto f = [&](double l) { return patch[static_cast<int>(std::lround((l - 380) / 10))]; };
  const Rgb rgb = colour(lambda_nm, "D65", f), equal = colour(lambda_nm, "E", f);
  // Integrated apart from this code in steps of 1 nm.
  const Rgb expected{0.43013, 0.03239, 0.04009}, expected_equal{0.46564, 0.03026, 0.03995};
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(rgb[c], expected[c], 5e-4);
    EXPECT_NEAR(equal[c], expected_equal[c], 5e-4);
  }
  // The maker's sRGB figures 175, 54, 60 belong to other charts: within 4 of 255.
  const int srgb[] = {175, 54, 60};
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(255 * (1.055 * std::pow(rgb[c], 1 / 2.4) - 0.055), srgb[c], 4);
}

TEST(Spectrum, FinerSamplingOfTheSameLinesChangesNothing) {
  // A spectrum that is linear between 20 nm steps, sampled there and every 7/9 nm besides.
  const auto coarse = wavelengths(400, 700, 20);
  auto fine = coarse;
  for (double l = 400.1; l < 700; l += 7.0 / 9) fine.push_back(l);
  std::sort(fine.begin(), fine.end());
  const auto f = [](double l) {
    const double at = (l - 400) / 20, below = std::floor(at);
    const auto node = [](double k) { return 0.5 + 0.4 * std::sin(2.1 * k); };
    return node(below) + (at - below) * (node(below + 1) - node(below));
  };
  const Rgb a = colour(coarse, "D65", f), b = colour(fine, "D65", f);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-12);
}

TEST(Spectrum, BadListsAndLightsThrow) {
  const std::vector<double> good{400, 500}, falling{500, 400}, twice{500, 500}, zero{0, 500},
      nan{400, std::nan("")}, infinite{400, INFINITY};
  EXPECT_NO_THROW(rec709_weights(good, "E"));
  EXPECT_THROW(rec709_weights(good, "F2"), Error);
  EXPECT_THROW(rec709_weights(good, Illuminant{"dark", {400, 700}, {0, 0}}), Error);
  EXPECT_THROW(rec709_weights(good, ""), Error);
  EXPECT_THROW(rec709_weights({}, "E"), Error);
  for (const auto& bad : {falling, twice, zero, nan, infinite}) EXPECT_THROW(rec709_weights(bad, "E"), Error);
}

// Chromaticities of the CIE's own tables.
TEST(Spectrum, HasTheStandardIlluminantsInTheirPlaces) {
  for (const auto& [name, x, y] : {std::tuple{"E", 0.3333, 0.3333}, std::tuple{"D50", 0.3457, 0.3585},
                                   std::tuple{"D65", 0.3127, 0.3290}, std::tuple{"A", 0.4476, 0.4074}}) {
    const Illuminant light = standard_illuminant(name);
    double sum[3] = {};
    for (double lambda = 380; lambda <= 780; lambda += 1) {
      const auto cie = cie_1931_xyz(lambda);
      for (int c = 0; c < 3; ++c) sum[c] += light.at(lambda) * cie[static_cast<std::size_t>(c)];
    }
    const double total = sum[0] + sum[1] + sum[2];
    EXPECT_NEAR(sum[0] / total, x, 5e-4) << name;
    EXPECT_NEAR(sum[1] / total, y, 5e-4) << name;
    EXPECT_NEAR(light.at(560), std::string_view(name) == "E" ? 1 : 100, 1e-9) << name;
    EXPECT_EQ(light.at(379), 0);
  }
  // white is white under each of them
  for (const char* name : {"D50", "A"}) {
    const Rgb white = colour({400, 500, 600, 700}, name, [](double) { return 1.0; });
    EXPECT_NEAR(white[0], 1, 1e-12);
    EXPECT_NEAR(white[2], 1, 1e-12);
  }
}

TEST(Spectrum, EveryColourHasASpectrumWithoutValuesBelowZero) {
  const auto weights = rec709_weights(kColourNodes_nm, "E");
  for (int red = 0; red <= 4; ++red)
    for (int green = 0; green <= 4; ++green)
      for (int blue = 0; blue <= 4; ++blue) {
        const Rgb colour{0.25 * red, 0.25 * green, 0.25 * blue};
        const std::array<double, 4> spectrum = spectrum_of_colour(colour);
        for (std::size_t c = 0; c < 3; ++c) {
          double sum = 0;
          for (std::size_t k = 0; k < 4; ++k) {
            EXPECT_GE(spectrum[k], 0);
            sum += weights[k][c] * spectrum[k];
          }
          EXPECT_NEAR(sum, colour[c], 1e-14);
        }
      }
  for (const double value : spectrum_of_colour(Rgb{1, 1, 1})) EXPECT_NEAR(value, 1, 1e-14);
}

}  // namespace
}  // namespace burnish
