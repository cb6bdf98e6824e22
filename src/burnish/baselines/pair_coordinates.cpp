// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include <burnish/baselines/pair_coordinates.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr std::array<std::string_view, kPairCoordinates> kNames = {
    "theta_h", "theta_d", "phi_d",        "half_turn_d", "half_x",
    "half_y",  "turn_d",  "difference_x", "difference_y"};

// The azimuth of (x, y) modulo pi, over pi.
double half_turn(double x, double y) noexcept {
  if (y < 0 || (y == 0 && x < 0)) {
    x = -x;
    y = -y;
  }
  return std::min(std::atan2(y, x) / kPi, std::nextafter(1.0, 0.0));
}

// The tangent made perpendicular to h; the normal where h is the tangent.
Vec3 tangent_at(Vec3 h) noexcept {
  return normalize(Vec3{1, 0, 0} - h.x * h);
}

}  // namespace

std::string_view to_string(PairCoordinate coordinate) noexcept {
  return kNames[static_cast<std::size_t>(coordinate)];
}

std::optional<PairCoordinate> parse_pair_coordinate(std::string_view text) noexcept {
  const auto* const found = std::find(kNames.begin(), kNames.end(), text);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<PairCoordinate>(found - kNames.begin());
}

// Only wi - wo changes when the two are exchanged, its sign, which every coordinate ignores.
PairPlace::PairPlace(Vec3 wi, Vec3 wo) noexcept
    : half_(half_vector(wi, wo)),
      difference_(0.5 * (wi - wo)),
      theta_h_(theta_of(half_)),
      theta_d_(std::atan2(length(wi - wo), length(wi + wo))) {}

double PairPlace::turn() const noexcept {
  const Vec3 t = tangent_at(half_), s = cross(half_, t);
  return half_turn(dot(difference_, t), dot(difference_, s));
}

double PairPlace::operator[](PairCoordinate coordinate) const noexcept {
  const double radius_h = std::sqrt(theta_h_ / kHalfPi), radius_d = theta_d_ / kHalfPi;
  const double sin_theta = std::sqrt(half_.x * half_.x + half_.y * half_.y);
  const Vec3 to_half = sin_theta > 0 ? (1 / sin_theta) * half_ : Vec3{1, 0, 0};  // (cos, sin) of phi_h
  switch (coordinate) {
    case PairCoordinate::theta_h:
      return radius_h;
    case PairCoordinate::theta_d:
      return radius_d;
    case PairCoordinate::phi_d:
    case PairCoordinate::half_turn_d: {
      // the difference vector along two tangents at h: the one away from n, and the one around n
      const double x = dot(difference_, {half_.z * to_half.x, half_.z * to_half.y, -sin_theta});
      const double y = dot(difference_, {-to_half.y, to_half.x, 0});
      return coordinate == PairCoordinate::half_turn_d ? half_turn(x, y)
                                                       : std::atan2(std::abs(y), std::abs(x)) / kHalfPi;
    }
    case PairCoordinate::half_x:
      return 0.5 + 0.5 * radius_h * to_half.x;
    case PairCoordinate::half_y:
      return 0.5 + 0.5 * radius_h * to_half.y;
    case PairCoordinate::turn_d:
      return turn();
    case PairCoordinate::difference_x:
      return 0.5 + 0.5 * radius_d * std::cos(kPi * turn());
    case PairCoordinate::difference_y:
      return radius_d * std::sin(kPi * turn());
  }
  return 0;
}

PairFrame pair_at(std::span<const PairCoordinate> coordinates, std::span<const double> values) noexcept {
  assert(coordinates.size() == values.size());
  // coordinates that are not given are 0; two of them together are a point of a disk
  double radius_h = 0, phi_h = 0, radius_d = 0, turn = 0;
  std::array<double, 2> half{}, difference{};
  bool half_disk = false, difference_disk = false;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const double u = values[i];
    switch (coordinates[i]) {
      case PairCoordinate::theta_h:
        radius_h = u;
        break;
      case PairCoordinate::theta_d:
        radius_d = u;
        break;
      case PairCoordinate::phi_d:
        turn = kHalfPi * u;
        break;
      case PairCoordinate::half_turn_d:
      case PairCoordinate::turn_d:
        turn = kPi * u;
        break;
      case PairCoordinate::half_x:
      case PairCoordinate::half_y:
        half[coordinates[i] == PairCoordinate::half_y] = 2 * u - 1;
        half_disk = true;
        break;
      case PairCoordinate::difference_x:
        difference[0] = 2 * u - 1;
        difference_disk = true;
        break;
      case PairCoordinate::difference_y:
        difference[1] = u;
        difference_disk = true;
        break;
    }
  }

  // disks to radius and azimuth
  if (half_disk) {
    radius_h = std::min(1.0, std::hypot(half[0], half[1]));
    phi_h = std::atan2(half[1], half[0]);
  }
  if (difference_disk) {
    radius_d = std::min(1.0, std::hypot(difference[0], difference[1]));
    turn = std::atan2(difference[1], difference[0]);
  }

  // at phi_h = 0 the tangent made perpendicular to h is what phi_d is counted from
  const Vec3 h = spherical_direction(kHalfPi * radius_h * radius_h, phi_h);
  const Vec3 t = tangent_at(h), s = cross(h, t);
  return {h, std::cos(turn) * t + std::sin(turn) * s, kHalfPi * radius_d};
}

}  // namespace burnish
