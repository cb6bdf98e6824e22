// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/source.h>
#include <burnish/testing/baselines.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

using fixtures::random_dgf;
using fixtures::random_separable;

Model some_model() {
  return {.brdf = smooth_model(model_case("Pqp")), .lambda_nm = {}, .notes = R"({"source":"a"})"};
}

TEST(Source, KeepsAModelWhole) {
  const Model model = some_model();
  const Source source = to_source("paint", model);
  EXPECT_EQ(source.name, "paint");
  EXPECT_EQ(source.bytes(), model.brdf.bytes());
  const Model again = to_model(source);
  EXPECT_EQ(again.notes, model.notes);
  EXPECT_EQ(again.lambda_nm, model.lambda_nm);
  EXPECT_TRUE(std::ranges::equal(again.brdf.tables(), model.brdf.tables()));
}

TEST(Source, KnowsThePartThatAModelWasFittedTo) {
  EXPECT_FALSE(to_source("paint", some_model()).findings.block);
  Model model = some_model();
  model.notes = R"({"source":"a","part":"transmission-back","band":"NIR"})";
  const Source source = to_source("sheet", model);
  EXPECT_EQ(source.findings.block, (BsdfBlock{BsdfPart::transmission_back, "NIR"}));
  EXPECT_TRUE(source.findings.transmits());
  EXPECT_EQ(to_model(source).notes, model.notes);
  model.notes = R"({"part":"transmission-left"})";
  EXPECT_FALSE(to_source("sheet", model).findings.block);
}

TEST(Source, EvaluatesABaselineAsItIs) {
  for (const BaselineBrdf& brdf : {BaselineBrdf(random_separable()), BaselineBrdf(random_dgf())}) {
    const Source source = to_source("paint", Baseline{.kind = "svd", .brdf = brdf});
    EXPECT_EQ(source.findings.format, "svd baseline");
    EXPECT_EQ(source.bytes(), baseline_bytes(brdf));
    const BrdfRef expected = baseline_ref(brdf), found = source.ref();
    ASSERT_EQ(found.channels(), expected.channels());
    std::vector<double> a(expected.channels()), b(expected.channels());
    for (const DirectionPair& pair : corner_and_random_pairs(200)) {
      const bool known = expected.eval(pair.wi, pair.wo, a);
      EXPECT_EQ(found.eval(pair.wi, pair.wo, b), known);
      if (known) {
        EXPECT_EQ(a, b);
      }
    }
  }
}

TEST(Source, TellsWhatItIsNot) {
  const Source baseline = to_source("paint", Baseline{.kind = "svd", .brdf = random_separable()});
  EXPECT_THROW(to_model(baseline), Error);
  EXPECT_FALSE(is_measurement(baseline));
  EXPECT_THROW(measured_nodes(baseline), Error);
  EXPECT_EQ(baseline.samples(), nullptr);
}

}  // namespace
}  // namespace burnish
