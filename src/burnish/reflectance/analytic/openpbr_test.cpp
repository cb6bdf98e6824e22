// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <gtest/gtest.h>

#include <burnish/formula/graph.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/analytic/openpbr_expression.h>
#include <burnish/testing/albedo.h>
#include <burnish/testing/directions.h>
#include <burnish/testing/graph_values.h>
#include <burnish/testing/openpbr_materials.h>

namespace burnish {
namespace {

Rgb eval(const OpenPbrParameters& parameters, Vec3 wi, Vec3 wo) {
  std::array<double, 3> f;
  OpenPbr(parameters).eval(wi, wo, f);
  return {f[0], f[1], f[2]};
}

const Vec3 kLight = normalize({0.4, 0.2, 0.7}), kViewer = normalize({-0.5, 0.1, 0.6});

// With index 1 the highlight is gone, but the fit of its albedo still takes a little from the base.
TEST(OpenPbr, ItsBaseIsLambertianWhereItIsSmooth) {
  const OpenPbrParameters matt{.base_color = {0.2, 0.5, 0.8}, .specular_ior = 1};
  const Rgb here = eval(matt, kLight, kViewer), there = eval(matt, normalize({-0.7, 0.2, 0.3}), kViewer);
  EXPECT_NEAR(here.r, there.r, 1e-12);
  EXPECT_NEAR(here.b / here.r, 4, 1e-6);  // the loss is the same share in every channel
  EXPECT_LE(here.b, 0.8 / kPi);
}

TEST(OpenPbr, AsAMetalHasTheDensityOfItsFacets) {
  const OpenPbrParameters metal{.base_color = 0.9, .base_metalness = 1, .specular_roughness = 0.05};
  // The peak is D F / 4, with nothing masked.
  const double alpha = 0.0025;
  EXPECT_NEAR(eval(metal, {0, 0, 1}, {0, 0, 1}).g, 0.9 / (4 * kPi * alpha * alpha),
              0.01 * 0.9 / (4 * kPi * alpha * alpha));
}

TEST(OpenPbr, LosesNoLightBetweenRoughFacets) {
  for (const double roughness : {0.3, 0.6, 0.9}) {
    const OpenPbrParameters white{.base_color = 1, .base_metalness = 1, .specular_roughness = roughness};
    const OpenPbr metal(white);
    // The bound allows for the fit of the albedo, within 2 % by its source, and for the integral of the albedo.
    EXPECT_NEAR((albedo<128, 192>)(metal, normalize({0.3, 0.2, 0.8})), 1, 0.05) << roughness;
  }
}

TEST(OpenPbr, StretchesAlongTheTangent) {
  const OpenPbrParameters brushed{.base_metalness = 1, .specular_roughness_anisotropy = 0.8};
  const Vec3 along = normalize({0.3, 0, 1}), across = normalize({0, 0.3, 1});
  EXPECT_GT(eval(brushed, along, {0, 0, 1}).g, 2 * eval(brushed, across, {0, 0, 1}).g);
  EXPECT_FALSE(OpenPbr(brushed).isotropic());
}

// Every input moves on its own, from a material with all layers and from materials that lack some.
TEST(OpenPbr, VariantsHaveTheBitsOfEachAlone) {
  const OpenPbrParameters all{.base_metalness = 0.4,
                              .base_diffuse_roughness = 0.3,
                              .coat_weight = 0.5,
                              .coat_roughness = 0.2,
                              .fuzz_weight = 0.4,
                              .thin_film_weight = 0.6,
                              .thin_film_thickness = 0.4};
  const OpenPbrParameters bare{.base_metalness = 1, .thin_film_weight = 0.5, .thin_film_thickness = 0},
      turned{.coat_weight = 0.5, .coat_roughness = 0.2, .geometry_tangent = 40};  // isotropic, `others` not
  for (const OpenPbrParameters& start : {all, bare, turned, OpenPbrParameters{}}) {
    std::vector<OpenPbr> others;
    for (const OpenPbrInput& input : kOpenPbrInputs)
      for (const double value : {0.0, 0.37, 1.0}) {
        if (input.name == "geometry_tangent") continue;  // all variants share the tangent
        OpenPbrParameters moved = start;
        std::visit([&](auto member) { moved.*member = std::max(value, input.min); }, input.member);
        others.emplace_back(moved);
      }
    const OpenPbrVariants variants(OpenPbr(start), others);
    std::vector<double> found(3 * (1 + others.size()));
    std::array<double, 3> alone;
    for (const Vec3 wi : {kLight, kViewer, Vec3{0, 0, 1}, normalize({0.9, 0.1, 0.05}), Vec3{0, 0.6, -0.8}}) {
      variants.eval(wi, kViewer, found);
      for (std::size_t i = 0; i <= others.size(); ++i) {
        (i == 0 ? OpenPbr(start) : others[i - 1]).eval(wi, kViewer, alone);
        for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(found[3 * i + c], alone[c]) << i;
      }
    }
  }
}

// Materials are drawn with and without each layer. Directions are drawn anywhere, in highlights, and in corners:
// along the normal, equal, mirrored, at the horizon.
TEST(OpenPbr, ItsExpressionIsTheDefinition) {
  Pcg32 random(8);
  for (int m = 0; m < 200; ++m) {
    OpenPbrParameters p = m == 0 ? OpenPbrParameters{} : draw_openpbr(random);
    if (m % 10 == 1) p.base_diffuse_roughness = p.thin_film_thickness = 0;
    const OpenPbr material(p);
    Graph graph;
    const std::size_t root = graph.add(openpbr_expression(material));
    std::vector<DirectionPair> pairs = {{{0, 0, 1}, {0, 0, 1}},
                                        {{0, 0, 1}, kViewer},
                                        {kLight, {0, 0, 1}},
                                        {kLight, kLight},
                                        {mirror(kViewer), kViewer},
                                        {normalize({1, 0, 1e-3}), kViewer},
                                        {kLight, normalize({0, 1, 1e-3})},
                                        {normalize({1, 0, 1e-3}), normalize({-1, 0, 1e-3})}};
    for (int i = 0; i < 50; ++i)
      pairs.push_back(draw_highlight_pair(random, i % 2 == 0 ? p.specular_roughness : p.coat_roughness));
    for (const auto& [wi, wo] : pairs) {
      std::array<double, 3> f;
      material.eval(wi, wo, f);
      const auto found =
          graph_values(graph, {.values = {{"wi", {wi.x, wi.y, wi.z}}, {"wo", {wo.x, wo.y, wo.z}}}})[root];
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], f[c], 1e-9 * f[c])
            << format_analytic(analytic_openpbr(p)) << " at " << wi.x << " " << wi.y << " " << wi.z << ", "
            << wo.x << " " << wo.y << " " << wo.z;
    }
  }
}

