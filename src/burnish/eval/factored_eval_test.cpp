// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include <burnish/eval/factored_eval.h>
#include <burnish/eval/power_span.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

// Further shapes: long and short lines, other numbers of channels, steep warps.
const ModelCase kFurtherModels[] = {
    {"LargeDisks", "pqp", {"p=64x64", "q=64x64,rational:0.2"}, 3},
    {"PowerDisk", "q(h) r(theta_d)", {"q=9x9,power:0.3", "r=12,power:0.5"}, 1},
    {"PowerDiskHalf", "p(wo) q(h) p(wi)", {"p=16,power:0.7", "q=16x16,power:0.5"}, 3},
    {"DifferenceTwice", "a(d) b(d)", {"a=12x12", "b=8"}, 3},
    {"Grey", "pqpr", {"p=16x16", "q=32"}, 1},
    {"LongLines", "pqpr", {"p=128", "q=129,rational:0.05", "r=150"}, 3},
    {"ShortLines", "pqpr", {"p=2", "q=65", "r=17"}, 3},
    {"TwoChannels", "pqpr", {"p=5", "q=8x8", "r=65,shared"}, 2},
    {"SharedPair", "p(wo) q(h) p(wi)", {"p=200,shared", "q=12"}, 4},
    {"LongVolume", "g(theta_h,theta_d,phi_d)", {"g=28x14x8,power:0.5"}, 3},
    {"VolumeAndLine", "z(theta_h) g(theta_h,theta_d,phi_d)", {"z=150,power:0.5", "g=12x7x5,power:0.5"}, 3},
    {"VolumeAndGreyLine", "g(theta_h,theta_d,phi_d) z(theta_h)", {"g=9x2x3", "z=2,shared,power:0.5"}, 3},
    {"VolumeOfRoots",
     "z(theta_h) g(theta_h,theta_d,phi_d)",
     {"z=31", "g=6x7x8,power:0.5,power:0.5,power:0.5"},
     3},
    {"GreyVolumeAndLine", "z(theta_h) g(theta_h,theta_d,phi_d)", {"z=20,power:0.5", "g=8x7x5,power:0.5"}, 1},
    {"VolumePair",
     "v(wi,theta_h,phi_d) v(wo,theta_h,phi_d) + u(wi,wi+wo+0.4n,d)",
     {"v=5x4x3,power:0.7", "u=3x3x5"},
     4},
    {"ManySteps",
     "a(wo) b(wi) c(h) d(d) e(wi,wo) f(h,d) g(wi,wo,h) i(0.3wi+0.9wo) k(0.5wi+wo) l(m) o(theta_t) s(h)",
     {"a=9x9", "b=8x8", "c=7,rational:0.3", "d=6", "e=5x6", "f=4x9", "g=3x4x5", "i=9", "k=8", "l=7", "o=6",
      "s=5,power:0.4"},
     3},
    {"Spectral", "p(wo) q(h) p(wi) + s(h) t(theta_d)", {"p=8x8", "q=32", "s=8,shared"}, 31},
};

std::vector<ModelCase> all_models() {
  std::vector<ModelCase> models(std::begin(kModelCases), std::end(kModelCases));
  models.insert(models.end(), std::begin(kFurtherModels), std::end(kFurtherModels));
  return models;
}

// Random tables: log values uniform in [-2, 0], lobes of different weight.
FactoredBrdf random_model(const ModelCase& model) {
  Pcg32 random(5);
  return model_of(model, TableFormat::half, random,
                  [&](std::size_t, const TableLayout&, int, int, int) { return -2 * random.uniform(); });
}

// Returns random pairs, corners, and some pairs below the horizon. They are more than one block, and not whole
// blocks.
std::vector<DirectionPair> test_pairs() {
  std::vector<DirectionPair> pairs = draw_pairs(997, 3, false);
  for (const DirectionPair& pair : corner_pairs()) pairs.push_back(pair);
  return as_floats(std::move(pairs));
}

struct Planes {
  std::vector<float> component[6];

