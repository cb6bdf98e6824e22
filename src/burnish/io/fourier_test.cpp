// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/fourier.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/albedo.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;

/// Returns cosines as layerlab writes them: `half` on each side, and 0 twice.
std::vector<float> cosines(int half) {
  std::vector<float> mu;
  for (int k = half; k >= 0; --k) mu.push_back(-static_cast<float>(k) / static_cast<float>(half));
  for (int k = 0; k <= half; ++k) mu.push_back(static_cast<float>(k) / static_cast<float>(half));
  return mu;
}

/// Returns the series of a Lambertian surface of albedo 0.2, which reflects above alone.
std::vector<float> lambert(float mu_i, float mu_o) {
  if (!(mu_i < 0 && mu_o > 0)) return {};
  return {-mu_i * static_cast<float>(0.2 / kPi)};
}

/// Returns different coefficients for each pair and order.
std::vector<float> varied(float mu_i, float mu_o) {
  if (!(mu_i < 0 && mu_o > 0)) return {};
  return {2 - mu_i, mu_o, 0.25f * mu_i * mu_o};
}

double value(BrdfRef brdf, Vec3 wi, Vec3 wo) {
  double f = 0;
  EXPECT_TRUE(brdf.eval(wi, wo, std::span(&f, 1)));
  return f;
}

Vec3 at_cosine(double mu, double phi) {
  return spherical_direction(std::acos(mu), phi);
}

TEST(Fourier, IsLambertianWhereTheSeriesAre) {
  const FourierFile file =
      parse_fourier(memory_file(seeds::fourier_bytes(cosines(8), 1, lambert, "grey paint\nmore\n")));
  EXPECT_EQ(file.findings.description, "grey paint");
  EXPECT_EQ(file.findings.sample_count, 64u);
  EXPECT_TRUE(file.brdf.isotropic());
  // A straight line is its own spline, up to the last interval before the horizon.
  for (const double mu_i : {0.3, 0.5, 0.77, 1.0})
    for (const double mu_o : {0.3, 0.6, 1.0})
      EXPECT_NEAR(value(file.brdf, at_cosine(mu_i, 0.3), at_cosine(mu_o, 2)), 0.2 / kPi, 1e-8);
  const Source source = parse_source(memory_file(seeds::fourier_bytes(cosines(32), 1, lambert)), {});
  EXPECT_THAT(directional_albedo(source.ref(), {0, 0, 1}).albedo, ElementsAre(DoubleNear(0.2, 1e-3)));
}

TEST(Fourier, HasTheSeriesAtItsNodes) {
  const FourierFile file = parse_fourier(memory_file(seeds::fourier_bytes(cosines(4), 1, varied)));
  for (const double mu_i : {0.25, 0.5, 1.0})
    for (const double mu_o : {0.5, 0.75})
      for (const double phi : {0.0, 0.4, 1.9, kPi}) {
        // The azimuth of -wi is that of wi plus pi.
        const double expected =
            (2 + mu_i + mu_o * std::cos(phi) - 0.25 * mu_i * mu_o * std::cos(2 * phi)) / mu_i;
        const double azimuth = mu_i == 1 ? 0 : phi;  // the zenith has no azimuth
        const double of_zenith = (2 + mu_i + mu_o - 0.25 * mu_i * mu_o) / mu_i;
        EXPECT_NEAR(value(file.brdf, at_cosine(mu_i, 0.7), at_cosine(mu_o, 0.7 + kPi + azimuth)),
                    mu_i == 1 ? of_zenith : expected, 1e-6)
            << mu_i << ' ' << mu_o << ' ' << phi;
      }
}

TEST(Fourier, IsASplineBetweenNodes) {
  // f |mu_i| = mu_o^2 at cosines 0, 1/4, 1/2 and so on. At 5/8 the slopes are exact, and so is the parabola.
  const auto square = [](float mu_i, float mu_o) -> std::vector<float> {
    if (!(mu_i < 0 && mu_o > 0)) return {};
    return {mu_o * mu_o};
  };
  const FourierFile file = parse_fourier(memory_file(seeds::fourier_bytes(cosines(4), 1, square)));
  EXPECT_NEAR(value(file.brdf, at_cosine(0.5, 1), at_cosine(0.625, 2)), 0.625 * 0.625 / 0.5, 1e-7);
  // In the last interval the slope at 1 is that of the interval: 7/4 instead of 2.
  const double t = 0.5, excess = (t * t * t - t * t) * 0.25 * (7.0 / 4 - 2);
  EXPECT_NEAR(value(file.brdf, at_cosine(0.5, 1), at_cosine(0.875, 2)), (0.875 * 0.875 + excess) / 0.5, 1e-7);
}

