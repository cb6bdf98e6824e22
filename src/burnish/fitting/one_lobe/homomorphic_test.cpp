// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/one_lobe/conjugate_gradients.h>
#include <burnish/fitting/one_lobe/homomorphic.h>
#include <burnish/fitting/one_lobe/log_error.h>
#include <burnish/fitting/one_lobe/normal_equations.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {
namespace {

// A model whose tables vary little between nodes: the fit interpolates logarithms, the model values, which
// differ by an eighth of the squared step.
FactoredBrdf random_model(const ModelSpec& spec, std::size_t channels) {
  Pcg32 random(5);
  std::vector<Table> tables;
  for (const ModelSpec::TableSpec& t : spec.tables) {
    Table table{.name = t.name, .layout = t.layout, .channels = t.shared ? 1 : channels};
    for (int y = 0; y < t.layout.height; ++y)
      for (int x = 0; x < t.layout.width; ++x)
        for (std::size_t c = 0; c < table.channels; ++c)
          table.values.push_back(
              static_cast<float>(std::sin(0.1 * x + 0.15 * y + c) + 0.02 * random.uniform()));
    tables.push_back(std::move(table));
  }
  const Lobe lobe{.scale = std::vector<double>(channels, -1), .factors = spec.lobes[0]};
  return from_log_tables(channels, tables, {lobe}, TableFormat::single);
}

double mean_error(const FactoredBrdf& truth, const FactoredBrdf& fit) {
  const auto channels = truth.channels();
  std::vector<double> f(channels), g(channels);
  double sum = 0;
  const auto pairs = draw_pairs(2000, 77, false);
  for (const auto& [wi, wo] : pairs) {
    truth.eval(wi, wo, f);
    fit.eval(wi, wo, g);
    for (std::size_t c = 0; c < channels; ++c) sum += std::abs(std::log(g[c] / f[c]));
  }
  return sum / static_cast<double>(pairs.size() * channels);
}

struct Case {
  const char* model;
  std::vector<std::string> tables;
  std::size_t channels;
};

class Homomorphic : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Models, Homomorphic,
                         testing::Values(Case{"pqp", {"p=8", "q=12"}, 3},
                                         Case{"pqpr", {"p=6", "q=9,power:0.5", "r=5"}, 1},
                                         Case{"pqpr", {"p=6,shared", "q=9", "r=5"}, 3},
                                         Case{"pqp", {"p=6x6", "q=9x9,rational:0.5"}, 3},
                                         Case{"p(wo) p(wi) q(h) s(wi+wo+0.6n)", {"p=5", "q=5x5", "s=7"}, 5},
                                         Case{"p(wo) p(wi) g(theta_h,theta_d)", {"p=5,shared", "g=6x7"}, 3}));

