// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/outliers.h>
#include <burnish/reflectance/sampling.h>

namespace burnish {
namespace {

/// Samples with log-normal noise, and every n-th of them ten times too large or too small.
MeasuredNodes noisy_nodes(const char* formula, std::size_t count, double noise, std::size_t every,
                          std::uint64_t seed = 3) {
  const AnalyticBrdf brdf = parse_analytic(formula);
  const BrdfRef ref = brdf.ref();
  Samples samples{.channels = ref.channels(), .isotropic = ref.isotropic()};
  Pcg32 random(seed);
  std::vector<double> f(ref.channels());
  while (samples.size() < count) {
    const auto direction = [&] {
      const double z = std::sqrt(random.uniform() * 0.99 + 0.01),
                   phi = 2 * 3.14159265358979 * random.uniform(), r = std::sqrt(1 - z * z);
      return Vec3{r * std::cos(phi), r * std::sin(phi), z};
    };
    const Vec3 wi = direction(), wo = direction();
    ref.eval(wi, wo, f);
    double factor = std::exp(noise * (random.uniform() + random.uniform() + random.uniform() - 1.5) * 2);
    if (every > 0 && samples.size() % every == 0) factor *= samples.size() % (2 * every) == 0 ? 10 : 0.1;
    samples.pairs.push_back({wi, wo});
    for (const double v : f) samples.values.push_back(v * factor);
  }
  return measured_nodes(samples);
}

TEST(Outliers, AreFoundAndNothingElse) {
  for (const char* formula :
       {"ggx:alpha_x=0.2,alpha_y=0.2,f0=0.9,kd=0.1", "ggx:alpha_x=0.2,alpha_y=0.5,f0=0.8"})
    for (const double noise : {0.01, 0.1}) {
      const MeasuredNodes nodes = noisy_nodes(formula, 3000, noise, 60);
      const std::vector<std::size_t> outliers = outliers_among(nodes);
      const auto planted = std::ranges::count_if(outliers, [](std::size_t i) { return i % 60 == 0; });
      EXPECT_GE(planted, 30) << formula << " " << noise;  // of 50
      EXPECT_LE(outliers.size() - static_cast<std::size_t>(planted), 6u) << formula << " " << noise;
      EXPECT_TRUE(std::ranges::is_sorted(outliers));
      const MeasuredNodes others = without_outliers(nodes);
      EXPECT_EQ(others.size(), nodes.size() - outliers.size());
      EXPECT_LE(outliers_among(others).size(), 2u);
    }
}

TEST(Outliers, AreOffByAFactorOfTwo) {
  // Every 60th sample is raised by a factor that is far more than the noise.
  const auto found = [](double factor) {
    MeasuredNodes nodes = noisy_nodes("ggx:alpha_x=0.4,alpha_y=0.4,f0=0.9,kd=0.1", 3000, 0.01, 0);
    for (std::size_t i = 0; i < nodes.size(); i += 60)
      for (std::size_t c = 0; c < nodes.samples.channels; ++c)
        nodes.samples.values[i * nodes.samples.channels + c] *= factor;
    return outliers_among(nodes).size();
  };
  EXPECT_EQ(found(1.6), 0u);
  EXPECT_GE(found(4), 20u);
}

TEST(Outliers, AreNoPeaks) {
  // few samples of a narrow lobe: one alone may stand in it
  for (const std::size_t count : {100, 300, 3000})
    for (const char* formula :
         {"ggx:alpha_x=0.03,alpha_y=0.03,f0=0.9,kd=0.05", "ggx:alpha_x=0.02,alpha_y=0.2,f0=0.8"})
      EXPECT_LE(outliers_among(noisy_nodes(formula, count, 0.05, 0)).size(), count / 300 + 1)
          << formula << " " << count;
}

TEST(Outliers, AreNoSteepRiseTowardsTheHorizon) {
  // the few samples that are nearest to the horizon differ from all others
  for (const double width : {0.02, 0.05, 0.1}) {
    MeasuredNodes nodes = noisy_nodes("ggx:alpha_x=0.5,alpha_y=0.5,f0=0.04,kd=0.3", 3000, 0.05, 0);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const DirectionPair& pair = nodes.samples.pairs[i];
      const double rise = 1 + 30 * std::exp(-std::min(pair.wi.z, pair.wo.z) / width);
      for (std::size_t c = 0; c < nodes.samples.channels; ++c)
        nodes.samples.values[i * nodes.samples.channels + c] *= rise;
    }
    EXPECT_LE(outliers_among(nodes).size(), 1u) << width;
  }
}

TEST(Outliers, AreFew) {
  // of every third sample nobody can say which are right, and of a few samples neither
  EXPECT_TRUE(outliers_among(noisy_nodes("ggx:alpha_x=0.3,alpha_y=0.3,f0=0.8", 40, 0.05, 10)).empty());
  const MeasuredNodes many = noisy_nodes("ggx:alpha_x=0.3,alpha_y=0.3,f0=0.8", 2000, 0.05, 3);
  EXPECT_LE(static_cast<double>(outliers_among(many).size()), 0.1 * 2000);
  EXPECT_TRUE(outliers_among(MeasuredNodes{.samples = {.channels = 1, .isotropic = true}}).empty());
}

TEST(Outliers, DoNotDependOnThreads) {
  const MeasuredNodes nodes = noisy_nodes("ggx:alpha_x=0.2,alpha_y=0.2,f0=0.9,kd=0.1", 2000, 0.05, 50);
  const auto found = [&](int threads) {
    const ThreadLimit limit(threads);
    return outliers_among(nodes);
  };
  EXPECT_EQ(found(1), found(3));
}

}  // namespace
}  // namespace burnish
