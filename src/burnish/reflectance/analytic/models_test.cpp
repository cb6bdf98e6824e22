// Reference values of the models: closed forms at special directions, and the numbers that
// tests/reference/analytic_models.py prints, computed apart from the library from angles and the textbook forms
// (albedos by the midpoint rule over half vectors, cylinders by rays against the circles around).

#include <array>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/testing/albedo.h>

namespace burnish {
namespace {

const Vec3 kNormal{0, 0, 1};

Vec3 at(double theta_deg, double phi_deg) {
  return spherical_direction(radians(theta_deg), radians(phi_deg));
}

// A general pair, off every plane of symmetry.
const Vec3 kA = at(50, 20), kB = at(35, 170);

template <Brdf T>
double grey(const T& brdf, Vec3 wi, Vec3 wo) {
  std::array<double, 3> f;
  brdf.eval(wi, wo, f);
  return f[0];
}

TEST(Lambert, IsConstant) {
  EXPECT_DOUBLE_EQ(grey(Lambert{0.7}, kA, kB), 0.7 / kPi);
}

TEST(OrenNayar, HasItsClosedFormAtNormalIncidence) {
  // beta = 0 leaves C1 and the interreflection.
  const double s2 = 0.36, rho = 0.7;
  const double expected =
      rho / kPi * (1 - 0.5 * s2 / (s2 + 0.33)) + 0.17 * rho * rho / kPi * s2 / (s2 + 0.13);
  EXPECT_NEAR(grey(OrenNayar{rho, 0.6}, kNormal, at(70, 30)), expected, 1e-14);
  EXPECT_DOUBLE_EQ(grey(OrenNayar{rho, 0}, kA, kB), rho / kPi);
}

TEST(OrenNayar, MatchesReferenceValuesForwardAndBackward) {
  EXPECT_NEAR(grey(OrenNayar{0.7, 0.6}, kA, kB), 0.1524495760831324, 1e-14);
  EXPECT_NEAR(grey(OrenNayar{0.7, 0.6}, at(60, 0), at(40, 30)), 0.2316318931923341, 1e-14);
}

TEST(OrenNayar, ConservesLightUpToAnAlbedoOfNineTenths) {
  for (const double sigma : {0.1, 0.275, 0.6, 1.5})
    for (const double theta_deg : {0.0, 40.0, 70.0, 85.0})
      EXPECT_LT((albedo<48, 64>)(OrenNayar{0.9, sigma}, at(theta_deg, 0)), 0.95) << sigma;
  EXPECT_GT(albedo(OrenNayar{1, 0.275}, at(85, 0)), 1.01);
}

TEST(Phong, HasItsPowerAtKnownAngles) {
  // Towards the light from 30 degrees, cos(gamma) = 2 cos² - 1 = 1/2.
  const Phong lobe{.kd = 0, .ks = 1, .exponent = 3, .normalized = false};
  EXPECT_NEAR(grey(lobe, at(30, 40), at(30, 40)), 0.125, 1e-14);
  EXPECT_NEAR(grey(lobe, at(30, 40), at(30, 220)), 1, 1e-14);
  EXPECT_EQ(grey(lobe, at(60, 40), at(60, 40)), 0);
}

TEST(Phong, ReflectsEverythingAtNormalIncidenceWhereNormalized) {
  for (const double exponent : {1.0, 7.5, 100.0})
    EXPECT_NEAR(albedo(Phong{.kd = 0, .ks = 1, .exponent = exponent}, kNormal), 1, 1e-5) << exponent;
}

TEST(BlinnPhong, HasItsPowerAtKnownAngles) {
  const BlinnPhong lobe{.kd = 0, .ks = 1, .exponent = 4, .normalized = false};
  EXPECT_NEAR(grey(lobe, at(60, 40), at(60, 40)), 0.0625, 1e-14);  // h is at 60 degrees
  EXPECT_NEAR(grey(lobe, at(75, 40), at(75, 220)), 1, 1e-14);
}

TEST(BlinnPhong, ReflectsEverythingAtNormalIncidenceWhereNormalized) {
  for (const double exponent : {1.0, 7.5, 100.0})
    EXPECT_NEAR(albedo(BlinnPhong{.kd = 0, .ks = 1, .exponent = exponent}, kNormal), 1, 1e-3) << exponent;
}

TEST(Lafortune, SumsItsLobes) {
  Lafortune brdf{.kd = 0, .lobes = {}};
  brdf.lobes[1] = {.cx = -0.8, .cy = -0.9, .cz = 0.7, .exponent = 4, .ks = 1};
  EXPECT_NEAR(grey(brdf, kA, kB), 0.20197343027903056, 1e-14);
  brdf.lobes[2] = {.cx = 0, .cy = 0, .cz = 1, .exponent = 1, .ks = 2};
  EXPECT_NEAR(grey(brdf, kA, kB), 0.20197343027903056 + 2 * kA.z * kB.z, 1e-14);
}

TEST(Lafortune, IsPhongWithTheCoefficientsOfTheMirror) {
  Lafortune brdf{.kd = 0.1, .lobes = {}};
  brdf.lobes[0] = {.cx = -1, .cy = -1, .cz = 1, .exponent = 12, .ks = 0.5};
  const Phong phong{.kd = 0.1, .ks = 0.5, .exponent = 12, .normalized = false};
  EXPECT_NEAR(grey(brdf, kA, kB), grey(phong, kA, kB), 1e-14);
}

TEST(Ward, AgreesInAllNormalizationsAtNormalIncidence) {
  for (const auto n : {Ward::Normalization::ward, Ward::Normalization::duer, Ward::Normalization::bounded})
    EXPECT_NEAR(grey(Ward{0.2, 0.5, 0, 1, n}, kNormal, kNormal), 1 / (4 * kPi * 0.1), 1e-14);
}

TEST(Ward, MatchesReferenceValues) {
  EXPECT_NEAR(grey(Ward{0.3, 0.5, 0, 1, Ward::Normalization::ward}, kA, kB), 0.5052092823348826, 1e-14);
  EXPECT_NEAR(grey(Ward{0.3, 0.5, 0, 1, Ward::Normalization::duer}, kA, kB), 0.6962341369030941, 1e-14);
  EXPECT_NEAR(grey(Ward{0.3, 0.5, 0, 1, Ward::Normalization::bounded}, kA, kB), 0.7357877505675455, 1e-14);
  EXPECT_NEAR(albedo(Ward{0.3, 0.5, 0, 1, Ward::Normalization::bounded}, at(60, 30)), 0.7562699577939842,
              1e-3);
}

TEST(Ward, ExceedsUnitAlbedoAtGrazingAnglesUnlessBounded) {
  EXPECT_GT(albedo(Ward{0.3, 0.3, 0, 1, Ward::Normalization::duer}, at(88, 0)), 2);
  EXPECT_LT(albedo(Ward{0.3, 0.3, 0, 1, Ward::Normalization::bounded}, at(88, 0)), 1);
}

TEST(Fresnel, MatchesTheDielectricOfIndexThreeHalves) {
  EXPECT_NEAR(fresnel_dielectric(0.04, 1), 0.04, 1e-15);
  // At 60 degrees: r_s = (1/2 - sqrt(3/2)) / (1/2 + sqrt(3/2)), r_p = (9/8 - sqrt(3/2)) / (9/8 + sqrt(3/2)).
  const double t = std::sqrt(1.5), rs = (0.5 - t) / (0.5 + t), rp = (1.125 - t) / (1.125 + t);
  EXPECT_NEAR(fresnel_dielectric(0.04, 0.5), 0.5 * (rs * rs + rp * rp), 1e-14);
  EXPECT_NEAR(fresnel_dielectric(0.04, kMinCosine), 1, 1e-9);
  EXPECT_EQ(fresnel_dielectric(1.0, 0.3), 1);
  EXPECT_NEAR(fresnel_dielectric(0.0, 0.3), 0, 1e-30);
}

TEST(Fresnel, OfSchlickHasItsEndsExact) {
  EXPECT_EQ(fresnel_schlick(0.3, 1), Rgb(0.3));
  EXPECT_EQ(fresnel_schlick(0.3, 0), Rgb(1));
}

template <MicrofacetDistribution T>
void expect_normalized(const T& distribution, double tolerance) {
  EXPECT_NEAR(over_hemisphere([&](Vec3 h) { return distribution.density(h) * h.z; }), 1, tolerance);
}

TEST(MicrofacetDistributions, IntegrateToOneOverProjectedSolidAngle) {
  expect_normalized(BeckmannDistribution{0.3, 0.5}, 1e-6);
  expect_normalized(BeckmannDistribution{1, 0.2}, 1e-6);
  expect_normalized(GgxDistribution{0.3, 0.5}, 1e-6);
  expect_normalized(GgxDistribution{1, 0.2}, 1e-6);
  expect_normalized(CrossedGaussians{0.2, 0.5, 0.3}, 1e-6);
}

template <MicrofacetDistribution T>
void expect_projected_area(const T& distribution) {
  for (const Vec3 w : {kNormal, kA, kB, at(80, 90), at(89, 10)}) {
    const double area =
        over_hemisphere([&](Vec3 h) { return distribution.density(h) * std::max(0.0, dot(w, h)); });
    EXPECT_NEAR(distribution.projected_area(w), area, 1e-3 * area) << w.z;
  }
}

TEST(MicrofacetDistributions, HaveTheProjectedAreaOfTheirFacets) {
  expect_projected_area(BeckmannDistribution{0.3, 0.5});
  expect_projected_area(GgxDistribution{0.3, 0.5});
}

TEST(Microfacet, HasItsClosedFormAtNormalIncidence) {
  EXPECT_NEAR(grey(Ggx{{0.2, 0.5}, 0.7, 0.1}, kNormal, kNormal), 0.7 / (4 * kPi * 0.1) + 0.1 / kPi, 1e-14);
  EXPECT_NEAR(grey(Beckmann{{0.2, 0.5}, 0.7, 0.1}, kNormal, kNormal), 0.7 / (4 * kPi * 0.1) + 0.1 / kPi,
              1e-14);
}

TEST(Microfacet, MatchesReferenceValues) {
  EXPECT_NEAR(grey(Ggx{{0.3, 0.5}, 0.4, 0}, kA, kB), 0.23592309953559934, 1e-13);
  EXPECT_NEAR(grey(Beckmann{{0.3, 0.5}, 0.4, 0}, kA, kB), 0.3206939067707974, 1e-13);
  EXPECT_NEAR(albedo(Ggx{{0.3, 0.5}, 1, 0}, at(60, 30)), 0.7451083232299258, 1e-3);
  EXPECT_NEAR(albedo(Beckmann{{0.3, 0.5}, 1, 0}, at(60, 30)), 0.8908478610948384, 1e-3);
}

TEST(CookTorrance, MatchesReferenceValues) {
  EXPECT_NEAR(grey(CookTorrance{0.3, 0.6, 0}, kNormal, kNormal), 0.6 / (4 * kPi * 0.09), 1e-14);
  EXPECT_NEAR(grey(CookTorrance{0.4, 0.04, 0}, kA, kB), 0.031994684225960794, 1e-14);
  EXPECT_NEAR(grey(CookTorrance{0.4, 0.04, 0}, at(75, 0), at(80, 160)), 0.14365748724402036, 1e-13);
  EXPECT_NEAR(albedo(CookTorrance{0.4, 0.04, 0}, at(60, 30)), 0.0692355639029696, 1e-4);
}

TEST(AshikhminShirley, MatchesReferenceValues) {
  const double diffuse_part = 28 * 0.3 * 0.8 / (23 * kPi) * std::pow(31.0 / 32, 2);
  EXPECT_NEAR(grey(AshikhminShirley{8, 24, 0.2, 0.3}, kNormal, kNormal), 15 * 0.2 / (8 * kPi) + diffuse_part,
              1e-14);
  EXPECT_NEAR(grey(AshikhminShirley{10, 40, 0.2, 0.3}, kA, kB), 0.15339382046803923, 1e-14);
  EXPECT_NEAR(albedo(AshikhminShirley{10, 40, 1, 0}, at(60, 30)), 0.6638437086170594, 1e-3);
}

TEST(PoulinFournier, HasItsClosedFormAtNormalIncidence) {
  // Half cylinders: the integral of cos² over the arc is pi/2, the floor between them spacing - 2.
  const PoulinFournier diffuse_cylinders{.spacing = 3, .height = 1, .kd = 0.5, .ks = 0};
  EXPECT_NEAR(grey(diffuse_cylinders, kNormal, kNormal), 0.5 / kPi * (kHalfPi + 1) / 3, 1e-14);
}

TEST(PoulinFournier, MatchesRaysTracedThroughTheCylinders) {
  const auto diffuse_only = [](double spacing, double height, Vec3 wi, Vec3 wo) {
    return grey(PoulinFournier{spacing, height, 50, 1, 0}, wi, wo);
  };
  const auto specular_only = [](double spacing, double height, double exponent, Vec3 wi, Vec3 wo) {
    return grey(PoulinFournier{spacing, height, exponent, 0, 1}, wi, wo);
  };
  EXPECT_NEAR(diffuse_only(2.5, 1, kA, kB), 0.2634911277552571, 1e-8);
  EXPECT_NEAR(specular_only(2.5, 1, 50, kA, kB), 0.31920134233708136, 1e-5);
  EXPECT_NEAR(diffuse_only(3, 0.4, kA, kB), 0.3002153874509721, 1e-8);
  EXPECT_NEAR(specular_only(3, 0.4, 200, kA, kB), 0.18286524405626386, 1e-5);
  EXPECT_NEAR(diffuse_only(2.2, 0.9, at(70, 60), at(65, 250)), 0.08223099673920896, 1e-8);
  EXPECT_NEAR(specular_only(2.2, 0.9, 20, at(70, 60), at(65, 250)), 0.12666610241220655, 1e-5);
}

TEST(PoulinFournier, ShowsEveryDirectionExactlyOneGroundArea) {
  Pcg32 random(7);
  for (int i = 0; i < 500; ++i) {
    const PoulinFournier brdf{.spacing = 2 + 3 * random.uniform(), .height = 0.01 + 0.99 * random.uniform()};
    const Vec3 w = spherical_direction(kHalfPi * random.uniform(), kTwoPi * random.uniform());
    const auto arc = brdf.visible_arc(w);
    const auto floor = brdf.visible_floor(w);
    const double cylinders =
        integrate<12>(arc.lo, arc.hi, [&](double psi) { return w.y * std::sin(psi) + w.z * std::cos(psi); });
    EXPECT_NEAR(cylinders + std::max(0.0, floor.hi - floor.lo) * w.z, brdf.spacing * w.z, 1e-12);
  }
}

TEST(PoulinFournier, IntegratesItsHighlightAccurately) {
  Pcg32 random(8);
  for (const double exponent : {1.0, 30.0, 1000.0, 10000.0})
    for (int i = 0; i < 20; ++i) {
      const PoulinFournier brdf{.spacing = 100, .height = 1, .exponent = exponent, .kd = 0, .ks = 1};
      // Far apart, lit from within 40 degrees of the normal: the arc is limited by facing alone.
      const Vec3 wi = spherical_direction(0.7 * random.uniform(), kTwoPi * random.uniform());
      const Vec3 wo = spherical_direction(0.7 * random.uniform(), kTwoPi * random.uniform());
      const Vec3 h = half_vector(wi, wo);
      const auto arc_i = brdf.visible_arc(wi), arc_o = brdf.visible_arc(wo);
      const double lo = std::max(arc_i.lo, arc_o.lo), hi = std::min(arc_i.hi, arc_o.hi);
      double sum = 0;
      constexpr int kSteps = 4000;
      for (int k = 0; k < kSteps; ++k) {
        const double psi = lo + (hi - lo) * (k + 0.5) / kSteps, y = std::sin(psi), z = std::cos(psi);
        sum += std::pow(std::max(0.0, h.y * y + h.z * z), exponent) * (wi.y * y + wi.z * z) *
               (wo.y * y + wo.z * z);
      }
      const double cylinder = sum * (hi - lo) / kSteps / (100 * wi.z * wo.z);
      const auto floor_i = brdf.visible_floor(wi), floor_o = brdf.visible_floor(wo);
      const double floor = (std::min(floor_i.hi, floor_o.hi) - std::max(floor_i.lo, floor_o.lo)) / 100;
      const double expected =
          blinn_phong_normalization(exponent) * (cylinder + floor * std::pow(h.z, exponent));
      EXPECT_NEAR(grey(brdf, wi, wo), expected, 1e-4 * expected) << exponent;
    }
}

TEST(ProjectedAreaTable, MatchesTheClosedFormOfGaussianSlopes) {
  Pcg32 random(9);
  const struct {
    BeckmannDistribution distribution;
    double bound;
  } kCases[] = {
      {{1, 1}, 2e-4}, {{0.3, 0.5}, 2e-4}, {{0.1, 0.1}, 3e-3}, {{0.05, 0.05}, 3e-3}, {{0.05, 0.5}, 3e-3}};
  for (const auto& [distribution, bound] : kCases) {
    // Three times the density must give the same table.
    const ProjectedAreaTable table([&d = distribution](Vec3 h) { return 3 * d.density(h); },
                                   distribution.isotropic());
    EXPECT_NEAR(table.density_scale(), 1.0 / 3, 1e-3);
    double worst = 0;
    for (int i = 0; i < 3000; ++i) {
      const double r = random.uniform();
      const Vec3 w = spherical_direction(kHalfPi * (1 - r * r), kTwoPi * random.uniform());
      worst = std::max(worst, std::abs(table(w) / distribution.projected_area(w) - 1));
    }
    EXPECT_LT(worst, bound) << distribution.alpha_x << ", " << distribution.alpha_y;
  }
}

TEST(ProjectedAreaTable, RefusesWhatIsNoDensity) {
  EXPECT_THROW(ProjectedAreaTable([](Vec3) { return 0.0; }, true), Error);
  EXPECT_THROW(ProjectedAreaTable([](Vec3 h) { return h.x; }, false), Error);
  EXPECT_THROW(ProjectedAreaTable([](Vec3) { return std::numeric_limits<double>::infinity(); }, true), Error);
}

TEST(AshikhminPremozeShirley, IsDensityOverFourProjectedAreas) {
  const CrossedGaussians threads{0.2, 0.5, 0.3};
  const Satin satin(threads, 1, 0, 0);
  const auto area = [&](Vec3 w) {
    return 0.7 * BeckmannDistribution{0.2, 0.5}.projected_area(w) +
           0.3 * BeckmannDistribution{0.5, 0.2}.projected_area(w);
  };
  const double expected = threads.density(half_vector(kA, kB)) / (4 * area(kA) * area(kB));
  EXPECT_NEAR(grey(satin, kA, kB), expected, 2e-3 * expected);
  // All facets are alike where two Gaussians of one width cross.
  EXPECT_NEAR(grey(Satin({0.3, 0.3, 0.5}, 0.4, 0.1, 0), kNormal, kNormal), 0.4 / (4 * kPi * 0.09) + 0.1 / kPi,
              1e-3);
}

TEST(AshikhminPremozeShirley, TakesAnyDistribution) {
  // Facets of a sphere: every normal as often, sigma(w) = (1 + w.z) / 2 and density 1 / pi.
  struct Sphere {
    double density(Vec3) const noexcept { return 5; }
    bool isotropic() const noexcept { return true; }
  };
  const AshikhminPremozeShirley<Sphere> brdf({}, 1, 0, 0);
  EXPECT_NEAR(grey(brdf, kA, kB), 1 / (kPi * (1 + kA.z) * (1 + kB.z)), 1e-4);
}

TEST(AshikhminPremozeShirley, MasksLessWhereDirectionsShareAnAzimuth) {
  const CrossedGaussians threads{0.5, 0.5, 0};
  const Satin apart(threads, 1, 0, 0), together(threads, 1, 0, 0.35);
  EXPECT_GT(grey(together, at(80, 10), at(75, 10)), 1.1 * grey(apart, at(80, 10), at(75, 10)));
  EXPECT_NEAR(grey(together, at(80, 10), at(75, 190)), grey(apart, at(80, 10), at(75, 190)), 1e-12);
}

}  // namespace
}  // namespace burnish
