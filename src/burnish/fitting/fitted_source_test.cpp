// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/fitted_source.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {
namespace {

Source glossy() {
  return {"glossy", parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,f0=0.5/0.3/0.1,kd=0.2"), {}};
}

/// Returns grey samples of a glossy surface.
Source glossy_samples(std::size_t count) {
  const Samples drawn =
      measure(parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,f0=0.5,kd=0.2"), {.count = count, .seed = 3});
  Samples grey{.channels = 1, .isotropic = drawn.isotropic, .pairs = drawn.pairs, .values = {}};
  for (std::size_t i = 0; i < drawn.size(); ++i) grey.values.push_back(drawn.at(i)[0]);
  return {"samples", ScatteredBrdf(std::move(grey)), {}};
}

TEST(FittedSource, OfAFunctionDrawsPairsAsTheOptionsSay) {
  const Source source = glossy();
  FitOptions options{.samples = 300, .seed = 5};
  const FittedSource fitted(source, options, Stages(options));
  EXPECT_EQ(fitted.samples(), nullptr);
  EXPECT_FALSE(fitted.scattered());
  EXPECT_FALSE(fitted.nodes());
  EXPECT_FALSE(fitted.judged_at_nodes());
  EXPECT_EQ(fitted.sample_source(1000, false).count, 300u);

  // The pairs depend only on the seed.
  const TrainingOptions drawn{.pictures = 200, .directions = 100};
  const TrainingSet set = fitted.drawn_set(drawn, Stages(options)),
                    again = fitted.drawn_set(drawn, Stages(options));
  EXPECT_GT(set.picture_count, 200u);  // with pixels lit from the viewer
  EXPECT_EQ(set.values, again.values);
  options.seed = 6;
  EXPECT_NE(fitted.drawn_set(drawn, Stages(options)).values, set.values);
}

TEST(FittedSource, OfScatteredSamplesIsThemOrTheFunctionBetweenThem) {
  const Source source = glossy_samples(200);
  FitOptions options{.target = FitTarget::function};
  const FittedSource samples(source, options, Stages(options));
  EXPECT_TRUE(samples.scattered());
  EXPECT_EQ(samples.samples(), source.samples());
  EXPECT_FALSE(samples.nodes_report());
  // Each sample represents its swapped pair too.
  EXPECT_EQ(samples.training_set(false).size(), 2 * source.samples()->size());

  options.target = FitTarget::nodes;
  std::vector<std::string> told;
  options.progress = [&](std::string_view stage, double) { told.emplace_back(stage); };
  const FittedSource nodes(source, options, Stages(options).with(" again"));
  EXPECT_EQ(nodes.samples(), nullptr);
  EXPECT_FALSE(nodes.scattered());
  EXPECT_FALSE(nodes.judged_at_nodes());  // samples have arbitrary directions
  ASSERT_TRUE(nodes.nodes_report());
  EXPECT_EQ(nodes.nodes_report()->fitted + nodes.nodes_report()->outliers, source.samples()->size());
  EXPECT_TRUE(nodes.nodes_report()->held_out);
  EXPECT_TRUE(nodes.noise_scale().noise());
  ASSERT_FALSE(told.empty());
  EXPECT_EQ(std::ranges::count(told, "kriging the nodes again"), static_cast<std::ptrdiff_t>(told.size()));
}

TEST(FittedSource, ChoosesAFormatThatHoldsItsChannels) {
  const Source colour = glossy(), grey = glossy_samples(60);
  FitOptions options{.target = FitTarget::function};
  const FittedSource three(colour, options, Stages(options)), one(grey, options, Stages(options));
  EXPECT_EQ(three.format(), TableFormat::rgb9e5);
  EXPECT_EQ(one.format(), TableFormat::half);
  EXPECT_NO_THROW(three.check_format(TableFormat::rgb9e5));
  EXPECT_THROW(one.check_format(TableFormat::rgb9e5), Error);
  options.format = TableFormat::rgb9e5;
  EXPECT_THROW(one.format(), Error);
  options.format = TableFormat::unorm8;
  EXPECT_EQ(three.format(), TableFormat::unorm8);
}

TEST(FittedSource, RefusesOptionsThatContradictEachOther) {
  const Source source = glossy();
  FitOptions options{.samples = 0};
  EXPECT_THROW(FittedSource(source, options, Stages(options)), Error);
  options = {.target = FitTarget::function, .hold_out = NodePart{}};
  EXPECT_THROW(FittedSource(source, options, Stages(options)), Error);
}

}  // namespace
}  // namespace burnish