  explicit Planes(std::span<const DirectionPair> pairs) {
    for (const auto& [wi, wo] : pairs) {
      const double values[] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
      for (int k = 0; k < 6; ++k) component[k].push_back(static_cast<float>(values[k]));
    }
  }
  DirectionSpans spans() const {
    return {component[0], component[1], component[2], component[3], component[4], component[5]};
  }
};

std::vector<float> batched(const FactoredEvaluator& evaluator, std::span<const DirectionPair> pairs) {
  std::vector<float> f(pairs.size() * evaluator.channels(), std::numeric_limits<float>::quiet_NaN());
  evaluator.eval(Planes(pairs).spans(), f);
  return f;
}

// The parameters are a model and one of the compiled instruction sets that this processor has.
class FactoredEvaluatorTest : public testing::TestWithParam<std::tuple<ModelCase, std::string>> {
 protected:
  static FactoredBrdf model() { return random_model(std::get<0>(GetParam())); }

 private:
  SimdTargetLimit limit_{std::get<1>(GetParam())};
};

TEST_P(FactoredEvaluatorTest, AgreesWithTheDoubleReferenceWithinItsBound) {
  const FactoredBrdf brdf = model();
  const FactoredEvaluator evaluator(brdf);
  ASSERT_EQ(evaluator.channels(), brdf.channels());
  EXPECT_LT(evaluator.rounding_bound(), 0.02);  // random tables are this steep
  const auto pairs = test_pairs();
  const std::vector<float> f = batched(evaluator, pairs);
  std::vector<double> truth(brdf.channels());
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& [wi, wo] = pairs[i];
    brdf.eval(wi, wo, truth);
    const bool lit = wi.z > 0 && wo.z > 0;
    const double bound = lit ? evaluator.rounding_bound() * cancellation(brdf, wi, wo) : 0;
    for (std::size_t c = 0; c < truth.size(); ++c) {
      const double got = f[c * pairs.size() + i];
      ASSERT_LE(std::abs(got - truth[c]), bound * truth[c])
          << "pair " << i << " channel " << c << ": " << got << " for " << truth[c];
      if (i < 997) {
        squares += std::pow(got / truth[c] - 1, 2);
        ++count;
      }
    }
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(count)), 2e-5);  // long tables are this steep
}

TEST_P(FactoredEvaluatorTest, GivesTheSameBitsForOneDirectionAndForMany) {
  const FactoredEvaluator evaluator(model());
  const auto pairs = test_pairs();
  const std::vector<float> f = batched(evaluator, pairs);
  std::vector<float> one(evaluator.channels());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    evaluator.eval(pairs[i].wi, pairs[i].wo, one);
    for (std::size_t c = 0; c < one.size(); ++c) ASSERT_EQ(one[c], f[c * pairs.size() + i]) << i;
  }
}

TEST_P(FactoredEvaluatorTest, OneDirectionIsAnythingToo) {
  const FactoredEvaluator evaluator(model());
  std::vector<float> one(evaluator.channels());
  std::vector<double> doubles(one.size());
  const Vec3 up{0, 0, 1};
  for (const double odd : std::initializer_list<double>{NAN, INFINITY, 1e30, 1e-40, 0, 1.02}) {
    evaluator.eval(up, {0, 0, odd}, one);
    for (const float f : one) EXPECT_TRUE(std::isnan(f)) << odd;
    evaluator.eval({odd, 0, 0}, up, one);
    for (const float f : one) EXPECT_TRUE(std::isnan(f)) << odd;
  }
  evaluator.eval(up, {0.6, 0, -0.8}, one);
  for (const float f : one) EXPECT_EQ(f, 0);
  evaluator.eval({0.6, 0, 0.8}, up, one);
  EXPECT_TRUE(evaluator.eval({0.6, 0, 0.8}, up, doubles));
  EXPECT_TRUE(std::ranges::equal(one, doubles));
}

TEST_P(FactoredEvaluatorTest, IsReciprocalToTheLastBitWhereTheModelIs) {
  const FactoredBrdf brdf = model();
  auto pairs = test_pairs();
  const std::vector<float> f = batched(FactoredEvaluator(brdf), pairs);
  for (auto& [wi, wo] : pairs) std::swap(wi, wo);
  EXPECT_EQ(f == batched(FactoredEvaluator(brdf), pairs), brdf.reciprocal());
}

