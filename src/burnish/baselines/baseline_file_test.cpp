// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/baselines/baseline_file.h>
#include <burnish/baselines/evaluation_cost.h>
#include <burnish/error.h>
#include <burnish/testing/baselines.h>
#include <burnish/testing/models.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using fixtures::random_anisotropic;
using fixtures::random_dgf;
using fixtures::random_separable;
using ::testing::HasSubstr;

std::string error_in(const std::string& text) {
  return error_of([&] { parse_baseline(memory_file(text)); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(BaselineFile, RestoresTablesToTheLastBit) {
  for (const SeparableBrdf& brdf : {random_separable(), random_anisotropic()}) {
    const Baseline back =
        parse_baseline(memory_file(format_baseline({.kind = "svd", .brdf = brdf, .notes = R"({"a":1})"})));
    EXPECT_EQ(back.kind, "svd");
    EXPECT_EQ(back.notes, R"({"a":1})");
    EXPECT_EQ(std::get<SeparableBrdf>(back.brdf), brdf);
  }
  const Baseline back = parse_baseline(memory_file(format_baseline({.kind = "dgf", .brdf = random_dgf()})));
  EXPECT_EQ(std::get<DgfBrdf>(back.brdf), random_dgf());
}

TEST(BaselineFile, RestoresAnalyticParametersToTheLastBit) {
  const AnalyticBrdf brdf = parse_analytic("ward:alpha_x=0.12345678901234567,ks=0.1/0.2/0.30000000000000004");
  const Baseline back = parse_baseline(memory_file(format_baseline({.kind = "analytic", .brdf = brdf})));
  EXPECT_EQ(format_analytic(std::get<AnalyticBrdf>(back.brdf)), format_analytic(brdf));
  // alpha_x and three channels of ks; the rest is as by default
  EXPECT_EQ(baseline_bytes(back.brdf), 16u);
}

TEST(BaselineFile, IsToldByItsFirstCharacter) {
  EXPECT_TRUE(looks_like_baseline(" \n{"));
  EXPECT_FALSE(looks_like_baseline(""));
  EXPECT_FALSE(looks_like_baseline("theta_i,phi_i"));
}

TEST(BaselineFile, SaysWhatItExpected) {
  const std::string good = format_baseline({.kind = "nmf", .brdf = random_separable()});
  EXPECT_EQ(error_in(good), "");
  EXPECT_THAT(error_in("{"), HasSubstr("test.file: expected a baseline in JSON"));
  EXPECT_THAT(error_in("{}"), HasSubstr("kind"));
  EXPECT_THAT(error_in(replaced(good, "nmf", "pca")),
              HasSubstr("svd, nd, nmf, dgf or analytic, found 'pca'"));
  EXPECT_THAT(error_in(replaced(good, "nmf", "dgf")), HasSubstr("tables: expected 3, found 2"));
  EXPECT_THAT(error_in(replaced(good, "nmf", "analytic")), HasSubstr("tables: expected 0, found 2"));
  EXPECT_THAT(error_in(replaced(good, "theta_h", "theta_z")), HasSubstr("'theta_z'"));
  EXPECT_THAT(error_in(replaced(good, R"("count":7)", R"("count":8)")), HasSubstr("values"));
  EXPECT_THAT(error_in(replaced(good, R"("count":7)", R"("count":2000000000)")),
              HasSubstr("nodes along theta_h"));
  EXPECT_THAT(error_in(replaced(good, R"("terms":2)", R"("terms":0)")), HasSubstr("term"));
  for (const char* terms : {"-1", "2.5", "1e23", "122222222222222222222222"})
    EXPECT_THAT(error_in(replaced(good, R"("terms":2)", fmt::format(R"("terms":{})", terms))),
                HasSubstr("expected terms of 0 to 2147483647"));
  EXPECT_THAT(error_in(replaced(good, R"("values":[)", R"("values":[1e300,)")), HasSubstr("table 'u'"));
  EXPECT_THAT(error_in(replaced(good, R"("notes":{})", R"("notes":[])")), HasSubstr("notes"));
  EXPECT_THAT(error_in(replaced(good, R"("name":"u")", R"("name":"w")")), HasSubstr("'u', found 'w'"));
  const std::string analytic = format_baseline({.kind = "analytic", .brdf = parse_analytic("ggx")});
  EXPECT_THAT(error_in(replaced(analytic, "ggx", "ggz")), HasSubstr("'ggz'"));
  EXPECT_THAT(error_in(replaced(analytic, "0.2", "7")), HasSubstr("alpha_x"));
}

TEST(BaselineFile, RefusesDeepNesting) {
  const std::string deep = std::string(100'000, '[');
  EXPECT_THAT(error_in("{\"kind\":" + deep), HasSubstr("expected a baseline"));
}

TEST(EvaluationCost, CountsLookupsAndProducts) {
  // u: 2 corners, 3 channels, 2 terms; v: 4 corners, 1 channel, 2 terms; 3 channels times (2 terms + scale)
  EXPECT_EQ(evaluation_cost(random_separable()), (EvaluationCost{12 + 8, 12 + 8 + 9}));
  // d and f: 2 corners, 3 channels; g twice: 2 corners, 1 channel
  EXPECT_EQ(evaluation_cost(random_dgf()), (EvaluationCost{16, 16 + 12}));
  EXPECT_EQ(evaluation_cost(NeuralBrdf(std::vector<float>(675))), (EvaluationCost{675, 630}));
  const NpBrdf np(std::make_shared<const NpDecoder>(std::vector<float>(808'003)), {},
                  NpBrdf::Value::reflectance);
  EXPECT_EQ(evaluation_cost(np), (EvaluationCost{808'003, 805'600}));
  EXPECT_FALSE(evaluation_cost(BaselineBrdf(parse_analytic("ggx"))));
  EXPECT_EQ(evaluation_cost(BaselineBrdf(random_dgf())), evaluation_cost(random_dgf()));
}

TEST(EvaluationCost, OfAFactoredBrdfGrowsByEveryUse) {
  const Table p{.name = "p", .layout = {.width = 2}, .channels = 1, .values = {1, 0.5f}};
  const Table q{.name = "q",
                .layout = {.shape = TableShape::disk, .width = 2, .height = 2},
                .channels = 3,
                .values = std::vector<float>(12, 1.0f)};
  const Lobe lobe{.scale = {1, 1, 1},
                  .factors = {{.table = 0, .projection = kProjectWi},
                              {.table = 0, .projection = kProjectWo},
                              {.table = 1, .projection = kProjectHalf}}};
  const FactoredBrdf brdf(3, {p, q}, {lobe}, TableFormat::half);
  EXPECT_EQ(evaluation_cost(brdf), (EvaluationCost{2 + 2 + 12, 16 + 9}));

  const FactoredBrdf volume = smooth_model({"", "g(theta_h,theta_d,phi_d)", {"g=3x3x3"}, 3});
  EXPECT_EQ(evaluation_cost(volume), (EvaluationCost{8 * 3, 8 * 3 + 3}));
}

TEST(BaselineFile, KnowsAnOpenMaterialFileThatHasNoTable) {
  EXPECT_THAT(
      error_of([] {
        parse_baseline(memory_file(R"({"metadata":{"name":"glass","objectType":"material"},"optical":{}})"));
      }),
      testing::HasSubstr("an OpenMATERIAL file without the lookupTable of a BRDF"));
}

}  // namespace
}  // namespace burnish
