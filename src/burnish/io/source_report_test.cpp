// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/io/open_source.h>
#include <burnish/io/source_report.h>
#include <burnish/math/angles.h>
#include <burnish/testing/books.h>
#include <burnish/testing/models.h>
#include <burnish/testing/tools.h>

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

/// Returns a white surface's goniometer table, theta up to 60 degrees.
Source white_table(double value, const OpenOptions& options) {
  std::string text = "theta_i,phi_i,theta_o,phi_o,value\n";
  for (const int theta_i : {0, 30, 60})
    for (const int theta_o : {0, 20, 40, 60})
      for (const int phi_o : {0, 90, 180})
        text += fmt::format("{},0,{},{},{}\n", theta_i, theta_o, phi_o, value);
  return parse_source(memory_file(text), options);
}

TEST(SourceReport, WarnsOfMoreReflectedThanReceived) {
  const auto warnings = [](double value, const OpenOptions& options) {
    return report_of(white_table(value, options))["warnings"].get<std::vector<std::string>>();
  };
  EXPECT_THAT(warnings(0.9, {}),
              testing::Contains(testing::HasSubstr("More light is reflected than received: 283 %")));
  EXPECT_THAT(warnings(0.9, {.brf = true}), testing::IsEmpty());
  EXPECT_THAT(warnings(0.9 / kPi, {}), testing::IsEmpty());
}

TEST(SourceReport, TakesAnUnknownRimForTheRest) {
  const nlohmann::json albedo = report_of(white_table(0.5, {.brf = true}))["albedo"][0];
  EXPECT_GT(albedo["unknown_fraction"].get<double>(), 0);
  EXPECT_NEAR(albedo["albedo"][0].get<double>(), 0.5, 0.001);
}

// A tenth of the light goes into one patch. No quadrature knows its borders.
TEST(SourceReport, SumsPatchesExactly) {
  const PatchBasis basis = klems_full_basis();
  PatchTable mirror{basis, basis, std::vector<float>(basis.size() * basis.size(), 0.0f)};
  mirror.incident.first_azimuth = kPi;
  for (std::size_t k = 0; k < basis.size(); ++k)
    mirror.values[k * basis.size() + k] = static_cast<float>(0.1 / basis.projected_solid_angle(k));
  const nlohmann::json json = report_of({.name = "mirror", .brdf = mirror, .findings = {}});
  for (const auto& at : json["albedo"]) EXPECT_NEAR(at["albedo"][0].get<double>(), 0.1, 1e-7);
}

TEST(SourceReport, SaysWhatAModelIsMadeOf) {
  const FactoredBrdf model =
      random_model("p(wo) q(h) p(wi) + r(theta_d)", {"p=5x5", "q=9", "r=4,shared"}, 3, TableFormat::half);
  const nlohmann::json json = report_of({.name = "m\xff", .brdf = model, .findings = {}});
  EXPECT_EQ(json["name"], "m\xef\xbf\xbd");  // names need not be UTF-8, but JSON has to be
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
