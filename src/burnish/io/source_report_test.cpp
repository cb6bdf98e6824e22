#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/io/source_report.h>
#include <burnish/math/angles.h>
#include <burnish/testing/books.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

nlohmann::json report_of(const Source& source) {
  return nlohmann::json::parse(to_json(report_on(source)));
}

TEST(SourceReport, SaysWhatAFormulaReflects) {
  Source source = analytic_source("lambert:kd=0.6/0.4/0.2");
  source.findings.theta_i_max = kHalfPi / 2;
  const nlohmann::json json = report_of(source);
  EXPECT_EQ(json["channels"], 3);
  EXPECT_EQ(json["isotropic"], true);
  EXPECT_EQ(json["theta_i_deg"], nlohmann::json({0.0, 45.0}));
  EXPECT_EQ(json["reciprocity_error"], 0);
  EXPECT_NEAR(json["mirror_asymmetry"].get<double>(), 0, 1e-12);
  ASSERT_EQ(json["albedo"].size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(json["albedo"][i]["theta_i_deg"].get<double>(), 30.0 * static_cast<double>(i), 1e-12);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(json["albedo"][i]["albedo"][c].get<double>(), 0.6 - 0.2 * static_cast<double>(c),
                  kAlbedoTolerance);
    EXPECT_EQ(json["albedo"][i]["unknown_fraction"], 0);
  }
  EXPECT_FALSE(json.contains("tables"));
  EXPECT_FALSE(report_of(analytic_source("ggx:alpha_x=0.2,alpha_y=0.4")).contains("mirror_asymmetry"));
}

TEST(SourceReport, SaysWhatAModelIsMadeOf) {
  const FactoredBrdf model =
      random_model("p(wo) q(h) p(wi) + r(theta_d)", {"p=5x5", "q=9", "r=4,shared"}, 3, TableFormat::half);
  const nlohmann::json json = report_of({.name = "m\xff", .brdf = model, .findings = {}});
  EXPECT_EQ(json["name"], "m\xef\xbf\xbd");  // names need not be UTF-8, JSON has to
  EXPECT_EQ(json["bytes"], model.bytes());
  EXPECT_EQ(json["table_bytes"], model.table_bytes());
  EXPECT_EQ(json["lobes"], 2);
  EXPECT_EQ(json["reciprocal"], true);
  EXPECT_EQ(json["expression"], model_expression(model));
  ASSERT_EQ(json["scales"].size(), 2u);
  EXPECT_EQ(json["scales"][1].get<std::vector<double>>(), model.lobes()[1].scale);
  ASSERT_EQ(json["tables"].size(), 3u);
  std::size_t bytes = 0;
  for (const auto& table : json["tables"]) bytes += table["bytes"].get<std::size_t>();
  EXPECT_EQ(bytes, model.table_bytes());
  EXPECT_EQ(json["tables"][0]["height"], 5);
  EXPECT_EQ(json["tables"][2]["channels"], 1);
}

}  // namespace
}  // namespace burnish
