#include <cmath>

#include <gtest/gtest.h>

#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/ggx_proxy.h>
#include <burnish/reflectance/half_vector_quadrature.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/sampling.h>

namespace burnish {
namespace {

const Vec3 kViews[] = {
    {0, 0, 1}, spherical_direction(0.6, 1), spherical_direction(1.2, 4), spherical_direction(1.54, 2)};

TEST(ChiSquareTail, HasTheValuesOfTables) {
  EXPECT_NEAR(chi_square_tail(3.841458820694124, 1), 0.05, 1e-12);
  EXPECT_NEAR(chi_square_tail(10, 2), std::exp(-5.0), 1e-12);
  EXPECT_NEAR(chi_square_tail(124.3421134, 100), 0.05, 1e-8);
}

TEST(LargestVisibleHalf, MirrorsWoOntoTheHorizon) {
  Pcg32 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 wo =
        spherical_direction(kHalfPi * (1 - std::pow(10.0, -6 * random.uniform())), kTwoPi * random.uniform());
    const double phi = kTwoPi * random.uniform(), x = std::cos(phi), y = std::sin(phi);
    const double t = std::sqrt(largest_visible_half(wo.x * x + wo.y * y, wo.z));
    const Vec3 h = Vec3{2 * t * x, 2 * t * y, 1 - t * t} * (1 / (1 + t * t));
    EXPECT_NEAR((2 * dot(wo, h) * h - wo).z, 0, 1e-12);
  }
}

TEST(HalfVectorQuadrature, IntegratesTheHemisphere) {
  for (const Vec3 wo : kViews) {
    double area = 0, cosine = 0;
    for (const auto& [wi, weight] : half_vector_quadrature(wo, 64, 256)) {
      area += weight;
      cosine += weight * wi.z;
    }
    EXPECT_NEAR(area / kTwoPi, 1, 4e-3);
    EXPECT_NEAR(cosine / kPi, 1, 2e-3);
  }
}

TEST(HalfVectorQuadrature, ResolvesNarrowLobes) {
  // GGX without masking loses nothing: the visible normals' density mirrored integrates to 1
  for (const double alpha : {0.002, 0.05, 0.4}) {
    const GgxProxy proxy{{alpha, alpha}};
    double sum = 0;
    for (const auto& [wi, weight] : half_vector_quadrature(kViews[1], 64, 256))
      sum += weight * proxy.pdf(wi, kViews[1]);
    EXPECT_LT(sum, 1.001);
    EXPECT_GT(sum, 1 - 1e-3 - alpha * alpha);  // tails below the horizon
  }
}

TEST(ReflectedSize, IsTheRootMeanSquareOfTheChannels) {
  const fixtures::Lambert lambert{.albedo = {3, 0, 4}};
  std::vector<double> f(3);
  EXPECT_NEAR(reflected_size(lambert, kViews[1], kViews[2], f), 5 / std::sqrt(3.0) / kPi * kViews[1].z,
              1e-12);
}

TEST(CosineSampler, DrawsByItsDensity) {
  const DrawTest test = test_draws(CosineSampler{}, kViews[1], 50'000, 2);
  EXPECT_GT(test.p_value, 0.01);
  EXPECT_NEAR(test.integral, 1, 1e-3);
}

TEST(GgxProxy, DrawsByItsDensity) {
  std::uint64_t seed = 1;
  for (const GgxProxy& proxy : {GgxProxy{{0.3, 0.3}}, GgxProxy{{0.05, 0.4}}, GgxProxy{{0.1, 0.1}, 0.6}})
    for (const Vec3 wo : kViews) {
      const DrawTest test = test_draws(proxy, wo, 50'000, ++seed);
      EXPECT_GT(test.p_value, level_of_each(0.01, 12)) << seed;
      EXPECT_LT(test.integral, 1.002);
    }
}

TEST(GgxProxy, FitFindsTheGgxItIsGiven) {
  const GgxProxy round =
      fit_ggx_proxy(parse_analytic("ggx:alpha_x=0.12,alpha_y=0.12,f0=1,kd=0").ref(), false);
  EXPECT_NEAR(round.distribution.alpha_x, 0.12, 0.02);
  EXPECT_EQ(round.distribution.alpha_x, round.distribution.alpha_y);
  EXPECT_EQ(round.share, 1);
  const GgxProxy brushed =
      fit_ggx_proxy(parse_analytic("ggx:alpha_x=0.1,alpha_y=0.3,f0=1,kd=0.3").ref(), true);
  EXPECT_NEAR(brushed.distribution.alpha_x, 0.1, 0.02);
  EXPECT_NEAR(brushed.distribution.alpha_y, 0.3, 0.06);
  EXPECT_NEAR(brushed.share, 0.75, 0.1);
}

}  // namespace
}  // namespace burnish
