// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/parameterization/projection_scalar.h>

namespace burnish {

double Warp::forward(double t) const noexcept {
  return definition::forward(*this, t);
}

Warp parse_warp(std::string_view text) {
  const auto colon = text.find(':');
  const std::string_view name = text.substr(0, colon);
  if (name == "identity" && colon == text.npos) return {};
  double parameter = 0;
  const std::string_view number = colon == text.npos ? "" : text.substr(colon + 1);
  const auto [end, code] = std::from_chars(number.data(), number.data() + number.size(), parameter);
  const bool numeric = code == std::errc{} && end == number.data() + number.size();
  if (numeric && name == "power" && parameter > 0 && parameter <= 1) return {WarpKind::power, parameter};
  const double k = parameter > 0 ? parameter : -1 - parameter;  // distance from the excluded [-1, 0]
  if (numeric && name == "rational" && k >= 1e-6 && k <= 1e6) return {WarpKind::rational, parameter};
  throw Error(fmt::format(
      "warp: expected identity, power:P with P in (0, 1] or rational:K with K in [1e-6, 1e6] or below -1, "
      "found '{}'",
      text));
}

std::string to_string(Warp warp) {
  switch (warp.kind) {
    case WarpKind::power:
      return fmt::format("power:{}", warp.parameter);
    case WarpKind::rational:
      return fmt::format("rational:{}", warp.parameter);
    case WarpKind::identity:
      break;
  }
  return "identity";
}

Vec3 from_disk(DiskPoint p, Warp warp) noexcept {
  const double u = std::sqrt(p.x * p.x + p.y * p.y);
  if (u <= 0) return {0, 0, 1};
  const double t = warp.inverse(std::min(u, 1.0));
  // t = tan(theta / 2): sin = 2 t / (1 + t^2), cos = (1 - t^2) / (1 + t^2)
  const double sin_theta = 2 * t / (1 + t * t);
  return {p.x / u * sin_theta, p.y / u * sin_theta, (1 - t * t) / (1 + t * t)};
}

}  // namespace burnish
