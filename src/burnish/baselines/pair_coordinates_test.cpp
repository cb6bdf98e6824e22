// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/baselines/pair_coordinates.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>

namespace burnish {
namespace {

using enum PairCoordinate;

constexpr std::array kAll = {theta_h, theta_d, phi_d,        half_turn_d, half_x,
                             half_y,  turn_d,  difference_x, difference_y};

std::vector<HalfDiffDirections> some_pairs() {
  std::vector<HalfDiffDirections> pairs{{{0, 0, 1}, {0, 0, 1}},
                                        {{0.6, 0, 0.8}, {0.6, 0, 0.8}},
                                        {{0.6, 0, 0.8}, {-0.6, 0, 0.8}},
                                        {{0, 1, 1e-9}, {0, -1, 1e-9}},
                                        {normalize({1, 0, 1e-6}), normalize({1, 1e-3, 1e-6})}};
  Pcg32 random(1);
  for (int i = 0; i < 500; ++i) {
    const auto draw = [&] {
      return spherical_direction(kHalfPi * random.uniform(), kTwoPi * random.uniform());
    };
    const Vec3 wi = draw();
    pairs.push_back({wi, draw()});
  }
  return pairs;
}

TEST(PairCoordinates, LieInTheUnitIntervalAndIgnoreExchangeToTheLastBit) {
  for (const auto& [wi, wo] : some_pairs()) {
    const PairPlace place(wi, wo), exchanged(wo, wi);
    for (const PairCoordinate c : kAll) {
      EXPECT_GE(place[c], 0) << to_string(c);
      EXPECT_LE(place[c], 1) << to_string(c);
      EXPECT_EQ(place[c], exchanged[c]) << to_string(c);
    }
  }
}

TEST(PairCoordinates, AreHalfDifferenceAngles) {
  for (const auto& [wi, wo] : some_pairs()) {
    const HalfDiff angles = to_half_diff(wi, wo);
    const PairPlace place(wi, wo);
    EXPECT_NEAR(place[theta_h] * place[theta_h] * kHalfPi, angles.theta_h, 1e-9);
    EXPECT_NEAR(place[theta_d] * kHalfPi, angles.theta_d, 1e-7);
    if (angles.theta_d > 1e-3 && angles.theta_d < 1.5) {
      EXPECT_NEAR(std::cos(2 * place[phi_d] * kHalfPi), std::cos(2 * angles.phi_d), 1e-6);
    }
  }
}

TEST(PairCoordinates, IsotropicOnesIgnoreRotationAndFoldedOnesMirroring) {
  for (const auto& [wi, wo] : some_pairs()) {
    const auto turn = [](Vec3 w) { return Vec3{0.6 * w.x - 0.8 * w.y, 0.8 * w.x + 0.6 * w.y, w.z}; };
    const auto flip = [](Vec3 w) { return Vec3{w.x, -w.y, w.z}; };
    const PairPlace place(wi, wo), turned(turn(wi), turn(wo)), flipped(flip(wi), flip(wo));
    if (place[theta_h] < 1e-3 || place[theta_d] < 1e-3 || place[theta_h] > 0.999) continue;
    for (const PairCoordinate c : kAll)
      if (is_isotropic(c)) {
        EXPECT_NEAR(place[c], turned[c], 1e-9) << to_string(c);
        // folded coordinates do not see the mirror, a whole half turn runs the other way
        const double sum = place[c] + flipped[c];
        if (c == half_turn_d)
          EXPECT_NEAR(sum, std::round(sum), 1e-9);
        else
          EXPECT_NEAR(place[c], flipped[c], 1e-9) << to_string(c);
      }
  }
}

TEST(PairCoordinates, RoundTrip) {
  const std::vector<std::vector<PairCoordinate>> frames{{theta_h, theta_d, phi_d},
                                                        {theta_h, theta_d, half_turn_d},
                                                        {half_x, half_y, theta_d, turn_d},
                                                        {half_x, half_y, difference_x, difference_y}};
  Pcg32 random(2);
  for (const auto& frame : frames)
    for (int i = 0; i < 300; ++i) {
      std::vector<double> values(frame.size());
      // away from the rims, where a point of a square may lie outside its disk, and from undefined azimuths
      for (double& u : values) u = 0.2 + 0.6 * random.uniform();
      const auto [wi, wo] = pair_at(frame, values).directions();
      EXPECT_NEAR(length(wi), 1, 1e-12);
      EXPECT_NEAR(length(wo), 1, 1e-12);
      const PairPlace place(wi, wo);
      for (std::size_t k = 0; k < frame.size(); ++k)
        EXPECT_NEAR(place[frame[k]], values[k], 1e-12) << to_string(frame[k]);
    }
}

TEST(PairCoordinates, HaveNames) {
  for (const PairCoordinate c : kAll) EXPECT_EQ(parse_pair_coordinate(to_string(c)), c);
  EXPECT_FALSE(parse_pair_coordinate("theta"));
  EXPECT_FALSE(parse_pair_coordinate(""));
}

}  // namespace
}  // namespace burnish
