// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/io/convert.h>
#include <burnish/io/open_source.h>
#include <burnish/io/openmaterial.h>
#include <burnish/math/angles.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using testing::Contains;
using testing::HasSubstr;

const OpenOptions kSpectral{.keep_spectral = true};

std::string file_of(std::string_view rows, std::string_view wavelengths = "4e-07,6e-07") {
  return R"({"brdf":{"wavelengths":[)" + std::string(wavelengths) + R"(],"lookupTable":[)" +
         std::string(rows) + "]}}";
}

TEST(OpenMaterial, ReadsSpectraByTheirDirections) {
  EXPECT_TRUE(looks_like_openmaterial(seeds::kOpenMaterial));
  const SampleFile file = parse_openmaterial(memory_file(seeds::kOpenMaterial), kSpectral);
  ASSERT_EQ(file.samples.size(), 2u);
  EXPECT_TRUE(file.samples.isotropic);
  EXPECT_EQ(file.findings.lambda_nm, (std::vector<double>{400, 600}));
  EXPECT_NEAR(length(file.samples.pairs[0].wi - spherical_direction(0.5, 0)), 0, 1e-15);
  EXPECT_NEAR(length(file.samples.pairs[1].wo - spherical_direction(0.25, 3.1)), 0, 1e-15);
  EXPECT_EQ(file.samples.values, (std::vector<double>{0.1, 0.3, 0.2, 0.4}));
  EXPECT_EQ(file.findings.description, "seed");
  EXPECT_THAT(file.findings.conventions, Contains("Licence: CC0."));
}

TEST(OpenMaterial, LeavesOutWhatIsNotWholeAndKeepsASingleWavelength) {
  const SampleFile file = parse_openmaterial(
      memory_file(file_of("[4e-07,0,0,0,1],[6e-07,0,0,0,2],[4e-07,1,0,0,3],[6e-07,1,0,0,null]")), kSpectral);
  EXPECT_EQ(file.samples.size(), 1u);
  EXPECT_EQ(file.findings.hole_count, 1u);
  const SampleFile lidar = parse_openmaterial(memory_file(file_of("[9.05e-07,0,0,0,1]", "9.05e-07")), {});
  EXPECT_EQ(lidar.samples.channels, 1);
  EXPECT_EQ(lidar.findings.lambda_nm, std::vector<double>{905});
  EXPECT_EQ(lidar.samples.values, std::vector<double>{1});
}

TEST(OpenMaterial, SaysWhatIsWrong) {
  const auto error = [](const std::string& text) {
    return error_of([&] { parse_openmaterial(memory_file(text), {}); });
  };
  EXPECT_THAT(error("{\"lookupTable\""), HasSubstr("well-formed JSON"));
  EXPECT_THAT(error("{}"), HasSubstr("an object brdf"));
  EXPECT_THAT(error(file_of("[4e-07,0,0,0]")), HasSubstr("five numbers in row 1"));
  EXPECT_THAT(error(file_of("[4e-07,0,0,0,\"x\"]")), HasSubstr("a number for the value of row 1"));
  EXPECT_THAT(error(file_of("[5e-07,0,0,0,1]")), HasSubstr("a listed wavelength in row 1"));
  EXPECT_THAT(error(file_of("[4e-07,1.6,0,0,1]")), HasSubstr("[0, pi/2]"));
  EXPECT_THAT(error(file_of("[4e-07,0,0,0,1],[4e-07,0,0,0,1]")), HasSubstr("one value for each"));
  EXPECT_THAT(error(file_of("[4e-07,0,0,0,1]", "6e-07,4e-07")), HasSubstr("increasing wavelengths"));
  EXPECT_THAT(error(file_of("[4e-07,0,0,0,1]")), HasSubstr("at least one measurement"));
}

TEST(OpenMaterial, IsWrittenAndReadToTheLastBit) {
  const Source source = open_source("ggx:alpha_x=0.3,alpha_y=0.3", {});
  const Converted converted = convert(source, "openmaterial", {.count = 50});
  EXPECT_THAT(converted.notes, Contains(HasSubstr("spectra at 475, 510, 580, 605 nm")));
  const SampleFile file = parse_openmaterial(memory_file(converted.bytes), kSpectral),
                   colours = parse_openmaterial(memory_file(converted.bytes), {});
  ASSERT_EQ(file.samples.size(), 50u);
  const std::string again =
      format_openmaterial(file.samples, file.findings.lambda_nm, file.findings.description).text;
  const SampleFile twice = parse_openmaterial(memory_file(again), kSpectral);
  EXPECT_EQ(file.samples.values, twice.samples.values);
  std::vector<double> f(3);
  for (std::size_t i = 0; i < 50; ++i) {
    const auto [wi, wo] = file.samples.pairs[i];
    source.ref().eval(wi, wo, f);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(colours.samples.at(i)[c], f[c], 1e-5 * f[c]);  // angles stop at the schema's ends
  }
}