TEST_P(Homomorphic, RecoversAProductOfTables) {
  const Case& c = GetParam();
  const ModelSpec spec = parse_model_spec(c.model, c.tables, true);
  const FactoredBrdf truth = random_model(spec, c.channels);
  const SampleSource source = from_brdf(truth, 20'000, 1, true);
  const HomomorphicFit fit = fit_homomorphic(
      source, spec, {.smooth = 1e-12, .floor = 1e-9, .format = TableFormat::single, .tolerance = 1e-6});
  EXPECT_LT(mean_error(truth, fit.brdf), 0.01) << to_string(fit.summary.stop_reason);
  EXPECT_LT(fit.summary.error_after, 0.05 * fit.summary.error_before);
  EXPECT_EQ(fit.brdf.reciprocal(), truth.reciprocal());
}

TEST(HomomorphicFormats, EachTableIsStoredInItsOwn) {
  const auto spec_with = [](const char* p) {
    return parse_model_spec("pqpr", std::vector<std::string>{p, "q=12", "r=6,shared"}, true);
  };
  const ModelSpec spec = spec_with("p=8,unorm8");
  const FactoredBrdf truth = random_model(spec, 3);
  const SampleSource source = from_brdf(truth, 20'000, 1, true);
  const FactoredBrdf fit = fit_homomorphic(source, spec, {.format = TableFormat::rgb9e5}).brdf;
  EXPECT_EQ(fit.tables()[0].format, TableFormat::unorm8);
  EXPECT_EQ(fit.tables()[1].format, TableFormat::rgb9e5);
  EXPECT_EQ(fit.tables()[2].format, TableFormat::half);
  EXPECT_EQ(fit.table_bytes(), 8 * 3 * 1 + 12 * 4 + 6 * 2u);
  // no entry is below e^-2.2: two lookups off by 1/510, one by 1/511 and one by 2^-11
  const FactoredBrdf unrounded =
      fit_homomorphic(source, spec_with("p=8"), {.format = TableFormat::single}).brdf;
  EXPECT_LT(mean_error(unrounded, fit), std::exp(2.2) * (2.0 / 510 + 1.0 / 511) + 0x1p-11);
  EXPECT_THROW(
      fit_homomorphic(from_brdf(random_model(spec, 1), 100, 1, true), spec, {.format = TableFormat::rgb9e5}),
      Error);
}

TEST_P(Homomorphic, BothSolversFindTheSameModel) {
  const Case& c = GetParam();
  const ModelSpec spec = parse_model_spec(c.model, c.tables, true);
  const FactoredBrdf truth = random_model(spec, c.channels);
  const SampleSource source = from_brdf(truth, 3000, 1, true);
  const RowMaker rows(source, spec, 1e-3, 1e-3);
  const HomomorphicOptions options{.smooth = 1e-4, .max_iterations = 2000, .tolerance = 1e-8};
  const LogSolution direct = solve_normal_equations(rows, options);
  const LogSolution iterative = solve_by_conjugate_gradients(rows, options);
  EXPECT_EQ(direct.samples, iterative.samples);
  EXPECT_NEAR(direct.summary.error_before, iterative.summary.error_before,
              1e-4 * direct.summary.error_before);
  EXPECT_NEAR(direct.summary.error_after, iterative.summary.error_after, 2e-3 * direct.summary.error_after);
}

TEST_P(Homomorphic, DoesNotDependOnTheNumberOfThreads) {
  const Case& c = GetParam();
  const ModelSpec spec = parse_model_spec(c.model, c.tables, true);
  const FactoredBrdf truth = random_model(spec, c.channels);
  const SampleSource source = from_brdf(truth, 40'000, 1, true);
  const HomomorphicFit all = fit_homomorphic(source, spec, {.reweightings = 1});
  const ThreadLimit one(1);
  EXPECT_TRUE(fit_homomorphic(source, spec, {.reweightings = 1}).brdf == all.brdf);
}

TEST(HomomorphicFitting, FillsHolesSmoothly) {
  // No sample has its half vector within 20 degrees of the normal.
  const AnalyticBrdf brdf = parse_analytic("ggx:alpha_x=0.4,alpha_y=0.6");
  SampleSource source = from_brdf(brdf, 30'000, 1, true);
  const double cap = std::cos(radians(20));
  source.fill = [fill = source.fill, cap](std::size_t begin, std::span<DirectionPair> pairs,
                                          std::span<double> values, std::span<double> weights) {
    fill(begin, pairs, values, weights);
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (half_vector(pairs[i].wi, pairs[i].wo).z > cap) weights[i] = 0;
  };
  const ModelSpec spec = parse_model_spec("pqp", std::vector<std::string>{"p=16x16", "q=16x16"}, false);
  const FactoredBrdf fit = fit_homomorphic(source, spec, {.smooth = 1e-6}).brdf;
  double worst = 0;
  std::array<double, 3> f, g;
  for (const auto& [wi, wo] : draw_pairs(3000, 4, false)) {
    if (half_vector(wi, wo).z < cap || wi.z < 0.3 || wo.z < 0.3) continue;
    brdf.eval(wi, wo, f);
    fit.eval(wi, wo, g);
    worst = std::max(worst, std::abs(std::log(g[0] / f[0])));
  }
  EXPECT_LT(worst, 1.0);  // the hole's centre is extrapolated: the right magnitude, not a wild value
}

TEST(HomomorphicFitting, ZerosAndNegativesCountAsTheFloor) {
  const ModelSpec spec = parse_model_spec("pqp", std::vector<std::string>{"p=4", "q=4"}, true);
  Samples samples{.channels = 1, .isotropic = true, .pairs = draw_pairs(500, 1, true)};
  for (std::size_t i = 0; i < samples.size(); ++i) samples.values.push_back(i % 2 ? 0.0 : -0.5);
  const FactoredBrdf fit =
      fit_homomorphic(from_samples(samples, true), spec, {.floor = 1e-3, .format = TableFormat::single}).brdf;
  double f;
  for (const auto& [wi, wo] : samples.pairs) {
    fit.eval(wi, wo, {&f, 1});
    EXPECT_NEAR(f, 1e-3, 1e-5);
  }
}

TEST(HomomorphicFitting, ReweightingWithstandsOutliers) {
  const ModelSpec spec = parse_model_spec("pqp", std::vector<std::string>{"p=6", "q=10"}, true);
  const FactoredBrdf truth = random_model(spec, 1);
  Samples samples{.channels = 1, .isotropic = true, .pairs = draw_pairs(4000, 1, true)};
  Pcg32 random(3);
  for (const auto& [wi, wo] : samples.pairs) {
    double f;
    truth.eval(wi, wo, {&f, 1});
    samples.values.push_back(random.uniform() < 0.1 ? 50 * f : f);
  }
  const SampleSource source = from_samples(samples, true);
  const FactoredBrdf plain = fit_homomorphic(source, spec, {}).brdf;
  const HomomorphicFit robust = fit_homomorphic(source, spec, {.reweightings = 8});
  EXPECT_GT(robust.reweightings, 0);
  EXPECT_LT(mean_error(truth, robust.brdf), 0.25 * mean_error(truth, plain));
}

TEST(HomomorphicFitting, RefusesWhatItCannotFit) {
  const AnalyticBrdf brdf = parse_analytic("lambert");
  const SampleSource source = from_brdf(brdf, 100, 1, false);
  const ModelSpec pqp = parse_model_spec("pqp", {}, true);
  EXPECT_THROW(fit_homomorphic(source, parse_model_spec("p(wi) p(wo) + q(h)", {}, true), {}), Error);
  EXPECT_THROW(fit_homomorphic(source, pqp, {.smooth = -1}), Error);
  EXPECT_THROW(fit_homomorphic(source, pqp, {.floor = 0}), Error);
  EXPECT_THROW(fit_homomorphic(source, pqp, {.floor = 1.5}), Error);
  EXPECT_THROW(fit_homomorphic(SampleSource{.channels = 1}, pqp, {}), Error);
  SampleSource blind = source;
  blind.fill = [](std::size_t, std::span<DirectionPair> pairs, std::span<double>, std::span<double> weights) {
    for (std::size_t i = 0; i < pairs.size(); ++i) weights[i] = 0;
  };
  EXPECT_THROW(fit_homomorphic(blind, pqp, {}), Error);
  EXPECT_THROW(fit_homomorphic(blind, parse_model_spec("pqp", {}, false), {}), Error);
}

}  // namespace
}  // namespace burnish
