// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/math/angles.h>
#include <burnish/reflectance/gltf_material.h>
#include <burnish/reflectance/metallic_roughness.h>
#include <burnish/testing/albedo.h>
#include <burnish/testing/analytic_values.h>

namespace burnish {
namespace {

const std::vector<DirectionPair> kPairs = {{fixtures::kA, fixtures::kB},
                                           {fixtures::at(75, 0), fixtures::at(80, 160)},
                                           {fixtures::at(0, 0), fixtures::at(89, 40)},
                                           {fixtures::kA, fixtures::kA},
                                           {fixtures::at(89.9, 3), fixtures::at(89.9, 200)}};

Rgb value(const GltfMaterial& material, Vec3 wi, Vec3 wo) {
  std::array<double, 3> f;
  material.eval(wi, wo, f);
  return {f[0], f[1], f[2]};
}

void expect_close(Rgb found, Rgb expected) {
  EXPECT_NEAR(found.r, expected.r, 1e-9 * expected.r);
  EXPECT_NEAR(found.g, expected.g, 1e-9 * expected.g);
  EXPECT_NEAR(found.b, expected.b, 1e-9 * expected.b);
}

const GltfMaterial kLayered{.base_color = {0.6, 0.3, 0.1},
                            .metallic = 0.25,
                            .roughness = 0.4,
                            .ior = 1.8,
                            .specular = 0.5,
                            .specular_color = {1, 0.5, 0.2},
                            .anisotropy = 0.5,
                            .iridescence = 0.75,
                            .iridescence_ior = 1.4,
                            .iridescence_thickness = 420};

TEST(GltfMaterial, IsTheCoreMaterialWithoutExtensions) {
  for (const double metallic : {0.0, 1.0}) {
    const MetallicRoughness core{{0.7, 0.4, 0.2}, metallic, 0.5};
    for (const auto& [wi, wo] : kPairs) {
      std::array<double, 3> f;
      core.eval(wi, wo, f);
      expect_close(value({.base_color = core.base_color, .metallic = metallic, .roughness = 0.5}, wi, wo),
                   {f[0], f[1], f[2]});
    }
  }
}

TEST(GltfMaterial, IsTheExtensionsTexts) {
  expect_close(value(kLayered, fixtures::kA, fixtures::kB),
               {0.17092093067770567, 0.08998182595871447, 0.031868815801217226});
  expect_close(value(kLayered, fixtures::at(75, 0), fixtures::at(80, 160)),
               {0.11883412755530404, 0.06902250050162985, 0.030762599396198128});
  GltfMaterial coated = kLayered;
  coated.clearcoat = 0.7;
  coated.clearcoat_roughness = 0.3;
  expect_close(value(coated, fixtures::kA, fixtures::kB),
               {0.1721982157163062, 0.09353592786624558, 0.037057636579068104});
}

TEST(GltfMaterial, HasSheenOverWhatItsAlbedoLeaves) {
  GltfMaterial black{.base_color = 0, .metallic = 1, .roughness = 1, .sheen_color = 1};
  black.sheen_roughness = 0.5;
  const GltfMaterial base{.base_color = {0.5, 0.2, 0.1}, .metallic = 0, .roughness = 0.7};
  GltfMaterial cloth = base;
  cloth.sheen_color = {0.4, 0.8, 0.2};
  cloth.sheen_roughness = 0.5;
  // a metal without colour still shines at grazing: what sheen adds is the difference of two colours'
  GltfMaterial half = black;
  half.sheen_color = {1, 0.5, 0};
  const Rgb white = value(black, fixtures::kA, fixtures::kB),
            tinted = value(half, fixtures::kA, fixtures::kB);
  EXPECT_NEAR(white.r - tinted.b, 0.0009395737460611691, 1e-12);
  EXPECT_NEAR(white.r - tinted.g, 0.5 * 0.0009395737460611691, 1e-12);
  const double left =
      1 - 0.8 * std::max(sheen_albedo(fixtures::kA.z, 0.5), sheen_albedo(fixtures::kB.z, 0.5));
  const double sheen = 0.0009395737460611691;
  expect_close(value(cloth, fixtures::kA, fixtures::kB),
               sheen * cloth.sheen_color + left * value(base, fixtures::kA, fixtures::kB));
}

TEST(GltfMaterial, KnowsTheAlbedoOfSheen) {
  EXPECT_NEAR(sheen_albedo(0.5, 0.5), 0.18785199434713776, 0.01);
  EXPECT_NEAR(sheen_albedo(std::cos(radians(80)), 0.3), 0.38307847124822997, 0.01);
  for (const double roughness : {0.07, 0.2, 0.5, 1.0}) {
    for (const double cosine : {0.0, 1e-3, 0.3, 1.0}) {
      EXPECT_GE(sheen_albedo(cosine, roughness), 0);
      EXPECT_LE(sheen_albedo(cosine, roughness), 1);
    }
    EXPECT_GE(sheen_albedo(0.2, roughness), sheen_albedo(0.9, roughness) - 0.05);
  }
}

TEST(GltfMaterial, ReflectsNoMoreThanItGetsAndNothingBelowZero) {
  GltfMaterial cloth = kLayered, coated = kLayered;
  cloth.sheen_color = {1, 0.7, 0.2};
  cloth.sheen_roughness = 0.4;
  coated.clearcoat = 1;
  coated.clearcoat_roughness = 0.2;
  for (GltfMaterial material : {kLayered, cloth, coated, GltfMaterial{.roughness = 0.3}}) {
    for (const auto& [wi, wo] : kPairs) {
      const Rgb f = value(material, wi, wo);
      EXPECT_GE(std::min({f.r, f.g, f.b}), 0);
      EXPECT_TRUE(std::isfinite(f.r + f.g + f.b));
    }
    material.base_color = 1;
    material.specular_color = 1;
    // the text's film gains a little at grazing, its dielectric a part of what its facets keep
    for (const double theta : {0.0, 40.0, 75.0})
      EXPECT_LE(albedo(material, fixtures::at(theta, 10)), 1.03) << theta;
  }
}

TEST(GltfMaterial, TurnsWithItsRotation) {
  for (const double rotation : {0.3, kHalfPi, 2.5}) {
    GltfMaterial material = kLayered;
    material.rotation = rotation;
    const auto turned = [&](Vec3 w) {
      const double c = std::cos(rotation), s = std::sin(rotation);
      return Vec3{c * w.x - s * w.y, s * w.x + c * w.y, w.z};
    };
    for (const auto& [wi, wo] : kPairs)
      expect_close(value(material, turned(wi), turned(wo)), value(kLayered, wi, wo));
  }
}

}  // namespace
}  // namespace burnish
