// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/scattered_brdf.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

Samples sample(std::size_t count, bool isotropic, double (*f)(Vec3, Vec3)) {
  Samples samples{1, isotropic, draw_pairs(count, 11, false), {}};
  for (const auto& [wi, wo] : samples.pairs) samples.values.push_back(f(wi, wo));
  return samples;
}

double smooth(Vec3 wi, Vec3 wo) {
  return 1 + wi.z * wo.z + 0.5 * (wi.x * wo.x + wi.y * wo.y);
}

double brushed(Vec3 wi, Vec3 wo) {
  return 2 + (wi.x + wo.x) * (wi.x + wo.x) - 0.3 * wo.y;
}

double one(Vec3, Vec3) {
  return 1;
}

Vec3 place(SampleRule rule, Vec3 wi, Vec3 wo) {
  const HalfDiff angles = to_half_diff(wi, wo);
  if (rule == SampleRule::mean_in_half_difference)
    return {std::sqrt(angles.theta_h / kHalfPi), angles.theta_d / kHalfPi,
            std::sin(angles.theta_h) * std::sin(angles.theta_d) * std::abs(std::cos(angles.phi_d))};
  const double turn = std::abs(std::remainder(phi_of(wi) - phi_of(wo), kTwoPi));
  return {std::sin(theta_of(wi)) * std::sin(theta_of(wo)), turn / kPi, wi.z * wo.z};
}

/// The definition, over all samples: doubled radius until three are in reach.
double by_exhaustion(SampleRule rule, const Samples& samples, double radius2, Vec3 wi, Vec3 wo) {
  const auto distance2 = [&](const DirectionPair& pair) {
    const Vec3 apart = place(rule, pair.wi, pair.wo) - place(rule, wi, wo);
    return dot(apart, apart);
  };
  for (;; radius2 *= 2) {
    double sum = 0, weights = 0;
    int found = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (const double d2 = distance2(samples.pairs[i]); d2 <= radius2) {
        ++found;
        weights += std::exp(-100 * d2);
        sum += std::exp(-100 * d2) * samples.values[i];
      }
    if (found >= 3) return sum / weights;
  }
}

TEST(ScatteredBrdf, EqualsTheWeightedMeanOverAllSamples) {
  const Samples samples = sample(1000, true, smooth);
  for (const SampleRule rule : {SampleRule::mean_in_half_difference, SampleRule::mean_in_angles}) {
    const ScatteredBrdf brdf(samples, rule);
    EXPECT_EQ(brdf.initial_radius2(), 0.001);
    for (const auto& [wi, wo] : draw_pairs(200, 2, false)) {
      double f;
      ASSERT_TRUE(brdf.eval(wi, wo, {&f, 1}));
      EXPECT_NEAR(f, by_exhaustion(rule, samples, 0.001, wi, wo), 1e-9);
    }
  }
}

TEST(ScatteredBrdf, KeepsHighlightsBetterThanTheSpaceOfAngles) {
  const auto glossy = [](Vec3 wi, Vec3 wo) { return 0.1 + 20 * std::pow(half_vector(wi, wo).z, 300); };
  const Samples samples = sample(3000, true, glossy);
  const ScatteredBrdf half_difference(samples, SampleRule::mean_in_half_difference),
      angles(samples, SampleRule::mean_in_angles);
  double error = 0, error_of_angles = 0, f;
  for (const auto& [wi, wo] : draw_pairs(2000, 12, false)) {
    half_difference.eval(wi, wo, {&f, 1});
    error += std::abs(std::log(f / glossy(wi, wo)));
    angles.eval(wi, wo, {&f, 1});
    error_of_angles += std::abs(std::log(f / glossy(wi, wo)));
  }
  EXPECT_LT(error, 0.5 * error_of_angles);
}

TEST(ScatteredBrdf, ReproducesAConstant) {
  double f;
  const ScatteredBrdf constant(sample(500, true, one), SampleRule::mean_in_half_difference);
  for (const auto& [wi, wo] : draw_pairs(500, 3, false)) {
    ASSERT_TRUE(constant.eval(wi, wo, {&f, 1}));
    EXPECT_NEAR(f, 1, 1e-14);
  }
}

TEST(ScatteredBrdf, ApproximatesASmoothIsotropicFunction) {
  const ScatteredBrdf brdf(sample(20000, true, smooth), SampleRule::mean_in_half_difference);
  double error = 0, f;
  const auto pairs = draw_pairs(2000, 4, false);
  for (const auto& [wi, wo] : pairs) {
    ASSERT_TRUE(brdf.eval(wi, wo, {&f, 1}));
    error += std::abs(f / smooth(wi, wo) - 1);
  }
  EXPECT_LT(error / 2000, 0.02);
}

