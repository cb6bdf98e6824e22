// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/fitting/parametric/material_fit.h>
#include <burnish/io/open_source.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using ::testing::HasSubstr;

const MaterialFitOptions kAlone{.beside = false, .figures = {.count = 2000, .image_size = 64}};

TEST(FitMaterial, TurnsTheTangentToTheGrain) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const auto psnr = [](const char* spec, double tangent) {
    const MaterialFit fit = fit_material(open_source(spec, {}), "openpbr", kAlone);
    EXPECT_EQ(std::get<OpenPbr>(fit.material).parameters().geometry_tangent, tangent) << spec;
    EXPECT_NEAR(fit.beyond.grain.value(), 1, 0.1) << spec;
    return fit.figures.psnr;
  };
  EXPECT_GT(psnr("ggx:alpha_x=0.4,alpha_y=0.15,f0=0.8", 0), 40);
  EXPECT_GT(psnr("ggx:alpha_x=0.15,alpha_y=0.4,f0=0.8", 90), 40);
}

TEST(MaterialFit, OfOpenPbrIsAFileThatIsOpenedAgain) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const Source source = open_source("openpbr:base_color=0.2/0.3/0.5,specular_roughness=0.5", {});
  const MaterialFit fit = fit_material(source, "openpbr", kAlone);
  EXPECT_GT(fit.figures.psnr, 80);
  EXPECT_FALSE(fit.factored);
  const Source again = parse_source(memory_file(format_material(fit)), {});
  const auto& brdf = std::get<AnalyticBrdf>(again.brdf);
  EXPECT_EQ(std::get<OpenPbr>(brdf.variant()).parameters(), std::get<OpenPbr>(fit.material).parameters());
  const auto json = nlohmann::json::parse(summary_json(fit, "x.json"));
  EXPECT_EQ(json.at("parameters").at("specular_roughness"), brdf.values()[6].r);
  EXPECT_EQ(json.at("spec"), format_analytic(brdf));
}

TEST(MaterialFit, SimpleHasBaseAndSpecularAloneAndSaysWhatLayersWouldGive) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const Source source = open_source(
      "openpbr:base_color=0.5/0.1/0.1,specular_roughness=0.6,coat_weight=1,coat_roughness=0.1", {});
  MaterialFitOptions options = kAlone;
  options.simple = true;
  EXPECT_FALSE(fit_material(source, "openpbr", options).layered);
  options.beside = true;
  const MaterialFit fit = fit_material(source, "openpbr", options);
  const OpenPbrParameters p = std::get<OpenPbr>(fit.material).parameters();
  EXPECT_EQ(p.coat_weight + p.fuzz_weight + p.thin_film_weight, 0);
  ASSERT_TRUE(fit.layered);
  EXPECT_GT(fit.layered->psnr, fit.figures.psnr + 3);
  EXPECT_EQ(nlohmann::json::parse(summary_json(fit, "")).at("layered").at("relative"), fit.layered->relative);
  EXPECT_THAT(error_of([&] { fit_material(source, "gltf", options); }), HasSubstr("found gltf"));
}

TEST(MaterialFit, OfGltfIsAGltfMaterial) {
  const Source source = open_source("ggx:alpha_x=0.16,alpha_y=0.16,f0=0.9/0.6/0.3", {});
  const MaterialFit fit = fit_material(source, "gltf", kAlone);
  EXPECT_GT(fit.figures.psnr, 30);
  const auto json = nlohmann::json::parse(format_material(fit));
  EXPECT_EQ(json.at("asset").at("version"), "2.0");
  const auto& material = json.at("materials").at(0).at("pbrMetallicRoughness");
  EXPECT_NEAR(material.at("roughnessFactor").get<double>(), 0.4, 0.05);
  EXPECT_FALSE(json.contains("extensionsUsed"));
}

TEST(MaterialFit, SaysTheFactoredModelsFiguresBeside) {
  BURNISH_SKIP_WHERE_SANITIZED();
  MaterialFitOptions options = kAlone;
  options.beside = true;
  const MaterialFit fit = fit_material(open_source("lambert", {}), "gltf", options);
  ASSERT_TRUE(fit.factored);
  EXPECT_GT(fit.factored->figures.psnr, 40);
  EXPECT_GT(fit.factored->bytes, 0);
}

TEST(MaterialFit, RefusesWhatItDoesNotKnow) {
  const Source source = open_source("lambert", {});
  EXPECT_THAT(error_of([&] { fit_material(source, "opnpbr", kAlone); }),
              HasSubstr("expected openpbr or gltf, found 'opnpbr'; did you mean 'openpbr'?"));
}

// Three channels alike, as one: no colour, and no film, which would have some.
TEST(MaterialFit, KeepsGreySourcesGrey) {
  BURNISH_SKIP_WHERE_SANITIZED();
  for (const char* spec : {"ggx:alpha_x=0.3,alpha_y=0.3,f0=0.04/0.04/0.04,kd=0.5/0.5/0.5",
                           "lafortune:kd=0.1,cx=1.2,cy=1.2,cz=0.3,exponent=8,ks=1"})
    for (const char* to : {"openpbr", "gltf"}) {
      const MaterialFit found = fit_material(open_source(spec, {}), to, kAlone);
      std::vector<double> f(3);
      for (const double theta : {0.1, 0.6, 1.2}) {
        std::visit(
            [&](const auto& material) {
              BrdfRef(material).eval(spherical_direction(theta, 0), spherical_direction(0.4, 2), f);
            },
            found.material);
        EXPECT_NEAR(f[0], f[1], 1e-6 * f[0]) << spec << ' ' << to;
        EXPECT_NEAR(f[0], f[2], 1e-6 * f[0]) << spec << ' ' << to;
      }
    }
}

}  // namespace
}  // namespace burnish
