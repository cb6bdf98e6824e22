// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/image/png.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/report/compare_report.h>
#include <burnish/testing/brdfs.h>
#include <burnish/testing/models.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;
using fixtures::Glossy;
using fixtures::Lambert;

constexpr FigureOptions kQuick{.count = 2000, .image_size = 32};

class CompareReport : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("burnish_report_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  Glossy reference_, scaled_{.scale = 2};
  Lambert lambert_;
  std::vector<ComparedModel> models_ = {
      {"same <&>", reference_, {}, ""}, {"twice", scaled_, 1344, "two lobes"}, {"lambert", lambert_, 12, ""}};
  fs::path folder_;
};

struct NowhereKnown {
  static std::size_t channels() noexcept { return 1; }
  static bool isotropic() noexcept { return true; }
  static bool eval(Vec3, Vec3, std::span<double>) noexcept { return false; }
};

TEST_F(CompareReport, NamesTheModelThatCannotBeScored) {
  const NowhereKnown nothing;
  models_.push_back({"nothing", nothing, {}, ""});
  EXPECT_EQ(error_of([&] { compare_models(Scorer(reference_, kQuick), models_); }),
            "nothing: reference and model share no known direction pair");
}

TEST_F(CompareReport, JsonHasTheFiguresUnderTheirNames) {
  const auto compared = compare_models(Scorer(reference_, kQuick), models_);
  const auto json = nlohmann::json::parse(to_json(compared));
  ASSERT_EQ(json.size(), 3u);
  EXPECT_EQ(json[0]["model"], "same <&>");
  EXPECT_TRUE(json[0]["bytes"].is_null());
  EXPECT_TRUE(json[0]["psnr"].is_null());
  EXPECT_EQ(json[1]["bytes"], 1344);
  EXPECT_EQ(json[1]["note"], "two lobes");
  for (const auto& [name, value] : {std::pair{"log_cos", compared[1].figures.log_cos},
                                    {"relative", compared[1].figures.relative},
                                    {"rms_log", compared[1].figures.rms_log},
                                    {"psnr", compared[1].figures.psnr},
                                    {"ssim", compared[1].figures.ssim}})
    EXPECT_EQ(json[1][name], value) << name;
  ASSERT_EQ(json[1]["albedo"].size(), 6u);  // 0, 15, ... 75 degrees
  const auto& albedo = json[1]["albedo"][2];
  EXPECT_NEAR(albedo["theta_i_deg"], 30, 1e-9);
  EXPECT_EQ(albedo["reference"], directional_albedo(reference_, spherical_direction(radians(30), 0)).albedo);
  EXPECT_EQ(albedo["model"], directional_albedo(scaled_, spherical_direction(radians(30), 0)).albedo);
}

TEST_F(CompareReport, FolderHoldsEveryFileItsPageShows) {
  const Scorer scorer(reference_, kQuick);
  const auto compared = write_report(folder_, "a reference & more", scorer, models_);
  EXPECT_EQ(compared[1].figures.relative, scorer.score(scaled_).relative);
  const std::string page(read_file(folder_ / "index.html").text());
  int shown = 0;
  for (std::size_t at = page.find("src=\""); at != page.npos; at = page.find("src=\"", at + 1), ++shown) {
    const std::string name = page.substr(at + 5, page.find('"', at + 5) - at - 5);
    EXPECT_TRUE(fs::is_regular_file(folder_ / name)) << name;
  }
  EXPECT_EQ(shown, 1 + 3 + 6);  // overview, models, plots
  EXPECT_NE(page.find("same &lt;&amp;&gt;"), page.npos);
  EXPECT_EQ(page.find("same <&>"), page.npos);
  for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
    if (entry.path().extension() == ".png") {
      EXPECT_GE(read_png(entry.path()).width, 32);
    }
    EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos);
  }
  const auto report = nlohmann::json::parse(read_file(folder_ / "report.json").text());
  EXPECT_EQ(report["reference"], "a reference & more");
  EXPECT_EQ(report["models"].size(), 3u);
}

TEST_F(CompareReport, ShowsTheTablesOfFactoredModelsAndExplainsEachFigure) {
  const FactoredBrdf factored = random_model("pqp", {"p=8", "q=9x9"}, 3, TableFormat::single);
  models_.push_back({"tables", factored, factored.bytes(), "", &factored});
  write_report(folder_, "r", Scorer(reference_, kQuick), models_);
  for (const Table& table : factored.tables())
    EXPECT_GE(read_png(folder_ / fmt::format("factors/model_4_{}.png", table.name)).width, 9) << table.name;
  const std::string page(read_file(folder_ / "index.html").text());
  EXPECT_NE(page.find(fmt::format(
                "<img src=\"factors/model_4_q.png\" alt=\"Table q\"><figcaption>q, at most {:.4g}<",
                std::ranges::max(factored.tables()[1].values))),
            page.npos);
  EXPECT_EQ(page.find("Tables of twice"), page.npos);  // it has none
  EXPECT_EQ(page.find('@'), page.npos) << page.substr(page.find('@'), 20);
  // Every heading of the table of figures has its explanation.
  const std::string table = page.substr(page.find("<table>"), page.find("</tr>") - page.find("<table>"));
  for (std::size_t at = table.find("<th>"); at != table.npos; at = table.find("<th>", at + 1)) {
    const std::string head = table.substr(at + 4, table.find("</th>", at) - at - 4);
    if (head.empty() || head == "model") continue;
    EXPECT_NE(page.find("<dt>" + head + "</dt>"), page.npos) << head;
  }
}

