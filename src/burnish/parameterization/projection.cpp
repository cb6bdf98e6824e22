// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/parameterization/projection_scalar.h>

namespace burnish {

namespace {

using definition::Pair;

Vec3 above_horizon(Vec3 w) noexcept {
  if (w.z >= 0) return w;
  return normalize({w.x, w.y, 0});
}

// wi in the frame of h
Vec3 difference_vector(Vec3 wi, Vec3 wo) noexcept {
  const auto [x, y] = definition::across_half(half_vector(wi, wo), 1.0, wi);
  return {x, y, 0.5 * length(wi + wo)};
}

}  // namespace

Vec3 project(const Projection& p, Vec3 wi, Vec3 wo) noexcept {
  if (p.kind == Projection::Kind::affine) return above_horizon(normalize(definition::combination(p, wi, wo)));
  if (p.kind == Projection::Kind::difference) return normalize(difference_vector(wi, wo));
  const double t = project_tan_half(p, wi, wo);
  return normalize({2 * t, 0, 1 - t * t});
}

double project_tan_half(const Projection& p, Vec3 wi, Vec3 wo) noexcept {
  const auto polar =
      p.kind == Projection::Kind::affine
          ? definition::polar_of(project(p, wi, wo), 1.0)
          : definition::with_angle(p.kind, [&](const auto& angle) { return angle(Pair(wi, wo)); });
  return polar.r / polar.den;
}

std::optional<Projection> swapped(const Projection& p, bool azimuth) noexcept {
  // the azimuth of the difference turns by pi; all other angles stay
  if (p.kind != Projection::Kind::affine) return azimuth ? std::nullopt : std::optional(p);
  if (p.mirror != 0) return std::nullopt;
  Projection result = p;
  std::swap(result.wi, result.wo);
  return result;
}

namespace {

// The names of projections. An angle's name stands for a direction whose azimuth does not matter.
struct Name {
  std::string_view text;
  Projection projection;
  bool angle_only = false;
};
constexpr Name kNames[] = {
    {"wi", kProjectWi},
    {"wo", kProjectWo},
    {"h", kProjectHalf},
    {"d", kProjectDifference},
    {"theta_i", kProjectWi, true},
    {"theta_o", kProjectWo, true},
    {"theta_h", kProjectHalf, true},
    {"theta_d", kProjectDifference, true},
    {"theta_m", kProjectDeviation, true},
    {"theta_t", kProjectTwist, true},
    {"phi_d", kProjectAzimuth, true},
    {"phi_s", kProjectSide, true},
};

}  // namespace

NamedProjection parse_projection(std::string_view text) {
  const auto known = std::ranges::find(kNames, text, &Name::text);
  if (known != std::end(kNames)) return {known->projection, known->angle_only};

  const auto fail = [&]() -> Error {
    std::string names;
    for (const Name& name : kNames) names += fmt::format("{}{}", names.empty() ? "" : ", ", name.text);
    return Error(fmt::format(
        "projection: expected {} or a sum of terms of wi, wo, m and n such as wi+wo+0.5n, found '{}'", names,
        text));
  };
  // terms: a sign, which only the first may lack, a number, a vector
  Projection p;
  std::string_view rest = text;
  while (!rest.empty()) {
    double coefficient = 1;
    if (rest.front() == '+' || rest.front() == '-') {
      if (rest.front() == '-') coefficient = -1;
      rest.remove_prefix(1);
    } else if (rest.data() != text.data()) {
      throw fail();
    }
    double number = 1;
    const auto [end, code] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    if (code == std::errc{}) {
      if (!(std::abs(number) <= 1e3)) throw fail();
      rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
      if (rest.starts_with("*")) rest.remove_prefix(1);
      coefficient *= number;
    }
    const auto term = [&](std::string_view name, double& slot) {
      if (!rest.starts_with(name)) return false;
      rest.remove_prefix(name.size());
      slot += coefficient;
      return true;
    };
    if (!(term("wi", p.wi) || term("wo", p.wo) || term("m", p.mirror) || term("n", p.n))) throw fail();
  }
  // the normal alone says nothing of the directions
  if (p.wi == 0 && p.wo == 0 && p.mirror == 0) throw fail();
  return {p};
}

std::string_view to_string(Projection::Kind kind) noexcept {
  using Kind = Projection::Kind;
  switch (kind) {
    case Kind::affine:
      return "affine";
    case Kind::difference:
      return "difference";
    case Kind::deviation:
      return "deviation";
    case Kind::twist:
      return "twist";
    case Kind::azimuth:
      return "azimuth";
    case Kind::side:
      return "side";
  }
  return "";
}

std::string to_string(const Projection& p) {
  const auto known = std::ranges::find(kNames, p, &Name::projection);
  if (known != std::end(kNames)) return std::string(known->text);
  std::string text;
  const auto term = [&](double coefficient, const char* name) {
    if (coefficient != 0)
      text += fmt::format("{}{}{}", text.empty() || coefficient < 0 ? "" : "+", coefficient, name);
  };
  term(p.wi, "wi");
  term(p.wo, "wo");
  term(p.mirror, "m");
  term(p.n, "n");
  return text;
}

}  // namespace burnish