TEST(OpenMaterial, KeepsColoursToTheirLastDigits) {
  // Saturated colours are among these; each has a spectrum without values below zero.
  Samples samples{.channels = 3, .isotropic = true, .pairs = {}, .values = {}};
  const double colours[][3] = {{1, 0, 0},        {0, 1, 0},    {0, 0, 1}, {0, 0.7, 0.7},
                               {0.9, 0.01, 0.3}, {40, 41, 39}, {0, 0, 0}};
  for (const auto& colour : colours) {
    const double theta = 0.1 + 0.1 * static_cast<double>(samples.size());
    samples.pairs.push_back({spherical_direction(theta, 0), spherical_direction(0.5, 0)});
    samples.values.insert(samples.values.end(), colour, colour + 3);
  }
  const Source source{"colours", ScatteredBrdf(samples), {}};
  const Converted converted = convert(source, "openmaterial", {});
  EXPECT_THAT(converted.losses, Not(Contains(HasSubstr("below zero"))));
  const Samples read = parse_openmaterial(memory_file(converted.bytes), {}).samples;
  ASSERT_EQ(read.size(), samples.size());
  for (std::size_t i = 0; i < read.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(read.at(i)[c], samples.at(i)[c], 1e-13 * std::ranges::max(samples.at(i)));
}

TEST(OpenMaterial, KeepsLicenceAuthorsAndOrigin) {
  nlohmann::json document = nlohmann::json::parse(seeds::kOpenMaterial);
  document["metadata"] = {{"name", "asphalt"},
                          {"license", std::string(300, 'L') + " \"1\""},
                          {"copyrights", {"(C) A, B", "(C) \u00e9"}},
                          {"authors", {"A", "B"}},
                          {"sources", "measurement"}};
  const Source source = parse_source(memory_file(document.dump()), {.keep_spectral = true});
  const Converted converted = convert(source, "openmaterial", {});
  EXPECT_THAT(converted.losses, testing::IsEmpty());
  const auto written = nlohmann::json::parse(converted.bytes)["metadata"];
  for (const auto& [key, value] : document["metadata"].items()) EXPECT_EQ(written[key], value) << key;
  EXPECT_EQ(parse_source(memory_file(converted.bytes), {}).findings.origin, source.findings.origin);
  // Members that the source does not state are "unknown", because the schema demands them.
  document["metadata"] = {{"name", "x"}};
  const Source silent = parse_source(memory_file(document.dump()), {.keep_spectral = true});
  const auto other = nlohmann::json::parse(convert(silent, "openmaterial", {}).bytes)["metadata"];
  EXPECT_EQ(other["license"], "unknown");
  EXPECT_EQ(other["authors"], nlohmann::json::array({"unknown"}));
  EXPECT_EQ(other["sources"], "converted by burnish");
}

TEST(OpenMaterial, AveragesSamplesOfTheSameAngles) {
  // The samples have a repeated row, a turned one, and two beyond the schema's pi/2.
  const Vec3 low = spherical_direction(0.5, 0), high = spherical_direction(0.7, kPi);
  const Vec3 grazing = spherical_direction(1.5707961, 0), lower = spherical_direction(1.5707962, 0);
  const Samples samples{.channels = 1,
                        .isotropic = true,
                        .pairs = {{low, high},
                                  {low, high},
                                  {{-low.x, 0, low.z}, {-high.x, 0, high.z}},
                                  {low, grazing},
                                  {low, lower},
                                  {high, low}},
                        .values = {1, 2, 6, 4, -2, 5}};
  const OpenMaterialText written = format_openmaterial(samples, std::vector<double>{555}, "twice");
  EXPECT_EQ(written.averaged, 3u);
  const SampleFile file = parse_openmaterial(memory_file(written.text), kSpectral);
  EXPECT_EQ(file.samples.values, (std::vector<double>{3, 2, 5}));
}

TEST(OpenMaterial, SaysWhatIsAveragedWhereTheOrientationIsLost) {
  const Source source = parse_source(
      memory_file("theta_i,phi_i,theta_o,phi_o,value\n30,0,40,180,1\n30,180,40,0,3\n30,90,40,0,7\n"), {});
  const Converted converted = convert(source, "openmaterial", {});
  EXPECT_THAT(converted.losses, Contains("1 samples averaged with others of the same angles"));
  const SampleFile file = parse_openmaterial(memory_file(converted.bytes), kSpectral);
  EXPECT_THAT(file.samples.values, testing::UnorderedElementsAre(2, 7));
}

TEST(OpenMaterial, ReadsAsphaltAsItsOwnJsonHasIt) {
  BURNISH_NEEDS_DATA();
  const FileBytes bytes = read_file(data_folder() / "openmaterial" / "example_material_camera_brdf.xompt");
  const SampleFile file = parse_openmaterial(bytes, kSpectral);
  const auto rows = nlohmann::json::parse(bytes.text())["brdf"]["lookupTable"];
  ASSERT_EQ(file.samples.channels, 32);
  ASSERT_EQ(file.samples.size() * 32, rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::size_t band = row / file.samples.size(), sample = row % file.samples.size();
    EXPECT_NEAR(file.findings.lambda_nm[band], rows[row][0].get<double>() * 1e9, 1e-6);
    const auto& [wi, wo] = file.samples.pairs[sample];
    const double theta_o = rows[row][2].get<double>();
    EXPECT_EQ(file.samples.at(sample)[band], rows[row][4].get<double>());
    EXPECT_NEAR(theta_of(wi), rows[row][1].get<double>(), 1e-12);
    EXPECT_NEAR(theta_of(wo), theta_o, 1e-12);
    if (theta_o == 0) continue;  // the normal has no azimuth
    EXPECT_NEAR(std::remainder(phi_of(wo) - phi_of(wi) - rows[row][3].get<double>(), kTwoPi), 0, 1e-12);
  }
  const std::string again = format_openmaterial(file.samples, file.findings.lambda_nm, "asphalt").text;
  EXPECT_EQ(parse_openmaterial(memory_file(again), kSpectral).samples.values, file.samples.values);
}

}  // namespace
}  // namespace burnish
