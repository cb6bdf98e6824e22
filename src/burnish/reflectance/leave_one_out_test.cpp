// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/kriged_nodes.h>
#include <burnish/reflectance/leave_one_out.h>
#include <burnish/reflectance/measured_nodes.h>

namespace burnish {
namespace {

/// Samples with noise at directions from everywhere.
Samples samples_of(const char* formula, std::size_t count, double noise) {
  const AnalyticBrdf brdf = parse_analytic(formula);
  const BrdfRef ref = brdf.ref();
  Samples samples{.channels = ref.channels()};
  Pcg32 random(7);
  const auto direction = [&] {
    const double z = 0.1 + 0.9 * random.uniform(), phi = kTwoPi * random.uniform(), r = std::sqrt(1 - z * z);
    return Vec3{r * std::cos(phi), r * std::sin(phi), z};
  };
  std::vector<double> f(ref.channels());
  for (std::size_t i = 0; i < count; ++i) {
    samples.pairs.push_back({direction(), direction()});
    ref.eval(samples.pairs.back().wi, samples.pairs.back().wo, f);
    const double factor = std::exp(noise * (2 * random.uniform() - 1));
    for (const double v : f) samples.values.push_back(v * factor);
  }
  return samples;
}

TEST(LeaveOneOut, PredictsWhatIsSmooth) {
  const Samples smooth = samples_of("ggx:alpha_x=0.6,alpha_y=0.6,f0=0.5,kd=0.3", 2000, 0);
  const LeaveOneOut others(smooth, true);
  ASSERT_EQ(others.size(), 2000u);
  double sum = 0;
  for (std::size_t i = 0; i < 200; ++i) sum += others.miss(10 * i).distance;
  EXPECT_LT(sum / 200, 0.05);
}

TEST(LeaveOneOut, PredictsAsKrigedNodesDo) {
  // of thirteen samples both take the twelve others; their means differ a little
  const Samples samples = samples_of("ggx:alpha_x=0.6,alpha_y=0.4,f0=0.5,kd=0.3", 60, 0.1);
  Samples few{.channels = samples.channels};
  for (std::size_t i = 0; i < samples.size() && few.size() <= LeaveOneOut::kPredicting; ++i) {
    if (std::min(samples.pairs[i].wi.z, samples.pairs[i].wo.z) < 0.2) continue;  // others are noisier
    few.pairs.push_back(samples.pairs[i]);
    few.values.insert(few.values.end(), samples.at(i).begin(), samples.at(i).end());
  }
  ASSERT_EQ(few.size(), LeaveOneOut::kPredicting + 1);
  const LeaveOneOut others(few, false);
  const KrigedNodes kriged(measured_nodes(few), LogCovariance(false));
  std::vector<double> f(few.channels);
  for (std::size_t i = 0; i < others.size(); ++i) {
    const std::size_t own = others.number(i);
    const DirectionPair& pair = few.pairs[own];
    kriged.eval_from(
        pair.wi, pair.wo, [&](std::size_t node) { return node != own; }, f);
    double distance = 0;
    for (std::size_t c = 0; c < f.size(); ++c)
      distance += std::abs(std::log((f[c] + KrigedNodes::kFloor) / (few.at(own)[c] + KrigedNodes::kFloor))) /
                  static_cast<double>(f.size());
    EXPECT_NEAR(others.miss(i).distance, distance, 0.05) << i;
  }
}

TEST(LeaveOneOut, DoesWithoutWhatIsLeftOut) {
  const Samples samples = samples_of("lambert", 30, 0);
  const LeaveOneOut others(samples, true);
  std::vector<std::uint8_t> left_out(30);
  for (std::size_t i = 0; i < 20; ++i) left_out[i] = 1;
  const auto near = others.nearest(25, 12, left_out);
  EXPECT_EQ(near.size(), 9u);
  for (const KdTree::Neighbour& one : near) EXPECT_TRUE(one.place >= 20 && one.place != 25);
  EXPECT_NEAR(others.miss(25, left_out).distance, 0, 1e-9);
}

TEST(LeaveOneOut, TellsIsotropicFromAnisotropic) {
  for (const std::size_t count : {100, 1000, 4000})
    for (const double noise : {0.0, 0.1}) {
      const auto of = [&](const char* formula) { return isotropy_errors(samples_of(formula, count, noise)); };
      const IsotropyErrors round = of("ggx:alpha_x=0.3,alpha_y=0.3,f0=0.8,kd=0.1"),
                           brushed = of("ggx:alpha_x=0.1,alpha_y=0.5,f0=0.8,kd=0.1"), flat = of("lambert");
      EXPECT_LT(round.isotropic, round.anisotropic) << count;
      EXPECT_GT(brushed.isotropic, brushed.anisotropic) << count;
      EXPECT_LE(flat.isotropic, 1.1 * flat.anisotropic + 1e-9) << count;
    }
  const IsotropyErrors few = isotropy_errors(samples_of("lambert", 20, 0));
  EXPECT_EQ(few.isotropic, 0);
  EXPECT_EQ(few.anisotropic, 0);
}

}  // namespace
}  // namespace burnish
