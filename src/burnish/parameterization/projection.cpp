#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/parameterization/hemisphere_map.h>
#include <burnish/parameterization/projection.h>

namespace burnish {

namespace {

// a u + b v; where a == b as a (u + v), so that swapping u and v changes no bit
Vec3 combine(double a, Vec3 u, double b, Vec3 v) noexcept {
  return a == b ? a * (u + v) : a * u + b * v;
}

Vec3 above_horizon(Vec3 w) noexcept {
  if (w.z >= 0) return w;
  return normalize({w.x, w.y, 0});
}

// wi in the frame whose z axis is h and whose x axis lies in the plane of h and n [Rusinkiewicz 1998]
Vec3 difference_vector(Vec3 wi, Vec3 wo) noexcept {
  const Vec3 h = half_vector(wi, wo);
  const double sin_theta = std::sqrt(h.x * h.x + h.y * h.y);
  const double cos_phi = sin_theta > 0 ? h.x / sin_theta : 1, sin_phi = sin_theta > 0 ? h.y / sin_theta : 0;
  const Vec3 x_axis{h.z * cos_phi, h.z * sin_phi, -sin_theta}, y_axis{-sin_phi, cos_phi, 0};
  return {dot(wi, x_axis), dot(wi, y_axis), 0.5 * length(wi + wo)};
}

// tan(theta_t / 2)
double twist(Vec3 wi, Vec3 wo) noexcept {
  const Vec3 s = wi + wo, a = wi - wo;
  const double across = s.x * s.x + s.y * s.y, square = across + s.z * s.z;
  const double turn = a.z * (s.y * a.x - s.x * a.y) * square;
  const double half = std::max(across + kTwistCore * square, std::numeric_limits<double>::min());
  return std::clamp(0.5 + 0.5 * kTwistScale * turn / half, 0.0, 1.0);
}

}  // namespace

Vec3 project(const Projection& p, Vec3 wi, Vec3 wo) noexcept {
  if (p.kind == Projection::Kind::difference) return normalize(difference_vector(wi, wo));
  if (p.kind == Projection::Kind::deviation) {
    const Vec3 mirrored = mirror(wi);
    return {0.5 * length(mirrored - wo), 0, 0.5 * length(mirrored + wo)};
  }
  if (p.kind == Projection::Kind::twist) {
    const double t = twist(wi, wo);
    return normalize({2 * t, 0, 1 - t * t});
  }
  Vec3 v = combine(p.wi, wi, p.wo, wo);
  if (p.mirror != 0) v = v + p.mirror * mirror(wi);
  v.z += p.n;
  return above_horizon(normalize(v));
}

double project_tan_half(const Projection& p, Vec3 wi, Vec3 wo) noexcept {
  if (p.kind == Projection::Kind::affine) return tan_half_theta(project(p, wi, wo));
  if (p.kind == Projection::Kind::twist) return twist(wi, wo);
  // cos theta_d = |wi + wo| / 2, sin theta_d = |wi - wo| / 2; theta_m likewise, where mirroring only changes
  // the signs of wi's x and y, so that exchanging the directions changes no bit
  if (p.kind == Projection::Kind::deviation) wi = mirror(wi);
  return length(wi - wo) / (2 + length(wi + wo));
}

bool swapped(const Projection& p, bool azimuth, Projection& result) noexcept {
  result = p;
  if (p.kind != Projection::Kind::affine) return !azimuth;
  if (p.mirror != 0) return false;
  std::swap(result.wi, result.wo);
  return true;
}

Projection parse_projection(std::string_view text, bool& angle_only) {
  angle_only = text.starts_with("theta_");
  if (text == "wi" || text == "theta_i") return kProjectWi;
  if (text == "wo" || text == "theta_o") return kProjectWo;
  if (text == "h" || text == "theta_h") return kProjectHalf;
  if (text == "d" || text == "theta_d") return kProjectDifference;
  if (text == "theta_m") return kProjectDeviation;
  if (text == "theta_t") return kProjectTwist;

  const auto fail = [&]() -> Error {
    return Error(fmt::format(
        "projection: expected wi, wo, h, d, theta_i, theta_o, theta_h, theta_d, theta_m, theta_t or a sum of "
        "terms of wi, wo, m and n such as wi+wo+0.5n, found '{}'",
        text));
  };
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
  if (p.wi == 0 && p.wo == 0 && p.mirror == 0) throw fail();
  return p;
}

std::string to_string(const Projection& p) {
  if (p == kProjectWi) return "wi";
  if (p == kProjectWo) return "wo";
  if (p == kProjectHalf) return "h";
  if (p == kProjectDifference) return "d";
  if (p == kProjectDeviation) return "theta_m";
  if (p == kProjectTwist) return "theta_t";
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
