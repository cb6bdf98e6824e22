// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/fitting/baselines/analytic_fit.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/testing/brdfs.h>

namespace burnish {
namespace {

AnalyticFit fit(const AnalyticBrdf& truth) {
  return fit_analytic(from_brdf(truth.ref(), 4000, 1, false), truth.model().name, {.most_samples = 1500});
}

// Without noise least squares ends where the truth is, but for the step of its differences and rounding.
void expect_recovered(const std::string& spec) {
  const AnalyticBrdf truth = parse_analytic(spec);
  const AnalyticFit found = fit(truth);
  EXPECT_LT(found.summary.error_after, 1e-3) << spec;
  for (std::size_t p = 0; p < truth.values().size(); ++p) {
    const Rgb a = truth.values()[p], b = found.brdf.values()[p];
    for (const auto& [x, y] : {std::pair{a.r, b.r}, {a.g, b.g}, {a.b, b.b}})
      EXPECT_NEAR(x, y, 2e-2 * std::abs(x) + 1e-3) << spec << ": " << truth.model().parameters[p].name;
  }
}

TEST(FitAnalytic, RecoversIsotropicParameters) {
  expect_recovered("ggx:alpha_x=0.15,alpha_y=0.15,f0=0.6/0.3/0.1,kd=0.1/0.2/0.3");
  expect_recovered("ward:alpha_x=0.2,alpha_y=0.2,ks=0.3/0.2/0.1,kd=0.1/0.2/0.3");
  expect_recovered("cook_torrance:alpha=0.3,f0=0.5/0.3/0.1,kd=0.1/0.2/0.3");
  expect_recovered("ashikhmin_shirley:exponent_x=50,exponent_y=50,f0=0.5/0.3/0.1,kd=0.1/0.2/0.3");
}

TEST(FitAnalytic, RecoversAnisotropicParameters) {
  expect_recovered("ggx:alpha_x=0.1,alpha_y=0.3,f0=0.8,kd=0.3");
  expect_recovered("ward:alpha_x=0.3,alpha_y=0.1,ks=0.3,kd=0.1");
}

// Height and width of a cosine lobe trade off: the function is recovered, not its parameters.
TEST(FitAnalytic, RecoversLafortunesFunction) {
  const AnalyticBrdf truth =
      parse_analytic("lafortune:kd=0.1/0.2/0.3,cx=-0.8,cy=-0.8,cz=0.9,exponent=25,ks=0.6");
  const AnalyticFit found = fit(truth);
  EXPECT_LT(found.summary.error_after, 1e-3);
  EXPECT_LT(error_figures(truth.ref(), found.brdf.ref(), {.count = 2000, .image_size = 16}).relative, 0.02);
  EXPECT_EQ(found.starts, 12);
}

TEST(FitAnalytic, KeepsParametersOfIsotropicSourcesEqual) {
  const fixtures::Glossy source;
  for (const std::string_view model : {"ggx", "ward", "ashikhmin_shirley"}) {
    const AnalyticFit found =
        fit_analytic(from_brdf(source, 1000, 1, false), model, {.most_samples = 300, .max_iterations = 5});
    EXPECT_TRUE(found.brdf.isotropic()) << model;
    EXPECT_LE(found.summary.error_after, found.summary.error_before);
  }
}

TEST(FitAnalytic, TakesGreySources) {
  const fixtures::Glossy grey{.count = 1};
  const AnalyticFit found = fit_analytic(from_brdf(grey, 1000, 1, false), "ggx", {.most_samples = 300});
  for (const Rgb value : found.brdf.values()) EXPECT_TRUE(value.r == value.g && value.g == value.b);
}

TEST(FitAnalytic, SaysWhichModelsItTakes) {
  const fixtures::Glossy source, five{.count = 5};
  try {
    fit_analytic(from_brdf(source, 10, 1, false), "satin");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("lafortune, found 'satin'"));
  }
  EXPECT_THROW(fit_analytic(from_brdf(five, 10, 1, false), "ggx"), Error);
}

}  // namespace
}  // namespace burnish
