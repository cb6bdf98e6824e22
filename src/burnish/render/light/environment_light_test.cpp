// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/eval/tabulated_sampler.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/ggx_proxy.h>
#include <burnish/render/light/environment_light.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/sampling.h>

namespace burnish {
namespace {

const fixtures::Lambert kGrey{.albedo = {0.5, 0.5, 0.5}};
const fixtures::Glossy kGlossy{.a = 60, .b = 60};
const GgxProxy kProxy{{0.25, 0.25}, 0.6};

// A lamp large enough for every pixel to be hit often.
const Environment kLamp{
    "lamp", {0.3, 0.5, 1}, {1, 1, 1}, {0.2, 0.1, 0.1}, {{normalize({0.4, 0.5, 0.7}), 0.5, 6}}};

TEST(EnvironmentLight, AnEvenSkyShowsTheAlbedo) {
  const Environment even{"even", 2, 2, 2, {}};
  const LightRender render = render_in_environment(kGrey, CosineSampler{}, even, {.size = 16, .samples = 8});
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const bool inside = sphere_normal(16, x + 0.5, y + 0.5).has_value();
        EXPECT_NEAR(render.mean.at(x, y)[c], inside ? 1 : 0, 1e-6);
        EXPECT_NEAR(render.variance.at(x, y)[c], 0, 1e-6);
      }
}

TEST(EnvironmentLight, EverySamplerApproachesTheMeanWithItsVariance) {
  const CosineSampler cosine;
  const SamplerRef samplers[] = {kProxy, cosine};
  const LightOptions options{.size = 12, .samples = 4096};
  const LightMoments moments = moments_in_environment(kGlossy, kProxy, samplers, kLamp, options);
  const Image& reference = moments.mean;
  for (std::size_t s = 0; s < 2; ++s) {
    const LightRender render = render_in_environment(kGlossy, samplers[s], kLamp, options);
    double chi_square = 0, variance = 0, expected_variance = 0;
    int count = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); i += 3)  // one channel: they share draws
      if (render.variance.pixels[i] > 0) {
        const double error = render.mean.pixels[i] - reference.pixels[i];
        chi_square += error * error / (render.variance.pixels[i] / options.samples);
        ++count;
      }
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
      variance += render.variance.pixels[i];
      expected_variance += moments.variance[s].pixels[i];
    }
    EXPECT_NEAR(variance / expected_variance, 1, 0.03);
    EXPECT_GT(chi_square_tail(chi_square, count), 0.001);
    EXPECT_LT(chi_square_tail(chi_square, count), 0.999);
  }
}

// The sum over the picture of the variance of one sample.
double variance_of(const Image& variance) {
  return std::accumulate(variance.pixels.begin(), variance.pixels.end(), 0.0);
}

TEST(EnvironmentLight, TabulatedDrawsVaryLessThanCosineAndGgx) {
  double over_cosine = 0, over_ggx = 0;
  int count = 0;
  for (const char* spec : {"oren_nayar:sigma=0.4", "ggx:alpha_x=0.2,alpha_y=0.2,f0=0.3,kd=0.1",
                           "ggx:alpha_x=0.1,alpha_y=0.1,f0=0.9,kd=0.1"}) {
    const AnalyticBrdf brdf = parse_analytic(spec);
    const TabulatedSampler tabulated(brdf.ref());
    const CosineSampler by_cosine;
    const GgxProxy ggx = fit_ggx_proxy(brdf.ref(), false);
    const SamplerRef samplers[] = {tabulated, by_cosine, ggx};
    for (const Environment& environment : environments()) {
      const LightMoments moments =
          moments_in_environment(brdf.ref(), tabulated, samplers, environment, {.size = 10, .samples = 64});
      const double ours = variance_of(moments.variance[0]), cosine = variance_of(moments.variance[1]);
      EXPECT_LT(ours, 1.05 * cosine) << spec << " " << environment.name;
      over_cosine += ours / cosine;
      over_ggx += ours / variance_of(moments.variance[2]);
      ++count;
    }
  }
  EXPECT_LT(over_cosine / count, 0.5);
  EXPECT_LT(over_ggx / count, 0.8);
}

TEST(EnvironmentLight, StratifiedPointsLowerTheError) {
  LightOptions options{.size = 12, .samples = 1024};
  const Image reference =
      moments_in_environment(kGlossy, kProxy, {}, kLamp, {.size = 12, .samples = 4096}).mean;
  const auto error = [&] {
    return mean_squared_error(render_in_environment(kGlossy, kProxy, kLamp, options).mean, reference);
  };
  const double independent = error();
  options.stratified = true;
  EXPECT_LT(error(), 0.8 * independent);
}

TEST(EnvironmentLight, BuiltInDiscsAreSeenWhereTheyAre) {
  for (const Environment& environment : environments())
    for (const DistantDisc& disc : environment.discs) {
      EXPECT_NEAR(length(disc.direction), 1, 1e-12);
      EXPECT_GT(environment.radiance(disc.direction).g, disc.radiance);
      EXPECT_LT(environment.radiance(-disc.direction).g, 1);
    }
}

TEST(EnvironmentLight, GivesTheSamePictureAgain) {
  const LightOptions options{.size = 8, .samples = 16};
  const auto render = [&] { return render_in_environment(kGlossy, kProxy, environments()[1], options).mean; };
  EXPECT_EQ(render(), render());
}

TEST(EnvironmentLight, RefusesOptionsOutOfRange) {
  for (const LightOptions& bad :
       {LightOptions{.size = 3}, LightOptions{.samples = 1}, LightOptions{.samples = 15, .stratified = true}})
    EXPECT_THROW(render_in_environment(kGrey, kProxy, environments()[0], bad), Error);
  EXPECT_THROW(render_in_environment(fixtures::Lambert{.count = 2}, kProxy, environments()[0], {}), Error);
}

}  // namespace
}  // namespace burnish
