// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/reflectance/ggx_proxy.h>
#include <burnish/reflectance/half_vector_quadrature.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/sampling.h>

namespace burnish {
namespace {

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

}  // namespace
}  // namespace burnish
