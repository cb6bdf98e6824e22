// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/neural.h>
#include <burnish/io/open_source.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/testing/files.h>
#include <burnish/testing/sanitized.h>

namespace burnish {
namespace {

using testing::HasSubstr;

std::string row(const std::string& name, const std::string& last = "0.5") {
  std::string text = name;
  for (std::size_t i = 1; i < NeuralBrdf::kWeights; ++i) text += i % 3 == 0 ? ",0.25" : ",-1e-2";
  return text + "," + last + "\n";
}

TEST(Neural, FindsTheNamedRow) {
  const std::string text = row("first") + row("second", "0.75");
  const NeuralFile second = parse_neural(memory_file(text), "second");
  EXPECT_EQ(second.name, "second");
  EXPECT_EQ(second.brdf.weights().back(), 0.75f);
  EXPECT_EQ(second.brdf.weights()[2], 0.25f);
  EXPECT_EQ(parse_neural(memory_file(text), "first").brdf.weights().back(), 0.5f);
}

TEST(Neural, ASingleRowNeedsNoName) {
  EXPECT_TRUE(looks_like_neural(row("only")));
  EXPECT_FALSE(looks_like_neural("theta_i,phi_i,theta_o,phi_o,value\n"));
  const Source source = parse_source(memory_file(row("only")), {});
  EXPECT_EQ(source.findings.format, "neural encoding");
  EXPECT_EQ(source.bytes(), 1350u);
}

TEST(Neural, SaysWhatIsWrong) {
  const auto error = [](const std::string& text, std::string_view name) {
    return error_of([&] { parse_neural(memory_file(text), name); });
  };
  EXPECT_THAT(error(row("a") + row("b"), ""), HasSubstr("nbrdf:FILE#NAME, found a, b"));
  EXPECT_THAT(error(row("a") + row("b"), "c"), HasSubstr("'c', found a, b"));
  EXPECT_THAT(error("", "a"), HasSubstr("no row"));
  EXPECT_THAT(error(row("a", "nan"), "a"), HasSubstr("weight 675"));
  EXPECT_THAT(error(row("a", "1e9"), "a"), HasSubstr("weight 675"));
  EXPECT_THAT(error(row("a", "0.5,1"), "a"), HasSubstr("end of the line"));
  EXPECT_THAT(error("a,1,2\n", "a"), HasSubstr("weight 3"));
  EXPECT_THAT(error(row("a b"), ""), HasSubstr("without blanks"));
}

TEST(Neural, EncodingsOfMeasuredMaterialsMeetThem) {
  BURNISH_SKIP_WHERE_SANITIZED();
  BURNISH_NEEDS_DATA();
  for (const std::string name : {"aurora_white_rgb", "acrylic_felt_green_rgb"}) {
    const Source measured = open_source((data_folder() / "rgl" / (name + ".bsdf")).string(), {});
    const Source neural = open_source("nbrdf:" + (data_folder() / "nbrdf/rgl.csv").string() + "#" + name, {});
    const SymmetrizedBrdf reference(measured.ref()), model(neural.ref());
    const ErrorFigures figures = error_figures(reference, model, {.count = 20'000});
    EXPECT_GT(figures.psnr, 34) << name;
    EXPECT_LT(figures.log_cos, 0.02) << name;
  }
}

}  // namespace
}  // namespace burnish