TEST_P(FactoredEvaluatorTest, IsPositiveAboveTheHorizonAndZeroBelow) {
  const auto pairs = test_pairs();
  const std::vector<float> f = batched(FactoredEvaluator(model()), pairs);
  for (std::size_t i = 0; i < f.size(); ++i) {
    const auto& [wi, wo] = pairs[i % pairs.size()];
    EXPECT_EQ(f[i] > 0, wi.z > 0 && wo.z > 0);
    EXPECT_GE(f[i], 0);
  }
}

TEST_P(FactoredEvaluatorTest, SurvivesAnythingInPlaceOfDirections) {
  const double odd[] = {NAN, INFINITY, -INFINITY, 1e30, 1e-40, 0, 1};
  std::vector<DirectionPair> pairs;
  for (const double a : odd)
    for (const double b : odd)
      for (const double z : odd) pairs.push_back({{a, b, z}, {b, z, a}});
  for (const double length : {0.98, 0.992, 1.0, 1.008, 1.02}) {
    const Vec3 w = length * spherical_direction(0.5, 1.0);
    pairs.push_back({w, {0, 0, 1}});
    pairs.push_back({{0, 0, 1}, w});
  }
  const std::vector<float> f = batched(FactoredEvaluator(model()), pairs);
  const auto direction = [](Vec3 w) { return std::abs(dot(w, w) - 1) < 0.02; };
  const FactoredBrdf brdf = model();
  double most = 1e-4;  // entries of tables are at most 1
  for (const Lobe& lobe : brdf.lobes()) most += std::ranges::max(lobe.scale);
  for (std::size_t i = 0; i < f.size(); ++i) {
    const auto& [wi, wo] = pairs[i % pairs.size()];
    if (direction(wi) && direction(wo)) {
      EXPECT_GE(f[i], 0);
      EXPECT_LE(f[i], most);
    } else {
      EXPECT_TRUE(std::isnan(f[i])) << f[i];
    }
  }
}

TEST_P(FactoredEvaluatorTest, RowsGiveTheSameBitsAsPlanes) {
  const FactoredEvaluator evaluator(model());
  auto pairs = test_pairs();
  pairs[20].wi = {0, 0, 2};
  const std::vector<float> planes = batched(evaluator, pairs);
  const auto channels = evaluator.channels();
  std::vector<float> wi, wo;
  for (const DirectionPair& pair : pairs) {
    for (const double v : {pair.wi.x, pair.wi.y, pair.wi.z}) wi.push_back(static_cast<float>(v));
    for (const double v : {pair.wo.x, pair.wo.y, pair.wo.z}) wo.push_back(static_cast<float>(v));
  }
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{15}, std::size_t{16},
                                  std::size_t{17}, std::size_t{129}, pairs.size()}) {
    std::vector<float> f(channels * count + 1, -1.0f);
    evaluator.eval(DirectionRows{std::span(wi).first(3 * count), std::span(wo).first(3 * count)},
                   std::span(f).first(channels * count));
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < channels; ++c)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(f[i * channels + c]),
                  std::bit_cast<std::uint32_t>(planes[c * pairs.size() + i]))
            << count << ": " << i;
    EXPECT_EQ(f.back(), -1.0f);
  }
}

TEST_P(FactoredEvaluatorTest, TakesAnyNumberOfDirections) {
  const FactoredEvaluator evaluator(model());
  const auto pairs = test_pairs();
  const std::vector<float> all = batched(evaluator, pairs);
  for (std::size_t count : {0, 1, 2, 15, 16, 17, 127, 128, 129, 200}) {
    const std::vector<float> f = batched(evaluator, std::span(pairs).first(count));
    for (std::size_t i = 0; i < f.size(); ++i) {
      const std::size_t c = i / count;
      ASSERT_EQ(f[i], all[c * pairs.size() + i % count]) << count;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, FactoredEvaluatorTest,
                         testing::Combine(testing::ValuesIn(all_models()), testing::ValuesIn(simd_targets())),
                         [](const auto& test) {
                           return std::get<0>(test.param).name + ("On" + std::get<1>(test.param));
                         });

}  // namespace
}  // namespace burnish
