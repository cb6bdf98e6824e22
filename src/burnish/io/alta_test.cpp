// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/alta.h>
#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using testing::HasSubstr;

SampleFile read_row(std::string_view name, const std::vector<double>& coordinates,
                    std::string_view keys = "") {
  std::string text = fmt::format("#DIM {} 1\n#PARAM_IN {}\n{}", coordinates.size(), name, keys);
  for (const double x : coordinates) text += fmt::format("{} ", x);
  return parse_alta(memory_file(text + "0.25\n"), {});
}

// The formulas of ALTA's from_cartesian, which computes the coordinates in its files.
struct Alta {
  Vec3 view, light;
  double theta(Vec3 w) const { return std::acos(w.z); }
  double turn() const { return std::atan2(light.y, light.x) - std::atan2(view.y, view.x); }
  HalfDiff rusinkiewicz() const { return to_half_diff(view, light); }
};

TEST(Alta, FindsTheDirectionsOfEveryParameterization) {
  const Alta pair{spherical_direction(0.9, 0.4), spherical_direction(0.5, 1.3)};
  const auto [view, light] = std::pair{pair.view, pair.light};
  const HalfDiff half = pair.rusinkiewicz();
  const Vec3 back = normalize({view.x - light.x, view.y - light.y, view.z + light.z});
  const double around = std::atan2(light.y, light.x) - std::atan2(back.y, back.x);
  const double theta_k = std::acos(back.z), apart = angle_between(view, light);
  const double toward_normal =
      (view.z - light.z * std::cos(apart)) / (std::hypot(light.x, light.y) * std::sin(apart));
  const double aside = std::sin(pair.turn()) * std::hypot(view.x, view.y) / std::sin(apart);
  const Vec3 h = 0.5 * (light + view), b = 0.5 * (light - view);
  const double b_turn = std::atan2(b.y, b.x) - std::atan2(h.y, h.x);
  struct Case {
    const char* name;
    std::vector<double> coordinates;
  };
  const std::vector<Case> cases{
      {"RUSIN_TH_TD_PD", {half.theta_h, half.theta_d, half.phi_d}},
      {"RUSIN_TH_PH_TD_PD", {half.theta_h, half.phi_h, half.theta_d, half.phi_d}},
      {"SPHERICAL_TL_PL_TV_PV", {0.5, 1.3, 0.9, 0.4}},
      {"ISOTROPIC_TV_TL_DPHI", {0.9, 0.5, pair.turn()}},
      {"ISOTROPIC_TL_TV_PROJ_DPHI", {0.5, 0.9 * std::cos(pair.turn()), 0.9 * std::sin(pair.turn())}},
      {"SCHLICK_TL_TK_PROJ_DPHI", {0.5, theta_k * std::cos(around), theta_k * std::sin(around)}},
      {"RETRO_TL_TVL_PROJ_DPHI", {0.5, apart * toward_normal, apart * aside}},
      {"STARK_3D", {std::hypot(h.x, h.y), length(b), b_turn}},
      {"NEUMANN_3D", {std::hypot(h.x, h.y), std::hypot(b.x, b.y), b_turn}},
      {"STEREOGRAPHIC",
       {view.x / (1 + view.z), view.y / (1 + view.z), light.x / (1 + light.z), light.y / (1 + light.z)}},
      {"CARTESIAN", {view.x, view.y, view.z, light.x, light.y, light.z}}};
  for (const auto& [name, coordinates] : cases) {
    const Samples samples = read_row(name, coordinates).samples;
    const auto [wi, wo] = samples.pairs.front();
    const std::string_view called = name;
    if (called == "NEUMANN_3D" || called == "STARK_3D") {
      // For these kinds, to_cartesian exchanges light and view of from_cartesian.
      EXPECT_NEAR(wi.z, view.z, 1e-12) << name;
      EXPECT_NEAR(wo.z, light.z, 1e-12) << name;
      EXPECT_NEAR(dot(wi, wo), dot(light, view), 1e-12) << name;
    } else {
      EXPECT_NEAR(wi.z, light.z, 1e-12) << name;
      EXPECT_NEAR(wo.z, view.z, 1e-12) << name;
      EXPECT_NEAR(dot(wi, wo), dot(light, view), 1e-12) << name;
    }
    EXPECT_EQ(samples.isotropic, coordinates.size() == 3) << name;
    if (samples.isotropic) continue;
    EXPECT_NEAR(length(wi - light), 0, 1e-12) << name;
    EXPECT_NEAR(length(wo - view), 0, 1e-12) << name;
  }
  // This kind has phi_d = 0.
  const DirectionPair flat = read_row("RUSIN_TH_PH_TD", {0.3, 0.2, 0.4}).samples.pairs[0];
  const HalfDiff angles = to_half_diff(flat.wo, flat.wi);
  EXPECT_NEAR(angles.theta_h, 0.3, 1e-12);
  EXPECT_NEAR(angles.phi_h, 0.2, 1e-12);
  EXPECT_NEAR(angles.theta_d, 0.4, 1e-12);
  EXPECT_NEAR(std::sin(angles.phi_d), 0, 1e-12);
}