TEST(ScatteredBrdf, ApproximatesASmoothAnisotropicFunction) {
  const ScatteredBrdf brdf(sample(20000, false, brushed), SampleRule::mean_in_half_difference);
  double error = 0, f;
  int known = 0;
  for (const auto& [wi, wo] : draw_pairs(2000, 5, false))
    if (brdf.eval(wi, wo, {&f, 1})) {
      error += std::abs(f / brushed(wi, wo) - 1);
      ++known;
    }
  EXPECT_GT(known, 1900);
  EXPECT_LT(error / known, 0.05);
}

TEST(ScatteredBrdf, IsReciprocalAndTurnsFreelyWhereIsotropic) {
  const ScatteredBrdf brdf(sample(3000, true, smooth), SampleRule::mean_in_half_difference);
  Pcg32 random(6);
  for (const auto& [wi, wo] : draw_pairs(500, 6, false)) {
    const double turn = kTwoPi * random.uniform();
    double f, swapped, turned;
    brdf.eval(wi, wo, {&f, 1});
    brdf.eval(wo, wi, {&swapped, 1});
    brdf.eval(spherical_direction(theta_of(wi), phi_of(wi) + turn),
              spherical_direction(theta_of(wo), phi_of(wo) + turn), {&turned, 1});
    EXPECT_DOUBLE_EQ(f, swapped);
    // A sample at the rim of the search may change sides in the last bit.
    EXPECT_NEAR(f, turned, 0.02);
  }
}

TEST(ScatteredBrdf, KnowsNothingFarFromItsSamples) {
  Samples samples{1, true, {}, {}};
  for (int i = 0; i < 5; ++i) {
    samples.pairs.push_back({spherical_direction(0.1 + 0.01 * i, 0), spherical_direction(0.1, kPi)});
    samples.values.push_back(1);
  }
  const ScatteredBrdf brdf(samples, SampleRule::mean_in_half_difference);
  double f;
  EXPECT_TRUE(brdf.eval(spherical_direction(0.12, 1), spherical_direction(0.1, 1 + kPi), {&f, 1}));
  EXPECT_NEAR(f, 1, 1e-14);
  EXPECT_FALSE(brdf.eval(spherical_direction(1.4, 0), spherical_direction(1.4, 0), {&f, 1}));
  EXPECT_EQ(f, 0);
  EXPECT_TRUE(brdf.eval({1, 0, 0}, {0, 0, 1}, {&f, 1}));
  EXPECT_EQ(f, 0);
}

TEST(ScatteredBrdf, TakesASubsetOfTheSamples) {
  const Samples samples = sample(100, true, smooth);
  std::vector<std::size_t> subset;
  for (std::size_t i = 0; i < 100; i += 2) subset.push_back(i);
  const ScatteredBrdf brdf(samples, subset);
  EXPECT_EQ(brdf.samples().size(), 50u);
  const Samples chosen = select(samples, subset);
  EXPECT_EQ(chosen.pairs[3], samples.pairs[6]);
  EXPECT_EQ(chosen.values[3], samples.values[6]);
}

TEST(ScatteredBrdf, RefusesAnEmptyOrInconsistentSet) {
  EXPECT_THROW(ScatteredBrdf(Samples{1, true, {}, {}}), Error);
  EXPECT_THROW(ScatteredBrdf(Samples{3, true, {{}}, {1}}), Error);
  EXPECT_THROW(ScatteredBrdf(Samples{1, false, {{}}, {1}}, SampleRule::mean_in_angles), Error);
}

// An even scan of a matt surface, and one a hundred times as dense about a narrow lobe.
TEST(ScatteredBrdf, IsSharperWhereAScanIsDenser) {
  const Vec3 wi = spherical_direction(0.5, 0);
  const auto truth = [&](Vec3 wo) { return 0.1 + 50 * std::exp(-std::pow(angle_between(wi, wo) / 0.02, 2)); };
  Samples samples{1, true, {}, {}};
  const auto add = [&](Vec3 wo) {
    samples.pairs.push_back({wi, wo});
    samples.values.push_back(truth(wo));
  };
  for (int theta = 0; theta < 16; ++theta)
    for (int phi = 0; phi < 90; ++phi) add(spherical_direction(0.1 * theta, radians(4 * phi)));
  constexpr int kReach = 30;
  for (int x = -kReach; x <= kReach; ++x)
    for (int y = -kReach; y <= kReach; ++y) add(normalize(wi + 0.002 * Vec3{x * wi.z, 1.0 * y, -x * wi.x}));
  const ScatteredBrdf brdf(samples, SampleRule::mean_in_half_difference);
  double f;
  ASSERT_TRUE(brdf.eval(wi, wi, {&f, 1}));
  EXPECT_NEAR(f / truth(wi), 1, 0.1);
  const Vec3 beside = spherical_direction(0.52, 0);
  ASSERT_TRUE(brdf.eval(wi, beside, {&f, 1}));
  EXPECT_NEAR(f / truth(beside), 1, 0.2);
}

