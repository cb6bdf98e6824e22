// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/albedo.h>
#include <burnish/testing/directions.h>

namespace burnish {
namespace {

using ::testing::HasSubstr;

Rgb eval(const AnalyticBrdf& brdf, Vec3 wi, Vec3 wo) {
  std::array<double, 3> f{-1, -1, -1};
  EXPECT_TRUE(brdf.eval(wi, wo, f));
  return {f[0], f[1], f[2]};
}

/// Uniform in the hemisphere's solid angle.
Vec3 turned(Vec3 w, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * w.x - s * w.y, s * w.x + c * w.y, w.z};
}

/// Every model as it comes, and with parameters at their limits and channels that differ.
const std::vector<AnalyticBrdf>& specimens() {
  static const std::vector<AnalyticBrdf> all = [] {
    std::vector<AnalyticBrdf> brdfs;
    for (const AnalyticModel& model : analytic_models()) brdfs.push_back(parse_analytic(model.name));
    for (const char* spec : {
             "lambert:kd=0.1/0.5/1",
             "oren_nayar:sigma=0",
             "oren_nayar:sigma=1.5,kd=0.05",
             "phong_normalized:kd=0,ks=1,exponent=1",
             "blinn_phong_normalized:kd=0,ks=1,exponent=1",
             "blinn_phong_normalized:kd=0,ks=1,exponent=30",
             "lafortune:cx=-1,cy=-0.8,cz=0.7,exponent=8,ks=1/2/3,ks2=0.2,cx2=0.7,cy2=0.7",
             "ward:alpha_x=0.1,alpha_y=0.6",
             "ward_duer:alpha_x=0.1,alpha_y=0.6",
             "ward_bounded:alpha_x=0.15,alpha_y=1,kd=0,ks=1",
             "cook_torrance:alpha=1,f0=1",
             "cook_torrance:alpha=0.5,f0=0",
             "ashikhmin_shirley:exponent_x=10,exponent_y=500,f0=1/0.5/0,kd=0",
             "ggx:alpha_x=0.15,alpha_y=1,f0=1",
             "beckmann:alpha_x=1,alpha_y=0.15,f0=1",
             "poulin_fournier:spacing=2,height=1,kd=0,ks=1,exponent=20",
             "poulin_fournier:spacing=4,height=0.3,kd=1,ks=0",
             "ashikhmin_premoze_shirley:alpha_x=1,alpha_y=1,f0=1",
             "satin:correlation=0.35,kd=0,f0=1/0.5/0.2",
             "openpbr:base_metalness=1,specular_color=0/0.5/1,specular_roughness_anisotropy=0.7",
             "openpbr:coat_weight=1,coat_roughness=0.3,coat_roughness_anisotropy=0.5,base_color=0/0.5/1",
             "openpbr:fuzz_weight=1,fuzz_color=1/0/0.5,base_diffuse_roughness=1,base_metalness=0.5",
             "openpbr:thin_film_weight=0.7,thin_film_ior=2,base_metalness=0.4,coat_weight=0.6",
             "openpbr:specular_ior=1,coat_ior=1,coat_weight=1,thin_film_weight=1,thin_film_ior=1,"
             "specular_roughness=0,specular_roughness_anisotropy=1",
         })
      brdfs.push_back(parse_analytic(spec));
    return brdfs;
  }();
  return all;
}

TEST(AnalyticBrdf, IsReciprocal) {
  Pcg32 random(1);
  for (const AnalyticBrdf& brdf : specimens())
    for (int i = 0; i < 100 && brdf.model().reciprocal; ++i) {
      const Vec3 wi = random_upper_direction(random), wo = random_upper_direction(random);
      const Rgb there = eval(brdf, wi, wo), back = eval(brdf, wo, wi);
      EXPECT_NEAR(there.r, back.r, 1e-12 * there.r) << format_analytic(brdf);
      EXPECT_NEAR(there.b, back.b, 1e-12 * there.b) << format_analytic(brdf);
    }
}

TEST(AnalyticBrdf, IsFiniteAndNotNegativeEverywhere) {
  Pcg32 random(2);
  std::vector<Vec3> directions{{0, 0, 1}};
  for (const double z : {1e-3, 1e-9, 1e-14, 1e-160, 5e-324})
    for (const double phi : {0.0, kHalfPi, kPi, 3 * kHalfPi, 0.7})
      directions.push_back(normalize({std::cos(phi), std::sin(phi), z}));
  for (int i = 0; i < 20; ++i) directions.push_back(random_upper_direction(random));
  for (const AnalyticBrdf& brdf : specimens())
    for (const Vec3 wi : directions)
      for (const Vec3 wo : directions) {
        const Rgb f = eval(brdf, wi, wo);
        for (const double value : {f.r, f.g, f.b})
          ASSERT_TRUE(value >= 0 && std::isfinite(value))
              << format_analytic(brdf) << ": " << value << " at cosines " << wi.z << ", " << wo.z;
      }
}

TEST(AnalyticBrdf, IsZeroBelowTheHorizon) {
  const Vec3 up = normalize({0.3, 0.2, 0.9}), down = normalize({0.3, 0.2, -0.9}), level{1, 0, 0};
  for (const AnalyticBrdf& brdf : specimens())
    for (const Vec3 below : {down, level}) {
      EXPECT_EQ(eval(brdf, up, below), Rgb{});
      EXPECT_EQ(eval(brdf, below, up), Rgb{});
      EXPECT_EQ(eval(brdf, below, below), Rgb{});
    }
}

TEST(AnalyticBrdf, ChangesUnderRotationExactlyWhereItSaysSo) {
  for (const AnalyticBrdf& brdf : specimens()) {
    Pcg32 random(3);
    double change = 0;
    for (int i = 0; i < 100; ++i) {
      const Vec3 wi = random_upper_direction(random), wo = random_upper_direction(random);
      const double angle = kTwoPi * random.uniform();
      const double before = eval(brdf, wi, wo).r, after = eval(brdf, turned(wi, angle), turned(wo, angle)).r;
      change = std::max(change, std::abs(after - before) / (before + 1e-3));
    }
    EXPECT_EQ(change < 1e-9, brdf.isotropic()) << format_analytic(brdf) << ": " << change;
  }
}

TEST(AnalyticBrdf, IsSymmetricAboutTangentAndBitangent) {
  Pcg32 random(4);
  for (const AnalyticBrdf& brdf : specimens())
    for (int i = 0; i < 50; ++i) {
      const Vec3 wi = random_upper_direction(random), wo = random_upper_direction(random);
      const double f = eval(brdf, wi, wo).g;
      EXPECT_NEAR(f, eval(brdf, {-wi.x, wi.y, wi.z}, {-wo.x, wo.y, wo.z}).g, 1e-9 * (f + 1e-3))
          << format_analytic(brdf);
      EXPECT_NEAR(f, eval(brdf, {wi.x, -wi.y, wi.z}, {wo.x, -wo.y, wo.z}).g, 1e-9 * (f + 1e-3))
          << format_analytic(brdf);
    }
}

TEST(AnalyticBrdf, ReflectsNoMoreLightThanItReceivesWhereItSaysSo) {
  constexpr double kQuadratureError = 2e-3;
  for (const AnalyticBrdf& brdf : specimens()) {
    if (!brdf.model().conserving) continue;
    for (const double theta_deg : {0.0, 30.0, 60.0, 80.0, 88.0})
      for (const double phi_deg : {0.0, 50.0, 90.0})
        EXPECT_LE((albedo<64, 96>)(brdf.ref(), spherical_direction(radians(theta_deg), radians(phi_deg))),
                  1 + kQuadratureError)
            << format_analytic(brdf) << " at " << theta_deg << ", " << phi_deg << " degrees";
  }
}

TEST(AnalyticBrdf, GivesTheSameValuesThroughItsReference) {
  Pcg32 random(5);
  for (const AnalyticBrdf& brdf : specimens()) {
    const Vec3 wi = random_upper_direction(random), wo = random_upper_direction(random);
    std::array<double, 3> f;
    ASSERT_TRUE(brdf.ref().eval(wi, wo, f));
    EXPECT_EQ(eval(brdf, wi, wo), (Rgb{f[0], f[1], f[2]}));
    EXPECT_EQ(brdf.ref().channels(), 3);
    EXPECT_EQ(brdf.ref().isotropic(), brdf.isotropic());
  }
}

TEST(AnalyticSpec, ReadsBackWhatItWrites) {
  for (const AnalyticBrdf& brdf : specimens()) {
    const std::string spec = format_analytic(brdf);
    const AnalyticBrdf again = parse_analytic(spec);
    EXPECT_EQ(format_analytic(again), spec);
    EXPECT_TRUE(std::equal(again.values().begin(), again.values().end(), brdf.values().begin())) << spec;
  }
}

TEST(AnalyticSpec, FillsInDefaultsAndAcceptsColours) {
  EXPECT_EQ(format_analytic(parse_analytic("ggx")), "ggx:alpha_x=0.2,alpha_y=0.2,f0=0.9,kd=0");
  EXPECT_EQ(format_analytic(parse_analytic("ggx:")), "ggx:alpha_x=0.2,alpha_y=0.2,f0=0.9,kd=0");
  EXPECT_EQ(format_analytic(parse_analytic("ggx:f0=0.1/0.2/0.3,alpha_y=0.25")),
            "ggx:alpha_x=0.2,alpha_y=0.25,f0=0.1/0.2/0.3,kd=0");
  EXPECT_EQ(format_analytic(parse_analytic("lambert:kd=0.3/0.3/0.3")), "lambert:kd=0.3");
}

TEST(AnalyticSpec, IsToldFromAFileName) {
  for (const char* spec : {"ward", "ward:", "ward:ks=1", "ward:nonsense"})
    EXPECT_TRUE(is_analytic_spec(spec));
  for (const char* file : {"", ":", "ward.csv", "./ward", "wards", "nbrdf:a.csv#b", "ggx.exr"})
    EXPECT_FALSE(is_analytic_spec(file)) << file;
}

TEST(AnalyticSpec, NamesWhatIsWrong) {
  const struct {
    const char *spec, *expected;
  } kBad[] = {
      {"gxx", "found 'gxx'"},
      {"", "lambert, oren_nayar"},
      {"ggx:alpha=1", "alpha_x, alpha_y, f0, kd, found 'alpha=1'"},
      {"ggx:alpha_x=0", "ggx: alpha_x: expected a number in [0.001, 1], found '0'"},
      {"ggx:alpha_x=2", "found '2'"},
      {"ggx:alpha_x=nan", "found 'nan'"},
      {"ggx:alpha_x=inf", "found 'inf'"},
      {"ggx:alpha_x=1e999", "found '1e999'"},
      {"ggx:alpha_x=", "found ''"},
      {"ggx:alpha_x", "found ''"},
      {"ggx:alpha_x=0.1x", "found '0.1x'"},
      {"ggx:alpha_x=0.1/0.2/0.3", "expected a number in"},
      {"ggx:alpha_x=0.1/0.1", "found '0.1/0.1'"},
      {"ggx:f0=0.1/0.2", "red/green/blue"},
      {"ggx:f0=0.1/0.2/0.3/0.4", "red/green/blue"},
      {"ggx:f0=0.1/0.2/", "red/green/blue"},
      {"ggx:f0=0.1/0.2/-1", "found '0.1/0.2/-1'"},
      {"ggx:kd=0.1,kd=0.1", "kd: expected once"},
      {"ggx:,", "found ''"},
      {"ggx:kd=0.1,,f0=1", "found ''"},
  };
  for (const auto& bad : kBad) try {
      parse_analytic(bad.spec);
      ADD_FAILURE() << bad.spec << " was accepted";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(bad.expected)) << bad.spec;
    }
}

TEST(AnalyticModels, HaveDefaultsWithinTheirRanges) {
  for (const AnalyticModel& model : analytic_models()) {
    EXPECT_FALSE(model.description.empty()) << model.name;
    for (const AnalyticParameter& p : model.parameters) {
      EXPECT_FALSE(p.description.empty()) << model.name << ": " << p.name;
      EXPECT_LE(p.min, p.default_value) << model.name << ": " << p.name;
      EXPECT_GE(p.max, p.default_value) << model.name << ": " << p.name;
    }
  }
}

TEST(AnalyticModels, RefuseTheWrongNumberOfValues) {
  EXPECT_THROW(AnalyticBrdf(analytic_models().front(), {}), Error);
  EXPECT_THROW(AnalyticBrdf(analytic_models().front(), {0.1, 0.2}), Error);
}

}  // namespace
}  // namespace burnish