TEST(OpenPbr, ItsExpressionHasNothingOfLayersWithoutWeight) {
  const auto nodes = [](const OpenPbrParameters& p) {
    Graph graph;
    graph.add(openpbr_expression(OpenPbr(p)));
    return graph.nodes().size();
  };
  OpenPbrParameters p;
  const std::size_t plain = nodes(p);
  p.coat_roughness = p.fuzz_roughness = p.thin_film_thickness = 0.3;
  p.coat_color = p.fuzz_color = {0.1, 0.2, 0.3};
  EXPECT_EQ(nodes(p), plain);
  p.base_metalness = 1;
  EXPECT_LT(nodes(p), plain) << "no diffuse base";
  p.coat_weight = 0.5;
  EXPECT_GT(nodes(p), plain);
}

TEST(OpenPbr, WeightsOfZeroLeaveNothingOfALayer) {
  const OpenPbrParameters plain;
  OpenPbrParameters dressed;
  dressed.coat_color = {0.1, 0.2, 0.3};
  dressed.coat_roughness = 0.7;
  dressed.fuzz_color = {1, 0, 0};
  dressed.thin_film_thickness = 0.3;
  EXPECT_EQ(eval(plain, kLight, kViewer), eval(dressed, kLight, kViewer));
}

TEST(OpenPbr, ACoatDarkensAndAFilmColours) {
  OpenPbrParameters p;
  const Rgb bare = eval(p, kLight, {0, 0, 1});
  p.coat_weight = 1;
  const Rgb coated = eval(p, kLight, {0, 0, 1});
  EXPECT_LT(coated.g, bare.g);
  EXPECT_EQ(coated.r, coated.b);
  p.coat_weight = 0;
  p.thin_film_weight = 1;
  const Vec3 mirrored = normalize({0.05, 0, 1});
  const Rgb filmed = eval(p, mirrored, mirror(mirrored));
  EXPECT_GT(std::abs(filmed.r - filmed.b), 0.01 * filmed.g);
}

TEST(OpenPbr, ATurnedTangentTurnsWhatIsAnisotropic) {
  OpenPbrParameters p{.specular_roughness = 0.5, .coat_weight = 0.5, .coat_roughness = 0.4};
  OpenPbrParameters turned = p;
  turned.geometry_tangent = 30;
  const Vec3 viewer = normalize({0.3, -0.4, 1});
  const auto turn = [](Vec3 w) {
    const double c = std::sqrt(0.75), s = 0.5;
    return Vec3{c * w.x - s * w.y, s * w.x + c * w.y, w.z};
  };
  EXPECT_NEAR(eval(turned, kLight, viewer).r, eval(p, kLight, viewer).r, 1e-12);  // both are isotropic
  EXPECT_TRUE(OpenPbr(turned).isotropic());
  for (double OpenPbrParameters::*anisotropy :
       {&OpenPbrParameters::specular_roughness_anisotropy, &OpenPbrParameters::coat_roughness_anisotropy}) {
    p.*anisotropy = turned.*anisotropy = 0.8;
    const double straight = eval(p, kLight, viewer).r;
    EXPECT_NEAR(eval(turned, turn(kLight), turn(viewer)).r, straight, 1e-12 * straight);
    EXPECT_GT(std::abs(eval(turned, kLight, viewer).r / straight - 1), 1e-3);
  }
}

TEST(OpenPbr, KeepsItsParametersAsAnAnalyticBrdf) {
  OpenPbrParameters p;
  p.base_color = {0.1, 0.2, 0.3};
  p.coat_ior = 1.7;
  p.thin_film_thickness = 0.25;
  p.geometry_tangent = 12.5;
  const AnalyticBrdf brdf = parse_analytic(format_analytic(analytic_openpbr(p)));
  EXPECT_EQ(std::get<OpenPbr>(brdf.variant()).parameters(), p);
  EXPECT_FALSE(brdf.model().reciprocal);
}

}  // namespace
}  // namespace burnish
