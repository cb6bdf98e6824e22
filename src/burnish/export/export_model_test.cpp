// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/export/export_model.h>
#include <burnish/export/export_openpbr.h>
#include <burnish/export/export_specular.h>
#include <burnish/export/manifest.h>
#include <burnish/export/web.h>
#include <burnish/file.h>
#include <burnish/fitting/parametric/metallic_roughness_fit.h>
#include <burnish/io/mbsdf.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/models.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

FactoredBrdf small_model() {
  return smooth_model({"", "pqpr", {"p=8", "q=16", "r=8"}, 3});
}

const std::string& file_of(const ExportedFiles& exported, const std::string& name) {
  for (const ExportedFile& file : exported.files)
    if (file.name == name) return file.bytes;
  throw std::out_of_range(name);
}

TEST(ExportTarget, HasANameThatFindsIt) {
  for (const std::string_view name : export_target_names()) EXPECT_EQ(to_string(export_target(name)), name);
  for (const ShaderLanguage language : kShaderLanguages)
    EXPECT_EQ(language_of(export_target(to_string(language))), language);
  EXPECT_THROW(export_target("jpeg"), Error);
}

TEST(Base64, WritesTheVectorsOfItsStandard) {  // RFC 4648, section 10
  const auto encoded = [](std::string_view text) { return base64(std::as_bytes(std::span(text))); };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(ExportModel, DescribesEveryFileInTheLastOne) {
  ExportOptions options{.to = {}, .name = "paint", .cells = 6};
  for (const std::string_view name : export_target_names())
    if (!BURNISH_SANITIZED || (name != "gltf" && name != "usda"))  // which look for materials for seconds
      options.to.push_back(export_target(name));
  const ExportedFiles exported = export_model(small_model(), options);
  const ExportedFile& manifest = exported.files.back();
  EXPECT_EQ(manifest.name, "paint.json");
  for (const ExportedFile& file : exported.files) {
    EXPECT_FALSE(file.bytes.empty()) << file.name;
    if (&file == &manifest) continue;
    EXPECT_THAT(manifest.bytes, HasSubstr('"' + file.name + '"'));
  }
  EXPECT_EQ(exported.shaders.size(), kShaderLanguages.size());
}

TEST(ExportModel, PutsTheModelIntoTheFilesOfTheWeb) {
  const ExportedFiles exported =
      export_model(small_model(), {.to = {ExportTarget::html, ExportTarget::three, ExportTarget::babylon}});
  for (const char* name : {"brdf.html", "brdf.three.js", "brdf.babylon.js"}) {
    const std::string& text = file_of(exported, name);
    EXPECT_THAT(text, HasSubstr("burnish_brdf_world"));
    EXPECT_THAT(text, Not(HasSubstr("MODEL")));
  }
  EXPECT_THAT(file_of(exported, "brdf.html"), Not(HasSubstr("src=")));
}

TEST(ExportModel, BringsTheMeasurementThatItsMdlModuleNames) {
  const ExportedFiles exported =
      export_model(small_model(), {.to = {ExportTarget::mdl}, .name = "paint", .cells = 8});
  EXPECT_THAT(exported.losses, ::testing::Contains(::testing::StartsWith("paint.mbsdf: sampled at")));
  EXPECT_THAT(file_of(exported, "paint.mdl"), HasSubstr("bsdf_measurement(\"./paint.mbsdf\")"));
  const AngleTable table = parse_mbsdf(memory_file(file_of(exported, "paint.mbsdf"))).table;  // of its values
  const auto [wi, wo] = node_directions(table, {0, 3, 2, 5});
  double f[3], expected[3];
  ASSERT_TRUE(table.eval(wi, wo, f));
  ASSERT_TRUE(small_model().eval(wi, wo, expected));
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(f[c], expected[c], 1e-5 * expected[c]);
}

TEST(ExportModel, BringsAreaLightsInEveryLanguageThatHasTextures) {
  if (BURNISH_SANITIZED) GTEST_SKIP() << "fits for a minute";
  ExportOptions options{
      .to = {ExportTarget::glsl, ExportTarget::wgsl, ExportTarget::cpp}, .name = "paint", .area = true};
  const ExportedFiles exported = export_model(small_model(), options);
  EXPECT_THAT(file_of(exported, "paint.area.glsl"),
              HasSubstr("vec3 burnish_paint_quad_world(vec3 n, vec3 t, vec3 v, "));
  EXPECT_THAT(file_of(exported, "paint.area.wgsl"),
              HasSubstr("@binding(16) var burnish_paint_area: texture_2d<f32>"));
  EXPECT_FALSE(file_of(exported, "paint.area.ktx2").empty());
  EXPECT_THAT(exported.files.back().bytes, HasSubstr("\"paint.area.glsl\""));
  EXPECT_THROW(file_of(exported, "paint.area.cpp"), std::out_of_range);
  options.to = {ExportTarget::cpp};
  EXPECT_THROW(export_model(small_model(), options), Error);
}

TEST(ExportModel, NamesTexturesAsTheirSamplersDo) {
  const FactoredBrdf brdf = smooth_model(model_case("Volumes"));
  const ExportedFiles exported = export_model(brdf, {.to = {ExportTarget::wgsl, ExportTarget::dds},
                                                     .name = "paint",
                                                     .notes = R"({"psnr": 41.5, "source": "a"})"});
  const auto manifest = nlohmann::json::parse(exported.files.back().bytes);
  ASSERT_EQ(manifest["textures"].size(), 2u);
  for (const std::size_t i : {0u, 1u}) {
    const std::string kind = i == 0 ? "tables" : "volumes";
    const nlohmann::json& texture = manifest["textures"][i];
    EXPECT_EQ(texture["sampler"], "burnish_paint_" + kind);
    EXPECT_EQ(texture["file"], "paint." + kind + ".ktx2");
    EXPECT_EQ(texture["dds"], "paint." + kind + ".dds");
    EXPECT_EQ(texture["filter"], "linear");
    EXPECT_TRUE(file_of(exported, texture["dds"]).starts_with("DDS "));
    EXPECT_THAT(file_of(exported, "paint.wgsl"), HasSubstr("var burnish_paint_" + kind + ":"));
  }
  EXPECT_EQ(manifest["errors"], nlohmann::json({{"psnr", 41.5}, {"source", "a"}}));

  const ExportedFiles alone = export_model(brdf, {.to = {ExportTarget::dds}, .name = "paint", .exact = true});
  const auto other = nlohmann::json::parse(alone.files.back().bytes);
  EXPECT_EQ(alone.files.size(), 3u);
  EXPECT_EQ(other["textures"][0]["file"], "paint.tables.dds");
  EXPECT_EQ(other["textures"][0]["filter"], "any");
  EXPECT_FALSE(other.contains("errors"));
}

TEST(ExportModel, TellsTheDirectionOfTheCoreMaterialsAnisotropy) {
  if (BURNISH_SANITIZED) GTEST_SKIP() << "looks for a material for seconds";
  for (const bool across : {false, true}) {
    const double narrow = 0.15, wide = 0.45;
    const AnalyticBrdf brdf = parse_analytic(
        fmt::format("ggx:alpha_x={},alpha_y={},f0=0.9", across ? narrow : wide, across ? wide : narrow));
    const MetallicRoughnessFit core = fit_metallic_roughness(brdf);
    const nlohmann::json entry = core_entry(core.material);
    EXPECT_GT(entry["anisotropyStrength"].get<double>(), 0.2);
    EXPECT_NEAR(entry["anisotropyRotation"].get<double>(), across ? 1.5707963 : 0, 1e-6);
  }
}

TEST(ExportModel, RefusesPlacesThatNoTargetHas) {
  const auto exports = [](ExportTarget to, const ShaderPlaces& places) {
    return export_model(small_model(), {.to = {to}, .places = places});
  };
  EXPECT_THAT(file_of(exports(ExportTarget::glsl, {.set = 1}), "brdf.glsl"), HasSubstr("layout(set = 1"));
  EXPECT_THROW(exports(ExportTarget::glsl_es, {.binding = 1}), Error);
  EXPECT_THROW(exports(ExportTarget::hlsl, {.set = 1}), Error);
  EXPECT_THROW(exports(ExportTarget::slang, {.space = 1}), Error);
}

TEST(ExportModel, RefusesAnEnvironmentThatNothingShows) {
  EXPECT_THROW(
      export_model(small_model(), {.to = {ExportTarget::ktx2}, .environment = find_environment("sun")}),
      Error);
}

TEST(ExportModel, MultipliesInHalfPrecisionWhereAsked) {
  const FactoredBrdf brdf = smooth_model(model_case("Volume"));
  std::vector<ExportTarget> languages;
  for (const ShaderLanguage language : kShaderLanguages)
    languages.push_back(export_target(to_string(language)));
  const ExportedFiles exported = export_model(brdf, {.to = languages, .name = "paint", .half = true}),
                      single = export_model(brdf, {.to = languages, .name = "paint"});
  const std::pair<const char*, const char*> types[] = {
      {"paint.glsl", "mediump vec3"}, {"paint.es.glsl", "mediump vec3"}, {"paint.hlsl", "min16float3"},
      {"paint.metal", "half3"},       {"paint.slang", "half3"},          {"paint.wgsl", "vec3h"}};
  for (const auto& [file, type] : types) {
    EXPECT_THAT(file_of(exported, file), HasSubstr(type)) << file;
    EXPECT_THAT(file_of(single, file), Not(HasSubstr(type))) << file;
  }
  EXPECT_EQ(file_of(exported, "paint.h"), file_of(single, "paint.h"));
  for (const ExportedShader& shader : exported.shaders)
    EXPECT_EQ(shader.how, shader.file == "paint.h" ? "exact filter" : "hardware filter, half products");
  EXPECT_THAT(file_of(exported, "paint.json"), HasSubstr("\"products\": \"half\""));
  EXPECT_THAT(file_of(single, "paint.json"), Not(HasSubstr("\"products\"")));

  EXPECT_THROW(export_model(brdf, {.to = {ExportTarget::cpp, ExportTarget::ktx2}, .half = true}), Error);
  EXPECT_THROW(export_model(brdf, {.to = {ExportTarget::glsl}, .exact = true, .half = true}), Error);
}

TEST(ExportSpecular, TakesTheCheapestPowerOrTheOneNamed) {
  const ExportOptions options{.to = {ExportTarget::wgsl}, .name = "shine"};
  const std::string spec = "blinn_phong:exponent=60";
  EXPECT_EQ(export_specular(spec, {}, options).shaders.at(0).how, "cubic2");
  EXPECT_EQ(export_specular(spec, PowerMethod::w8, options).shaders.at(0).how, "w8");
  EXPECT_THROW(export_specular("ggx", {}, options), Error);
  EXPECT_THROW(export_specular(spec, {}, {.to = {ExportTarget::gltf}}), Error);
}

TEST(ExportOpenPbr, WritesParametersAndTables) {
  const ExportOptions options{.to = {ExportTarget::materialx, ExportTarget::usda, ExportTarget::mdl,
                                     ExportTarget::gltf, ExportTarget::rgl},
                              .name = "paint",
                              .cells = 6};
  const ExportedFiles exported = export_openpbr(parse_analytic("openpbr:coat_weight=1"), options);
  std::vector<std::string> names;
  for (const ExportedFile& file : exported.files) names.push_back(file.name);
  EXPECT_THAT(names, ::testing::ElementsAre("paint.mtlx", "paint.usda", "paint.mdl", "paint.mbsdf",
                                            "paint.glb", "paint.bsdf", "paint.json"));
  for (const std::string& name : names)
    EXPECT_TRUE(name == "paint.json" ||
                exported.files.back().bytes.find('"' + name + '"') != std::string::npos)
        << name;
  using ::testing::StartsWith;
  EXPECT_THAT(exported.losses, ::testing::ElementsAre(StartsWith("paint.mbsdf: sampled at"),
                                                      StartsWith("paint.bsdf: sampled at")));
  EXPECT_THROW(export_openpbr(parse_analytic("ggx"), options), Error);
  EXPECT_THROW(export_openpbr(parse_analytic("openpbr"), {.to = {ExportTarget::ktx2}}), Error);
}

TEST(ExportOpenPbr, WritesItsFormulasForEveryLanguageAndTheWeb) {
  ExportOptions options{.to = {ExportTarget::three, ExportTarget::babylon, ExportTarget::html},
                        .name = "paint"};
  for (const ShaderLanguage language : kShaderLanguages)
    options.to.push_back(export_target(to_string(language)));
  const ExportedFiles exported = export_openpbr(parse_analytic("openpbr:coat_weight=1"), options);
  EXPECT_EQ(exported.shaders.size(), kShaderLanguages.size());
  EXPECT_EQ(exported.files.size(), options.to.size() + 1) << "no textures";
  for (const ExportedShader& shader : exported.shaders) EXPECT_EQ(shader.cost, exported.shaders[0].cost);
  for (const ExportedFile& file : exported.files) {
    EXPECT_THAT(file.bytes, HasSubstr("burnish_paint_world")) << file.name;
    EXPECT_TRUE(file.name == "paint.json" ||
                exported.files.back().bytes.find('"' + file.name + '"') != std::string::npos)
        << file.name;
  }
}

TEST(WriteFiles, MakesTheFolder) {
  const TemporaryFolder scratch("write_files");
  const std::vector<ExportedFile> files{{"a", "one"}, {"b", "two"}};
  write_files(scratch.path / "new/folder", files);
  EXPECT_EQ(read_file(scratch.path / "new/folder/b").text(), "two");
  EXPECT_THROW(write_files(scratch.path / "new/folder/a", files), Error);
}

}  // namespace
}  // namespace burnish
