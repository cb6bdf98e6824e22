// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/parameterization/hemisphere_map.h>
#include <burnish/parameterization/projection.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {
namespace {

std::vector<DirectionPair> pairs_and_corners() {
  std::vector<DirectionPair> pairs = draw_pairs(2000, 3, false);
  const Vec3 n{0, 0, 1}, grazing = normalize({1, 0, 1e-9}), side = normalize({-0.3, 0.4, 0.2});
  for (const DirectionPair& p :
       {DirectionPair{n, n}, {n, grazing}, {grazing, n}, {side, side}, {grazing, mirror(grazing)}})
    pairs.push_back(p);
  return pairs;
}

TEST(Projection, GivesUnitVectorsAboveTheHorizon) {
  for (const char* text : {"wi", "wo", "h", "d", "wi+wo-0.7n", "m+wo", "0.5wi-wo+0.2n", "wi-wo", "theta_m",
                           "theta_t", "phi_d", "phi_s"}) {
    const Projection p = parse_projection(text).projection;
    for (const auto& [wi, wo] : pairs_and_corners()) {
      const Vec3 v = project(p, wi, wo);
      EXPECT_NEAR(length(v), 1, 1e-12) << text;
      EXPECT_GE(v.z, 0) << text;
    }
  }
}

TEST(Projection, HalfAndDifferenceHaveTheHalfDifferenceAngles) {
  for (const auto& [wi, wo] : draw_pairs(2000, 5, false)) {
    const HalfDiff angles = to_half_diff(wi, wo);
    const Vec3 d = project(kProjectDifference, wi, wo);
    EXPECT_NEAR(theta_of(project(kProjectHalf, wi, wo)), angles.theta_h, 1e-12);
    EXPECT_NEAR(theta_of(d), angles.theta_d, 1e-12);
    EXPECT_LT(length(d - spherical_direction(angles.theta_d, angles.phi_d)), 1e-9);
  }
}

TEST(Projection, AngleAloneAgreesWithTheVector) {
  for (const char* text : {"wi", "h", "d", "wi+wo+0.4n", "m+2wo", "theta_m", "theta_t", "phi_d", "phi_s"}) {
    const Projection p = parse_projection(text).projection;
    for (const auto& [wi, wo] : pairs_and_corners())
      EXPECT_NEAR(project_tan_half(p, wi, wo), tan_half_theta(project(p, wi, wo)), 1e-12) << text;
  }
}

TEST(Projection, SwappingIsExactToTheLastBit) {
  for (const char* text :
       {"wi", "wo", "h", "wi+wo+0.4n", "0.3wi+0.9wo-0.2n", "d", "theta_m", "theta_t", "phi_d", "phi_s"}) {
    const Projection p = parse_projection(text).projection;
    const std::optional<Projection> q = swapped(p, false);
    ASSERT_TRUE(q) << text;
    for (const auto& [wi, wo] : pairs_and_corners())
      EXPECT_EQ(project_tan_half(p, wi, wo), project_tan_half(*q, wo, wi)) << text;
  }
  EXPECT_FALSE(swapped(kProjectDifference, true));
  EXPECT_FALSE(swapped(parse_projection("m+wo").projection, false));
}

TEST(Projection, ReadsWhatItPrints) {
  for (const char* text : {"wi", "wo", "h", "d", "wi+wo+0.5n", "-0.25wi+1e-05wo-n", "m+0.8wo"}) {
    const Projection p = parse_projection(text).projection;
    EXPECT_EQ(parse_projection(to_string(p)).projection, p) << text;
    EXPECT_FALSE(parse_projection(text).angle_only);
  }
  EXPECT_EQ(parse_projection("theta_d").projection, kProjectDifference);
  EXPECT_TRUE(parse_projection("theta_d").angle_only);
  for (const Projection& p : {kProjectDeviation, kProjectTwist, kProjectAzimuth, kProjectSide}) {
    EXPECT_EQ(parse_projection(to_string(p)).projection, p);
    EXPECT_TRUE(parse_projection(to_string(p)).angle_only);
  }
}

TEST(Projection, DeviationIsHalfTheAngleToTheMirrorDirection) {
  for (const auto& [wi, wo] : draw_pairs(2000, 7, false))
    EXPECT_NEAR(std::cos(2 * theta_of(project(kProjectDeviation, wi, wo))), dot(mirror(wi), wo), 1e-12);
}

TEST(Projection, TwistTellsMirrorImagesApart) {
  for (const auto& [wi, wo] : draw_pairs(2000, 9, false)) {
    const HalfDiff angles = to_half_diff(wi, wo);
    const double sine_h = std::sin(angles.theta_h), sine_d = std::sin(angles.theta_d);
    const double x = sine_d * sine_d * std::cos(angles.theta_d) * std::sin(2 * angles.phi_d) * sine_h *
                     sine_h / (sine_h * sine_h + kTwistCore);
    const double t = project_tan_half(kProjectTwist, wi, wo);
    EXPECT_NEAR(t, 0.5 + 0.75 * std::sqrt(3) * x, 1e-9);
    const Vec3 mirrored_wi{wi.x, -wi.y, wi.z}, mirrored_wo{wo.x, -wo.y, wo.z};
    EXPECT_NEAR(project_tan_half(kProjectTwist, mirrored_wi, mirrored_wo), 1 - t, 1e-12);
  }
}

TEST(Projection, TwistReachesBothItsEnds) {
  double least = 1, most = 0;
  for (const auto& [wi, wo] : draw_pairs(20'000, 9, true)) {
    const double t = project_tan_half(kProjectTwist, wi, wo);
    least = std::min(least, t);
    most = std::max(most, t);
  }
  EXPECT_LT(least, 0.01);
  EXPECT_GT(most, 0.99);
}

TEST(Projection, AzimuthIsPhiDFolded) {
  for (const auto& [wi, wo] : draw_pairs(2000, 13, false)) {
    const HalfDiff angles = to_half_diff(wi, wo);
    const double t = project_tan_half(kProjectAzimuth, wi, wo);
    EXPECT_NEAR(std::cos(2 * std::atan(t)), std::abs(std::cos(angles.phi_d)), 1e-9);
    EXPECT_NEAR((1 - t * t) / (1 + t * t),
                std::abs(wi.z - wo.z) / (2 * std::sin(angles.theta_h) * std::sin(angles.theta_d)), 1e-9);
  }
}

TEST(Projection, AzimuthIsTheSameInTheMirrorToTheLastBit) {
  for (const auto& [wi, wo] : pairs_and_corners()) {
    const double t = project_tan_half(kProjectAzimuth, wi, wo);
    EXPECT_EQ(project_tan_half(kProjectAzimuth, {wi.x, -wi.y, wi.z}, {wo.x, -wo.y, wo.z}), t);
    EXPECT_EQ(project_tan_half(kProjectAzimuth, {-wi.x, wi.y, wi.z}, {-wo.x, wo.y, wo.z}), t);
    EXPECT_GE(t, 0);
    EXPECT_LE(t, 1);
  }
}

TEST(Projection, AzimuthReachesBothItsEndsAndIsZeroWhereItHasNoMeaning) {
  const Vec3 n{0, 0, 1};
  for (const auto& [w, other] : draw_pairs(200, 15, false)) {
    EXPECT_EQ(project_tan_half(kProjectAzimuth, w, w), 0) << "theta_d = 0";
    EXPECT_EQ(project_tan_half(kProjectAzimuth, w, mirror(w)), 0) << "theta_h = 0";
    EXPECT_LT(project_tan_half(kProjectAzimuth, w, n), 1e-9) << "the plane of both holds the normal";
    EXPECT_EQ(project_tan_half(kProjectAzimuth, w, {w.y, -w.x, w.z}), 1) << "equally steep";
  }
  EXPECT_EQ(project_tan_half(kProjectAzimuth, n, n), 0);
  EXPECT_EQ(project_tan_half(kProjectAzimuth, {1, 0, 0}, {-1, 0, 0}), 0) << "opposite";
  // products of what is tiny vanish, their ratio does not
  const double tiny = 1e-160;
  EXPECT_LE(project_tan_half(kProjectAzimuth, {tiny, 0, 1}, {0, tiny, 1}), 1);
}

TEST(Projection, SideIsPhiDModuloPi) {
  double least = 1, most = 0;
  for (const auto& [wi, wo] : draw_pairs(20'000, 13, false)) {
    const HalfDiff angles = to_half_diff(wi, wo);
    const double folded = project_tan_half(kProjectAzimuth, wi, wo),
                 t = project_tan_half(kProjectSide, wi, wo);
    EXPECT_NEAR(t, (1 + (std::sin(2 * angles.phi_d) < 0 ? -folded : folded)) / 2, 1e-12);
    EXPECT_NEAR(project_tan_half(kProjectSide, {wi.x, -wi.y, wi.z}, {wo.x, -wo.y, wo.z}), 1 - t, 1e-12);
    least = std::min(least, t);
    most = std::max(most, t);
  }
  EXPECT_LT(least, 1e-3);
  EXPECT_GT(most, 1 - 1e-3);
}

TEST(Projection, SideIsInTheMiddleWhereItHasNoMeaningAndAtItsEndWhereTheCircleIsCut) {
  const Vec3 n{0, 0, 1};
  for (const auto& [w, other] : draw_pairs(200, 15, false)) {
    EXPECT_EQ(project_tan_half(kProjectSide, w, w), 0.5) << "theta_d = 0";
    EXPECT_EQ(project_tan_half(kProjectSide, w, mirror(w)), 0.5) << "theta_h = 0";
    EXPECT_NEAR(project_tan_half(kProjectSide, w, n), 0.5, 1e-9) << "the plane of both holds the normal";
    EXPECT_EQ(project_tan_half(kProjectSide, w, {w.y, -w.x, w.z}), 1) << "equally steep";
    EXPECT_EQ(project_tan_half(kProjectSide, w, {-w.y, w.x, w.z}), 1) << "and its mirror image";
  }
}

TEST(Projection, RefusesWhatItDoesNotKnow) {
  for (const char* text :
       {"", "x", "wi wo", "wi+", "n", "0wi", "wi+1e9n", "nan*wi", "theta_x", "phi_h", "wi+wow"})
    EXPECT_THROW(parse_projection(text), Error) << text;
}

}  // namespace
}  // namespace burnish
