// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/fitting/fit_report.h>

namespace burnish {
namespace {

using FitJson = nlohmann::json;

TEST(FitReport, WritesNamesThatAreNoUtf8AndFiguresThatAreNotFinite) {
  FitReport report;
  report.source = "a\xff";
  report.held_out.emplace().psnr = INFINITY;
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_EQ(json.at("source"), "a\xEF\xBF\xBD");
  EXPECT_TRUE(json.at("psnr").is_null());
}

TEST(FitReport, SaysOfOneLobeHowItWasSolved) {
  OneLobeReport lobe{.summary = {.error_before = 2, .error_after = 0.5, .iterations = 7}, .samples = 100};
  lobe.summary.stop_reason = StopReason::tolerance_reached;
  lobe.smooth_shares = {{"p", 0.1}, {"q", 10}};
  FitReport report{.source = "a", .source_format = "CSV", .symmetrized = false, .how = lobe};
  const FitJson json = FitJson::parse(to_json(report));
  EXPECT_EQ(json.at("symmetrized"), false);
  EXPECT_EQ(json.at("samples"), 100);
  EXPECT_EQ(json.at("rms_log_before"), 2);
  EXPECT_EQ(json.at("rms_log_after"), 0.5);
  EXPECT_EQ(json.at("iterations"), 7);
  EXPECT_EQ(json.at("stop_reason"), "tolerance reached");
  EXPECT_EQ(json.at("smooth_shares"), (FitJson{{"p", 0.1}, {"q", 10}}));
  for (const char* member :
       {"relative", "relative_cross_validated", "psnr", "budget_choice", "conserve_energy"})
    EXPECT_FALSE(json.contains(member)) << member;
  ASSERT_TRUE(report.summary());
  EXPECT_EQ(report.summary()->iterations, 7);
}

TEST(FitReport, SaysOfSeveralWhatWasTried) {
  LobesReport lobes{.summary = {.error_before = 3, .error_after = 1}, .samples = 10, .lobes = 2};
  lobes.fetch_trials = {{.fetches = 2, .lobes = false, .error = 0.1},
                        {.fetches = 4, .lobes = true, .error = 0.05}};
  lobes.search = SearchReport{.trials = 5, .kept = {{"a wider p", 0.4}}};
  FitReport report{.source = {}, .source_format = {}, .how = lobes};
  report.budget_choice = BudgetChoice{.bytes = 512,
                                      .stop = BudgetStop::gain,
                                      .noise = {},
                                      .trials = {{.bytes = 256, .error = {.relative = 0.3}, .excess = 0}}};
  const FitJson json = FitJson::parse(to_json(report));
  EXPECT_EQ(json.at("objective"), 1);
  EXPECT_EQ(json.at("loss"), "image");
  EXPECT_FALSE(json.contains("budget"));  // lobes were given
  EXPECT_EQ(json.at("fetch_trials").at(1), (FitJson{{"fetches", 4}, {"lobes", true}, {"error", 0.05}}));
  EXPECT_EQ(json.at("search").at("kept").at(0), (FitJson{{"change", "a wider p"}, {"objective", 0.4}}));
  EXPECT_EQ(json.at("budget_choice").at("stop"), "gain");
  EXPECT_EQ(json.at("budget_choice").at("trials").at(0), (FitJson{{"bytes", 256}, {"relative", 0.3}}));
  EXPECT_FALSE(json.at("budget_choice").contains("noise"));
}

TEST(FitReport, OfADecompositionHasNoSummary) {
  FitReport report{.source = {},
                   .source_format = {},
                   .how = BaselineReport{.method = "svd", .budget = 2048, .layouts_tried = 9}};
  EXPECT_FALSE(report.summary());
  const FitJson json = FitJson::parse(to_json(report));
  EXPECT_EQ(json.at("method"), "svd");
  EXPECT_EQ(json.at("layouts_tried"), 9);
  EXPECT_FALSE(json.contains("error_after"));
}

}  // namespace
}  // namespace burnish
