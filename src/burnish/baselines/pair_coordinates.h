// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string_view>

#include <burnish/math/vec3.h>
#include <burnish/parameterization/half_diff.h>

namespace burnish {

/// A coordinate of a direction pair in [0, 1]. Exchanging wi and wo changes none of them, to the last bit.
enum class PairCoordinate {
  theta_h,  ///< sqrt(theta_h / (pi/2)), the spacing of MERL
  theta_d,  ///< theta_d / (pi/2)
  phi_d,    ///< phi_d folded to [0, pi/2], over pi/2: for isotropic materials that equal their mirror image
  half_turn_d,  ///< phi_d modulo pi, over pi; periodic: for those that do not
  half_x,
  half_y,  ///< the half vector on a disk of radius sqrt(theta_h / (pi/2)), from [-1, 1] to [0, 1]
  turn_d,  ///< azimuth of the difference vector modulo pi, over pi; periodic. Counted from the tangent made
           ///< perpendicular to h, unlike phi_d it is smooth where h is the normal [Kautz 1999]
  difference_x,  ///< the difference vector on a disk of radius theta_d / (pi/2) at azimuth pi turn_d: the
  difference_y,  ///< half disk of x in [-1, 1], here [0, 1], and y in [0, 1]
};

inline constexpr int kPairCoordinates = 9;

/// "theta_h" and so on; nothing for another text.
std::string_view to_string(PairCoordinate coordinate) noexcept;
std::optional<PairCoordinate> parse_pair_coordinate(std::string_view text) noexcept;

/// True where 1 is the same place as 0.
constexpr bool is_periodic(PairCoordinate coordinate) noexcept {
  return coordinate == PairCoordinate::turn_d || coordinate == PairCoordinate::half_turn_d;
}
/// True where rotating both directions about the normal changes nothing.
constexpr bool is_isotropic(PairCoordinate coordinate) noexcept {
  return coordinate <= PairCoordinate::half_turn_d;
}

/// Coordinates of one pair above the horizon, each computed when asked for.
class PairPlace {
 public:
  PairPlace(Vec3 wi, Vec3 wo) noexcept;

  double operator[](PairCoordinate coordinate) const noexcept;

 private:
  double turn() const noexcept;

  Vec3 half_, difference_;  // difference_ = (wi - wo) / 2
  double theta_h_, theta_d_;
};

/// A pair as its half vector and half the angle between its directions, which lie towards and away from a
/// unit vector across the half vector. Unlike two directions this is well defined where they are opposite.
struct PairFrame {
  Vec3 h, across;
  double theta_d = 0;

  HalfDiffDirections directions() const noexcept {
    const Vec3 along = std::cos(theta_d) * h, aside = std::sin(theta_d) * across;
    return {along + aside, along - aside};
  }
};

/// The pair at given coordinates, coordinates[i] = values[i]: theta_h or half_x and half_y, and theta_d with
/// phi_d, half_turn_d or turn_d, or difference_x and difference_y; what is missing is 0. Points outside a
/// disk are moved to its rim. The pair may lie below the horizon. PairPlace inverts it to 1e-6, to 1e-12 away
/// from the ends.
PairFrame pair_at(std::span<const PairCoordinate> coordinates, std::span<const double> values) noexcept;

}  // namespace burnish
