#include <algorithm>
#include <functional>
#include <span>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/fitting/parametric/grain.h>
#include <burnish/fitting/parametric/material_fit.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using ::testing::HasSubstr;

const MaterialFitOptions kAlone{.beside = false, .figures = {.count = 2000, .image_size = 64}};

TEST(Unexplained, IsNothingOfTheSameAndSomethingOfWhatReturnsLight) {
  const AnalyticBrdf matt = parse_analytic("lambert:kd=0.3"),
                     back = parse_analytic("lafortune:kd=0.3,cx=0.9,cy=0.9,cz=0.9,exponent=20,ks=1"),
                     red = parse_analytic("lambert:kd=0.3/0.1/0.1");
  const Unexplained same = unexplained(matt.ref(), matt.ref());
  EXPECT_EQ(same.backscatter, 1);
  EXPECT_EQ(same.rings, 1);
  EXPECT_EQ(same.colour_shift, 0);
  EXPECT_EQ(same.grain, 1);
  const AnalyticBrdf along = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.1"),
                     across = parse_analytic("ggx:alpha_x=0.1,alpha_y=0.3");
  EXPECT_GT(unexplained(across.ref(), along.ref()).grain.value(), 4);
  EXPECT_NEAR(unexplained(along.ref(), across.ref()).grain.value() *
                  unexplained(across.ref(), along.ref()).grain.value(),
              1, 1e-9);
  EXPECT_GT(unexplained(back.ref(), matt.ref()).backscatter.value(), 1.2);
  EXPECT_GT(unexplained(red.ref(), matt.ref()).colour_shift.value(), 0.2);
}

/// A surface that is not known in places.
struct Gaps {
  BrdfRef whole;
  std::function<bool(Vec3 wi, Vec3 wo)> unknown;

  std::size_t channels() const noexcept { return whole.channels(); }
  bool isotropic() const noexcept { return whole.isotropic(); }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    std::ranges::fill(f, 0.0);
    return !unknown(wi, wo) && whole.eval(wi, wo, f);
  }
};

TEST(GrainDirection, IsAlongTheLongestHighlights) {
  const auto of = [](const char* spec) { return grain_direction(parse_analytic(spec).ref()); };
  EXPECT_EQ(of("ggx:alpha_x=0.3,alpha_y=0.1"), 0);
  EXPECT_EQ(of("ggx:alpha_x=0.1,alpha_y=0.3"), 90);
  EXPECT_EQ(of("ggx:alpha_x=0.2,alpha_y=0.2"), 0);
  EXPECT_EQ(of("ggx:alpha_x=0.2,alpha_y=0.201"), 0);  // hardly
  for (const double angle : {20.0, 60.5, 115.0, 170.0})
    EXPECT_NEAR(
        of(fmt::format("openpbr:base_metalness=1,specular_roughness_anisotropy=0.8,geometry_tangent={}",
                       angle)
               .c_str()),
        angle, 0.5);
  // where azimuths are not known, from the others
  const AnalyticBrdf across = parse_analytic("ggx:alpha_x=0.1,alpha_y=0.3");
  const Gaps few{across.ref(), [](Vec3 wi, Vec3) { return wi.x * wi.y > 0.02; }};
  EXPECT_NEAR(grain_direction(few), 90, 1e-9);
  EXPECT_EQ(grain_direction(Gaps{across.ref(), [](Vec3, Vec3) { return true; }}), 0);
}

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

TEST(Unexplained, SeesARing) {
  // brighter away from theta_h = 0
  const AnalyticBrdf ring = parse_analytic("lafortune:kd=0.1,cx=1.2,cy=1.2,cz=0.3,exponent=8,ks=1"),
                     matt = parse_analytic("lambert:kd=0.1");
  EXPECT_GT(unexplained(ring.ref(), matt.ref()).rings.value(), 1.5);
}

void expect_nothing_unexplained(const Unexplained& found) {
  EXPECT_NEAR(found.backscatter.value(), 1, 1e-12);
  EXPECT_NEAR(found.rings.value(), 1, 1e-12);
  EXPECT_NEAR(found.colour_shift.value(), 0, 1e-12);
}

TEST(Unexplained, LeavesOutWhatIsNotKnown) {
  const AnalyticBrdf even = parse_analytic("ggx:alpha_x=0.3,alpha_y=0.3,kd=0.3/0.1/0.1"),
                     brushed = parse_analytic("ggx:alpha_x=0.5,alpha_y=0.2,kd=0.3/0.1/0.1");
  // wi near wo below 50 degrees, and a hole in every series of theta_h
  const Gaps with_holes{even.ref(), [](Vec3 wi, Vec3 wo) {
                          return (angle_between(wi, wo) < radians(5) && theta_of(wi) < radians(50)) ||
                                 std::abs(theta_of(half_vector(wi, wo)) - radians(20)) < radians(3);
                        }};
  expect_nothing_unexplained(unexplained(with_holes, even.ref()));
  // one of four azimuths
  const Gaps with_a_side{brushed.ref(), [](Vec3 wi, Vec3 wo) { return (wi + wo).x < -1e-9; }};
  expect_nothing_unexplained(unexplained(with_a_side, brushed.ref()));
}

TEST(Unexplained, SaysNothingOfWhatIsNotKnownAtAll) {
  const AnalyticBrdf matt = parse_analytic("lambert:kd=0.3");
  const Gaps no_retro{matt.ref(), [](Vec3 wi, Vec3 wo) { return angle_between(wi, wo) < radians(10); }};
  const Unexplained found = unexplained(no_retro, matt.ref());
  EXPECT_FALSE(found.backscatter);
  EXPECT_TRUE(found.rings);
  EXPECT_TRUE(found.colour_shift);
  const Gaps nothing{matt.ref(), [](Vec3, Vec3) { return true; }};
  EXPECT_FALSE(unexplained(nothing, matt.ref()).rings);
  EXPECT_FALSE(unexplained(nothing, matt.ref()).colour_shift);
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