TEST_F(CompareReport, OfAMeasurementSaysWhatItWouldScoreItself) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const Scorer scorer(reference_, kQuick);
  const MeasuredNodes nodes = measured_nodes(measure(reference_, {.count = 300}));
  const Measurement measurement{.nodes = nodes,
                                .itself = node_figures(nodes, reference_),
                                .quality = quality_by_repeat(scorer, scaled_, nodes)};
  const auto compared = write_report(folder_, "r", scorer, models_, &measurement);
  ASSERT_TRUE(compared[1].nodes);
  EXPECT_EQ(compared[1].nodes->relative, node_figures(nodes, scaled_).relative);
  const std::string page(read_file(folder_ / "index.html").text());
  EXPECT_NE(page.find("the measurement, repeated"), page.npos);
  EXPECT_NE(page.find("At the measured nodes"), page.npos);
  EXPECT_NE(read_file(folder_ / "error_theta_h.svg").text().find("the measurement, repeated"),
            std::string::npos);
  const auto report = nlohmann::json::parse(read_file(folder_ / "report.json").text());
  EXPECT_EQ(report["models"][1]["measurement"]["relative"], measurement.quality->figures.relative);
  EXPECT_EQ(report["models"][1]["nodes"]["itself"]["relative"], 0);
  const auto of_nodes = nlohmann::json::parse(nodes_json(measurement, models_));
  ASSERT_EQ(of_nodes.size(), 4u);
  EXPECT_EQ(of_nodes[2]["bytes"], 1344);
  EXPECT_EQ(of_nodes[2]["relative"], compared[1].nodes->relative);
}

TEST_F(CompareReport, OfScatteredSamplesSaysHowFarOffItMayBe) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const MeasuredNodes nodes = measured_nodes(measure(reference_, {.count = 300}));
  const KrigedNodes between(nodes, LogCovariance(true));
  const Measurement measurement{.nodes = nodes,
                                .itself = node_figures(nodes, reference_),
                                .quality = {},
                                .between = &between,
                                .expected = expected_error(between, reference_)};
  const auto compared = write_report(folder_, "r", Scorer(reference_, kQuick), models_, &measurement);
  for (std::size_t m = 0; m < models_.size(); ++m) {
    ASSERT_TRUE(compared[m].expected);
    EXPECT_EQ(compared[m].expected->relative, expected_error(between, models_[m].brdf).relative);
  }
  EXPECT_GT(compared[1].expected->relative, 0.9);  // of twice the function

  const auto report = nlohmann::json::parse(read_file(folder_ / "report.json").text());
  const auto expected = report["models"][1]["expected"];
  EXPECT_EQ(expected["relative"], compared[1].expected->relative);
  EXPECT_EQ(expected["itself"]["relative"], measurement.expected->relative);
  EXPECT_EQ(expected["from_theta_i_deg"]["30"], compared[1].expected->by_theta_i[2].value());
  const std::string page(read_file(folder_ / "index.html").text());
  EXPECT_NE(page.find("Expected error"), page.npos);
  EXPECT_NE(page.find("<th>75 to 90</th>"), page.npos);
  EXPECT_NE(page.find(fmt::format("{:.4f}", compared[1].expected->relative)), page.npos);
  EXPECT_EQ(page.find('@'), page.npos);
}

TEST_F(CompareReport, RefusesNoModelsAndAFolderThatIsAFile) {
  const Scorer scorer(reference_, kQuick);
  EXPECT_THROW(write_report(folder_, "r", scorer, {}), Error);
  std::ofstream(folder_) << "a file";
  EXPECT_THROW(write_report(folder_, "r", scorer, models_), Error);
}

TEST_F(CompareReport, SlicesPeakInTheMirrorDirection) {
  const Plot plot = incidence_plane_plot(reference_, models_, radians(30));
  ASSERT_EQ(plot.series.size(), 4u);
  const auto& f = plot.series[0].y;
  EXPECT_NEAR(plot.series[0].x[static_cast<std::size_t>(std::ranges::max_element(f) - f.begin())], 30, 1e-9);
  for (std::size_t i = 0; i < f.size(); ++i) EXPECT_NEAR(plot.series[2].y[i], 2 * f[i], 1e-12);
}

TEST_F(CompareReport, SlicesHaveGapsWhereNothingIsKnown) {
  const Plot plot = incidence_plane_plot(Glossy{.blind_below = std::cos(radians(20))}, {}, radians(30));
  // theta_d = |theta_o + 30| / 2 on the far side
  for (std::size_t i = 0; i < plot.series[0].x.size(); ++i)
    EXPECT_EQ(std::isnan(plot.series[0].y[i]), std::abs(plot.series[0].x[i] + 30) / 2 > 20 + 1e-9)
        << plot.series[0].x[i];
}

TEST_F(CompareReport, ErrorsAreBinnedByTheirAngle) {
  // an error of one for theta_d below 45 degrees, none above
  std::vector<std::vector<PairError>> errors(1);
  for (int i = 0; i < 18; ++i) {
    const double theta = radians(5 * i + 2.5);
    const auto [wi, wo] = from_half_diff({0.2, 0, theta, 0.3});
    errors[0].push_back({.pair = {wi, wo}, .log_ratio = theta < kPi / 4 ? 1.0 : 0.0});
  }
  const Plot plot = error_plot(std::span(models_).first(1), errors, ErrorAxis::theta_d);
  ASSERT_EQ(plot.series[0].x.size(), 18u);
  for (std::size_t i = 0; i < 18; ++i) {
    EXPECT_NEAR(plot.series[0].x[i], 5 * static_cast<double>(i) + 2.5, 1e-12);
    EXPECT_EQ(plot.series[0].y[i], i < 9 ? 1 : 0);
  }
}

}  // namespace
}  // namespace burnish