// ---- Kriged samples

double mean_error(const ScatteredBrdf& brdf, double (*truth)(Vec3, Vec3), std::uint64_t seed) {
  double error = 0, f;
  std::size_t known = 0;
  for (const auto& [wi, wo] : draw_pairs(1000, seed, false))
    if (std::min(wi.z, wo.z) > 0.15 && brdf.eval(wi, wo, {&f, 1})) {
      error += std::abs(std::log(f / truth(wi, wo)));
      ++known;
    }
  return error / static_cast<double>(known);
}

double glossy(Vec3 wi, Vec3 wo) {
  return 0.1 + 20 * std::pow(half_vector(wi, wo).z, 300);
}

double ridged(Vec3 wi, Vec3 wo) {
  return 0.5 + std::exp(-4 * (wi.x + wo.x) * (wi.x + wo.x)) - 0.1 * (wi.y + wo.y);
}

TEST(KrigedScatteredBrdf, IsTheSampleAtASample) {
  for (const bool isotropic : {true, false}) {
    Samples samples = sample(400, isotropic, isotropic ? glossy : brushed);
    samples.values[3] = -0.25;  // noise stays, until results are cut
    const ScatteredBrdf brdf(samples);
    double f;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto [wi, wo] = samples.pairs[i];
      ASSERT_TRUE(brdf.eval_raw(wi, wo, {&f, 1}));
      EXPECT_DOUBLE_EQ(f, samples.values[i]);
      brdf.eval_raw(wo, wi, {&f, 1});
      EXPECT_DOUBLE_EQ(f, samples.values[i]);
    }
    brdf.eval(samples.pairs[3].wi, samples.pairs[3].wo, {&f, 1});
    EXPECT_EQ(f, 0);
  }
}

TEST(KrigedScatteredBrdf, IsTheMeanOfRepeatsAndOfExchangedOnes) {
  Samples samples = sample(50, true, smooth);
  const auto [wi, wo] = samples.pairs[7];
  samples.pairs.push_back({wo, wi});
  samples.values.push_back(samples.values[7] + 0.3);
  double f;
  ScatteredBrdf(samples).eval(wi, wo, {&f, 1});
  EXPECT_NEAR(f, samples.values[7] + 0.15, 1e-12);
}

TEST(KrigedScatteredBrdf, IsFarNearerToTheTruthThanMeans) {
  const Samples isotropic = sample(2000, true, glossy), anisotropic = sample(2000, false, ridged);
  EXPECT_LT(mean_error(ScatteredBrdf(isotropic), glossy, 12),
            0.2 * mean_error(ScatteredBrdf(isotropic, SampleRule::mean_in_half_difference), glossy, 12));
  EXPECT_LT(mean_error(ScatteredBrdf(anisotropic), ridged, 13),
            0.2 * mean_error(ScatteredBrdf(anisotropic, SampleRule::mean_in_half_difference), ridged, 13));
}

TEST(KrigedScatteredBrdf, KnowsNothingFarFromItsSamples) {
  Samples samples{1, true, {}, {}};
  for (int i = 0; i < 5; ++i) {
    samples.pairs.push_back({spherical_direction(0.1 + 0.01 * i, 0), spherical_direction(0.1, kPi)});
    samples.values.push_back(1);
  }
  const ScatteredBrdf brdf(samples);
  double f;
  EXPECT_TRUE(brdf.eval(spherical_direction(0.125, 0.1), spherical_direction(0.1, kPi), {&f, 1}));
  EXPECT_NEAR(f, 1, 1e-3);
  EXPECT_FALSE(brdf.eval(spherical_direction(1.4, 0), spherical_direction(1.4, 0), {&f, 1}));
  EXPECT_EQ(f, 0);
}

TEST(KrigedScatteredBrdf, KnowsSamplesAlongTheHorizonAlone) {
  Samples samples{1, true, {}, {}};
  for (int i = 0; i < 4; ++i) {
    samples.pairs.push_back({spherical_direction(1.56, 0), spherical_direction(0.1 * i, 1)});
    samples.values.push_back(2);
  }
  const ScatteredBrdf brdf(samples);
  double f;
  EXPECT_TRUE(brdf.eval(samples.pairs[2].wi, samples.pairs[2].wo, {&f, 1}));
  EXPECT_EQ(f, 2);
  EXPECT_FALSE(brdf.eval(samples.pairs[2].wi, spherical_direction(0.25, 1), {&f, 1}));
  EXPECT_EQ(brdf.kriged(), nullptr);
}

