// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/eval/spatial_eval.h>
#include <burnish/testing/models.h>
#include <burnish/testing/surfaces.h>

namespace burnish {
namespace {

struct PairPlanes {
  std::array<std::vector<float>, 6> w;
  explicit PairPlanes(const std::vector<DirectionPair>& pairs) {
    for (const auto& [wi, wo] : pairs) {
      const double all[] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
      for (std::size_t k = 0; k < 6; ++k) w[k].push_back(static_cast<float>(all[k]));
    }
  }
  DirectionSpans spans() const { return {w[0], w[1], w[2], w[3], w[4], w[5]}; }
};

// Each lobe by itself equals a model of that lobe alone, for one and three channels, and for one lobe and many.
TEST(LobeEvaluator, GivesEveryLobeApart) {
  for (const char* name : {"Volume", "ThreeLobes", "Shared", "ManyTables", "Volumes", "RootWarps"}) {
    const FactoredBrdf brdf = smooth_model(model_case(name));
    const LobeEvaluator lobes(brdf);
    const std::vector<DirectionPair> pairs = corner_and_random_pairs(333);
    const PairPlanes planes(pairs);
    const std::size_t channels = brdf.channels();
    std::vector<float> f(lobes.lobes() * channels * pairs.size());
    lobes.eval(planes.spans(), f);
    for (std::size_t j = 0; j < lobes.lobes(); ++j) {
      const FactoredBrdf alone = lobe_alone(brdf, j);
      std::vector<double> expected(channels);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        alone.eval(pairs[i].wi, pairs[i].wo, expected);
        for (std::size_t c = 0; c < channels; ++c)
          ASSERT_NEAR(static_cast<double>(f[(j * channels + c) * pairs.size() + i]), expected[c],
                      lobes.rounding_bound() * expected[c] + 0x1p-126)
              << name << " lobe " << j << " pair " << i;
      }
    }
  }
}

// One pair with weights is the weighted sum of the single lobes.
TEST(LobeEvaluator, WeighsTheLobesOfOnePair) {
  for (const char* name : {"Volume", "ThreeLobes", "ManyTables", "RootWarps"}) {
    const FactoredBrdf brdf = smooth_model(model_case(name));
    const LobeEvaluator lobes(brdf);
    Pcg32 random(3);
    std::vector<float> weights(LobeEvaluator::kWeightStride * lobes.lobes());
    for (float& weight : weights) weight = static_cast<float>(random.uniform());
    std::vector<double> lobe(brdf.channels());
    std::vector<float> f(brdf.channels());
    for (const auto& [wi, wo] : corner_and_random_pairs(333)) {
      lobes.eval(wi, wo, weights, f);
      std::vector<double> sum(brdf.channels());
      for (std::size_t j = 0; j < lobes.lobes(); ++j) {
        lobe_alone(brdf, j).eval(wi, wo, lobe);
        for (std::size_t c = 0; c < sum.size(); ++c)
          sum[c] += lobe[c] * static_cast<double>(weights[LobeEvaluator::kWeightStride * j + c]);
      }
      for (std::size_t c = 0; c < sum.size(); ++c)
        ASSERT_NEAR(static_cast<double>(f[c]), sum[c], (lobes.rounding_bound() + 0x1p-20) * sum[c] + 0x1p-120)
            << name;
    }
  }
}

TEST(LobeEvaluator, RefusesOtherChannels) {
  EXPECT_THROW(LobeEvaluator(random_model("q(theta_h)", {"q=4"}, 2, TableFormat::single)), Error);
}

TEST(SpatialEvaluator, AgreesWithTheDefinition) {
  const SpatialBrdf surface = random_surface(9, 7);
  const SpatialEvaluator fast(surface);
  std::array<float, 3> found;
  std::array<double, 3> expected;
  Pcg32 random(8);
  for (int i = 0; i < 400; ++i) {
    const double u = random.uniform(), v = random.uniform(), lod = 3 * random.uniform();
    const Vec3 wi = normalize({random.uniform() - 0.5, random.uniform() - 0.5, random.uniform()});
    const Vec3 wo = normalize({random.uniform() - 0.5, random.uniform() - 0.5, random.uniform()});
    const SpatialEvaluator::Place place = fast.place(u, v, lod);
    // Directions near the shading horizon may lie on different sides of it in both evaluators.
    if (std::min(std::abs(place.frame.local(wi).z), std::abs(place.frame.local(wo).z)) < 1e-5) continue;
    fast.eval(place, wi, wo, found);
    surface.eval(u, v, lod, wi, wo, expected);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(static_cast<double>(found[c]), expected[c],
                  (fast.rounding_bound() + 8 * 0x1p-24) * expected[c]);
  }
}

TEST(SpatialEvaluator, OfATexelIsTheModelOfThatTexel) {
  const SpatialBrdf surface = random_surface(11, 7);
  const SpatialEvaluator fast(surface);
  std::array<float, 3> found;
  std::array<double, 3> expected;
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 11; ++x) {
      const SpatialEvaluator::Place place = fast.texel(x, y);
      const Vec3 wi = place.frame.tangent * 0.6 + place.frame.normal * 0.8,
                 wo = place.frame.bitangent * -0.6 + place.frame.normal * 0.8;
      fast.eval(place, wi, wo, found);
      surface.texel(x, y).eval({0.6, 0, 0.8}, {0, -0.6, 0.8}, expected);
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(static_cast<double>(found[c]), expected[c],
                    (fast.rounding_bound() + 16 * 0x1p-24) * expected[c]);
    }
  EXPECT_THROW(surface.texel(11, 0), Error);
  EXPECT_THROW(surface.texel(0, -1), Error);
}

}  // namespace
}  // namespace burnish