TEST(Fourier, HasGreenFromLuminance) {
  const auto rgb = [](float mu_i, float mu_o) -> std::vector<float> {
    if (mu_i == 0 || mu_o == 0) return {};
    const double scale = std::abs(mu_i);
    return {static_cast<float>(scale * (0.2126 * 0.3 + 0.7152 * 0.2 + 0.0722 * 0.1)),
            static_cast<float>(scale * 0.3), static_cast<float>(scale * 0.1)};
  };
  const FourierFile file = parse_fourier(memory_file(seeds::fourier_bytes(cosines(4), 3, rgb)));
  std::array<double, 3> f{};
  ASSERT_TRUE(file.brdf.eval(at_cosine(0.75, 0), at_cosine(0.5, 1), f));
  EXPECT_THAT(f, ElementsAre(DoubleNear(0.3, 1e-6), DoubleNear(0.2, 1e-6), DoubleNear(0.1, 1e-6)));
  EXPECT_THAT(file.findings.left_out, ElementsAre("transmission", "the reflection of the lower side"));
}

TEST(Fourier, CutsWhatIsBelowZero) {
  const auto negative = [](float mu_i, float mu_o) -> std::vector<float> {
    if (!(mu_i < 0 && mu_o > 0)) return {};
    return {0.5f, 1};
  };
  const FourierFile file = parse_fourier(memory_file(seeds::fourier_bytes(cosines(4), 1, negative)));
  EXPECT_NEAR(value(file.brdf, at_cosine(0.5, 0), at_cosine(0.5, kPi)), 3, 1e-6) << "the mirror direction";
  EXPECT_EQ(value(file.brdf, at_cosine(0.5, 0), at_cosine(0.5, 0)), 0);
}

TEST(Fourier, SaysWhatIsWrong) {
  const std::string whole = seeds::fourier_bytes(cosines(2), 1, varied);
  // The word replaces one of the header, or one behind it.
  const auto error = [&](std::size_t at, auto word) {
    std::string bytes = whole;
    bytes.replace(at, sizeof(word), reinterpret_cast<const char*>(&word), sizeof(word));
    return error_of([&] { parse_fourier(memory_file(bytes)); });
  };
  constexpr std::size_t kMu = 64, kSeries = kMu + 4 * (6 + 36), kValues = kSeries + 8 * 36;
  EXPECT_THAT(error(7, '\2'), HasSubstr("offset 8: expected version 1, found 2"));
  EXPECT_THAT(error(8, 3u), HasSubstr("found 3, harmonic extrapolation"));
  EXPECT_THAT(error(12, 1u), HasSubstr("2 to 8192 cosines, found 1"));
  EXPECT_THAT(error(12, 8000u), HasSubstr("expected a file of"));
  EXPECT_THAT(error(16, 4000000000u), HasSubstr("expected a file of"));
  EXPECT_THAT(error(20, 4000000000u), HasSubstr("coefficients, found one of 4000000000"));
  EXPECT_THAT(error(24, 2u), HasSubstr("1 or 3 channels, found 2"));
  EXPECT_THAT(error(28, 4u), HasSubstr("no textures, found 4"));
  EXPECT_THAT(error(36, 1u), HasSubstr("no textures, found some"));
  EXPECT_THAT(error(kMu, -0.5f), HasSubstr("cosines from -1 to 1, found -0.5 to 1"));
  EXPECT_THAT(error(kMu + 4, 0.5f), HasSubstr("cosines that rise"));
  EXPECT_THAT(error(kMu + 4, NAN), HasSubstr("a finite number among cosines, found nan"));
  EXPECT_THAT(error(kSeries + 4, 4u), HasSubstr("a series of at most 3"));
  EXPECT_THAT(error(kSeries + 8 * 24, 1000u), HasSubstr("3 at 1000"));
  EXPECT_THAT(error(kValues, INFINITY), HasSubstr("a finite number among coefficients, found inf"));
  EXPECT_THAT(error_of([&] { parse_fourier(memory_file(whole + '\0')); }), HasSubstr("expected a file of"));
  const auto nothing = [](float, float) -> std::vector<float> { return {}; };
  EXPECT_THAT(error_of([&] { parse_fourier(memory_file(seeds::fourier_bytes(cosines(2), 1, nothing))); }),
              HasSubstr("expected a reflection of the upper side, found none"));
}

}  // namespace
}  // namespace burnish