TEST(Alta, TakesKeysForWhatTheySay) {
  EXPECT_TRUE(looks_like_alta(seeds::kAlta));
  const SampleFile seed = parse_alta(memory_file(seeds::kAlta), {});
  EXPECT_EQ(seed.findings.description, "seed");
  EXPECT_EQ(seed.samples.values, (std::vector<double>{0.25, -0.1, 0.5}));  // intervals are passed over
  const SampleFile weighted =
      read_row("SPHERICAL_TL_PL_TV_PV", {0.5, 0, 1.1, 2}, "#PARAM_OUT INV_STERADIAN_COSINE_FACTOR\n");
  EXPECT_NEAR(weighted.samples.values[0], 0.25 / std::cos(1.1), 1e-15);
  // pi/2 of six digits is below the horizon.
  EXPECT_EQ(read_row("SPHERICAL_TL_PL_TV_PV", {1.5708, 0, 1.1, 2}).samples.pairs.at(0).wi.z, 0);
}

TEST(Alta, SaysWhatIsWrong) {
  const auto error = [](std::string_view text) {
    return error_of([&] { parse_alta(memory_file(text), {}); });
  };
  EXPECT_THAT(error("#DIM 3 1\n0 0 0 1\n"), HasSubstr("#PARAM_IN in front of the data"));
  EXPECT_THAT(error("#DIM 1 1\n#PARAM_IN COS_TH\n0 1\n"), HasSubstr("three or four angles"));
  EXPECT_THAT(error("#DIM 2 1\n#PARAM_IN STARK_3D\n0 1 1\n"), HasSubstr("#DIM 3 for STARK_3D"));
  EXPECT_THAT(error("#DIM 3 2\n#PARAM_IN STARK_3D\n0 1 1 1\n"), HasSubstr("one value or three"));
  EXPECT_THAT(error("#DIM 3 1\n#PARAM_IN STARK_3D\n"), HasSubstr("a row of numbers"));
  EXPECT_THAT(error("#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n2 0 0 1\n"), HasSubstr("upper hemisphere"));
  EXPECT_THAT(error("#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n1 0 0 x\n"), HasSubstr("line 3"));
}

TEST(Alta, ReadsTheTapeAsAFewLinesDo) {
  BURNISH_NEEDS_DATA();
  const FileBytes bytes = read_file(data_folder() / "retro" / "retro-gray-tape.dat");
  const SampleFile file = parse_alta(bytes, {});
  ASSERT_EQ(file.samples.size(), 7405u);
  std::istringstream lines{std::string(bytes.text())};
  std::size_t i = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    double theta_l, x, y, value;
    std::istringstream(line) >> theta_l >> x >> y >> value;
    const auto [wi, wo] = file.samples.pairs[i];
    EXPECT_NEAR(wi.z, std::cos(theta_l), 1e-12);
    EXPECT_NEAR(wo.z, std::cos(std::hypot(x, y)), 1e-12);
    EXPECT_NEAR(std::remainder(phi_of(wo) - phi_of(wi) - std::atan2(y, x), kTwoPi), 0, 1e-9);
    EXPECT_EQ(file.samples.at(i++)[0], value);
  }
  EXPECT_EQ(i, 7405u);
  EXPECT_EQ(file.findings.description, "Gray Tape");
}

}  // namespace
}  // namespace burnish