TEST(KrigedScatteredBrdf, IsMadeOfFewSamplesAndOfSuchAsCannotBeScored) {
  double f;
  const Vec3 wi = spherical_direction(0.5, 0), wo = spherical_direction(0.6, 2);
  for (const bool isotropic : {true, false})
    for (const int count : {1, 2, 3, 7}) {
      Samples few{1, isotropic, {}, {}};
      for (int i = 0; i < count; ++i) {
        few.pairs.push_back({wi, spherical_direction(0.6 + 0.01 * i, 2)});
        few.values.push_back(1);
      }
      ASSERT_TRUE(ScatteredBrdf(few).eval(wi, normalize(wo + Vec3{0.01, 0, 0}), {&f, 1})) << count;
      EXPECT_NEAR(f, 1, 1e-3);
    }
  // along the horizon but for the first and the last of seven incidences
  Samples samples{1, true, {}, {}};
  for (int i = 0; i < 7; ++i)
    for (int o = 0; o < 8; ++o) {
      samples.pairs.push_back({spherical_direction(i == 0   ? 0.3
                                                   : i == 6 ? 0.4
                                                            : 1.45 + 0.01 * i,
                                                   0),
                               spherical_direction(0.1 * o, 0.3 * o)});
      samples.values.push_back(1);
    }
  EXPECT_TRUE(
      ScatteredBrdf(samples).eval(spherical_direction(0.35, 0), spherical_direction(0.15, 0.4), {&f, 1}));
  EXPECT_NEAR(f, 1, 1e-2);
  std::erase_if(samples.pairs, [](const DirectionPair& pair) { return pair.wi.z > 0.5; });
  samples.values.resize(samples.pairs.size());
  EXPECT_TRUE(
      ScatteredBrdf(samples).eval(spherical_direction(1.475, 0), spherical_direction(0.15, 0.4), {&f, 1}));
  EXPECT_NEAR(f, 1, 1e-2);
}

// A goniometer's grid, where many places and angles tie: neither ties nor what follows from them hang on last bits, which
// differ between processors and standard libraries.
TEST(KrigedScatteredBrdf, IsTheSameWhereDirectionsDifferByRounding) {
  BURNISH_SKIP_WHERE_SANITIZED();
  Samples grid{1, true, {}, {}};
  Pcg32 random(5);
  for (const double theta_i : {15., 30., 45., 60.})
    for (int o = 0; o <= 8; ++o)
      for (int p = -6; p <= 6; ++p) {
        const DirectionPair pair{spherical_direction(radians(theta_i), 0),
                                 spherical_direction(radians(10 * o), radians(30 * p))};
        const double outlier = random.uniform() < 0.02 ? 4 : 1;
        grid.pairs.push_back(pair);
        grid.values.push_back(outlier * glossy(pair.wi, pair.wo) * std::exp(0.1 * random.uniform()));
      }
  Samples other = grid;
  for (DirectionPair& pair : other.pairs)
    for (Vec3* w : {&pair.wi, &pair.wo})
      for (double* x : {&w->x, &w->y, &w->z}) *x *= 1 + 4e-16 * (random.uniform() - 0.5);
  const ScatteredBrdf brdf(grid), moved(other);
  double f = 0, g = 0;
  for (const auto& [wi, wo] : draw_pairs(500, 3, false)) {
    EXPECT_EQ(brdf.eval(wi, wo, {&f, 1}), moved.eval(wi, wo, {&g, 1}));
    EXPECT_NEAR(f, g, 1e-5 * f);
  }
}

// Whoever asks first makes the function, within a loop of others who ask.
TEST(KrigedScatteredBrdf, IsTheSameForCopiesAndThreads) {
  const ScatteredBrdf brdf(sample(600, true, glossy)), copy = brdf, other(brdf.samples());
  const std::vector<DirectionPair> pairs = draw_pairs(512, 3, false);
  std::vector<double> values(pairs.size());
  for_each_chunk(pairs.size(), 4, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) brdf.eval(pairs[i].wi, pairs[i].wo, {&values[i], 1});
  });
  EXPECT_EQ(copy.kriged(), brdf.kriged());
  double f;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    other.eval(pairs[i].wi, pairs[i].wo, {&f, 1});
    EXPECT_EQ(f, values[i]);
  }
}

}  // namespace
}  // namespace burnish
