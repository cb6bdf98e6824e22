#include <fmt/format.h>

#include <burnish/shaders/positions.h>

namespace burnish {

namespace {

/// Names of values of an unnormalized projection: r / den = tan(theta / 2), (x, y) / r the azimuth.
struct Projected {
  std::string x, y, r, den;
};

std::string squares(Body& body, const std::string& v) {
  return body.scalar("rr", fmt::format("{0}.x * {0}.x + {0}.y * {0}.y", v), ops(3));
}

std::string length_of(Body& body, const std::string& v) {
  return body.scalar("len", fmt::format("sqrt({0} + {1}.z * {1}.z)", squares(body, v), v),
                     {.operations = 2, .roots = 1});
}

std::string radius(Body& body, const std::string& v) {
  return body.scalar("r", fmt::format("sqrt({})", squares(body, v)), {.roots = 1});
}

std::string sum(Body& body) {
  return body.vector("sum", "wi + wo", ops(3));
}

std::string mirrored(Body& body) {
  return body.vector("mirrored", fmt::format("{}(-wi.x, -wi.y, wi.z)", body.dialect().vector), {});
}

// a wi + b wo + mirror mirror(wi) + n N, unnormalized
std::string combination(Body& body, const Projection& p) {
  const Dialect& d = body.dialect();
  int operations = -3;
  std::string text;
  const auto add = [&](double factor, const std::string& v) {
    if (factor == 0) return;
    text += text.empty() ? "" : " + ";
    text += factor == 1 ? v : fmt::format("{} * {}", d.literal(factor), v);
    operations += factor == 1 ? 3 : 6;
  };
  if (p.wi == p.wo) {
    if (p.wi != 0) add(p.wi, sum(body));
  } else {
    add(p.wi, "wi");
    add(p.wo, "wo");
  }
  if (p.mirror != 0) add(p.mirror, mirrored(body));
  if (p.n != 0) add(1, fmt::format("{0}({1}, {1}, {2})", d.vector, d.literal(0), d.literal(p.n)));
  return operations == 0 ? text : body.vector("v", text, ops(operations));
}

Projected project_affine(Body& body, const Projection& p, bool needs_r) {
  const Dialect& d = body.dialect();
  std::string v = combination(body, p);
  Projected result{v + ".x", v + ".y", "", ""};
  if (p == kProjectWi || p == kProjectWo) {
    result.den = body.scalar("den", fmt::format("{} + {}.z", d.literal(1), v), ops(1));
  } else {
    // directions below the horizon go to it
    if (p.wi < 0 || p.wo < 0 || p.mirror < 0 || p.n < 0)
      v = body.vector("up", fmt::format("{0}({1}.x, {1}.y, max({1}.z, {2}))", d.vector, v, d.literal(0)),
                      ops(1));
    // of opposite directions the normal
    result.den = body.scalar(
        "den", fmt::format("max({} + {}.z, {})", length_of(body, v), v, d.literal(1e-30)), ops(2));
  }
  if (needs_r) result.r = radius(body, v);
  return result;
}

std::string length3(Body& body, const std::string& v) {
  return body.scalar("len", fmt::format("sqrt(dot({0}, {0}))", v), {.operations = 5, .roots = 1});
}

// [Rusinkiewicz 1998], from wi - wo: what h is orthogonal to loses no digits
Projected project_difference(Body& body, bool disk, bool needs_r) {
  const Dialect& d = body.dialect();
  const std::string s = sum(body), len = length_of(body, s);
  const std::string apart = body.vector("apart", "wi - wo", ops(3));
  Projected result;
  result.den = body.scalar("den", fmt::format("{} + {}", d.literal(2), len), ops(1));
  if (needs_r) result.r = length3(body, apart);
  if (!disk) return result;
  const std::string r = radius(body, s), none = fmt::format("{} > {}", r, d.literal(0));
  const std::string c = body.scalar("cosine", d.select(none, fmt::format("{}.x / {}", s, r), d.literal(1)),
                                    {.operations = 1, .divisions = 1});
  const std::string q = body.scalar("sine", d.select(none, fmt::format("{}.y / {}", s, r), d.literal(0)),
                                    {.operations = 1, .divisions = 1});
  const std::string along =
      body.scalar("along", fmt::format("{0}.x * {1} + {0}.y * {2}", apart, c, q), ops(3));
  result.x = body.scalar(
      "x",
      fmt::format("({0}.z * {1} - {2} * {3}.z) / max({4}, {5})", s, along, r, apart, len, d.literal(1e-30)),
      {.operations = 4, .divisions = 1});
  result.y = body.scalar("y", fmt::format("{0}.y * {1} - {0}.x * {2}", apart, c, q), ops(3));
  return result;
}

Projected project_deviation(Body& body) {
  const std::string m = mirrored(body);
  const std::string apart = length3(body, body.vector("apart", m + " - wo", ops(3)));
  const std::string along = length3(body, body.vector("sum", m + " + wo", ops(3)));
  return {"", "", apart,
          body.scalar("den", fmt::format("{} + {}", body.dialect().literal(2), along), ops(1))};
}

Projected project_twist(Body& body) {
  const Dialect& d = body.dialect();
  const std::string s = sum(body), apart = body.vector("apart", "wi - wo", ops(3));
  const std::string across = squares(body, s);
  const std::string square = body.scalar("square", fmt::format("{0} + {1}.z * {1}.z", across, s), ops(2));
  const std::string half = body.scalar(
      "half_den",
      fmt::format("max({} + {} * {}, {})", across, d.literal(kTwistCore), square, d.literal(1e-30)), ops(3));
  const std::string turn = body.scalar(
      "turn", fmt::format("{0}.z * ({1}.y * {0}.x - {1}.x * {0}.y) * {2}", apart, s, square), ops(5));
  const std::string den = body.scalar("den", fmt::format("{0} + {0}", half), ops(1));
  return {"", "",
          body.scalar("r",
                      fmt::format("min(max({} + {} * {}, {}), {})", half, d.literal(kTwistScale), turn,
                                  d.literal(0), den),
                      ops(4)),
          den};
}

Projected project(Body& body, const Projection& p, bool disk, const Warp& warp) {
  const bool needs_r = !disk || warp.kind != WarpKind::identity;
  if (p.kind == Projection::Kind::difference) return project_difference(body, disk, needs_r);
  if (p.kind == Projection::Kind::deviation) return project_deviation(body);
  if (p.kind == Projection::Kind::twist) return project_twist(body);
  return project_affine(body, p, needs_r);
}

std::string power_of(Body& body, const std::string& t, double exponent) {
  if (exponent == 0.5) return body.scalar("t", fmt::format("sqrt({})", t), {.roots = 1});
  return body.scalar("t", fmt::format("pow({}, {})", t, body.dialect().literal(exponent)), {.powers = 1});
}

std::string plus(Body& body, const std::string& value, double first) {
  if (first == 0) return value;
  return body.scalar("u", fmt::format("{} + {}", value, body.dialect().literal(first)), ops(1));
}

}  // namespace

std::string line_position(Body& body, const Projection& projection, const Warp& warp, const Axis& axis) {
  const Dialect& d = body.dialect();
  const Projected p = project(body, projection, false, warp);
  std::string u;
  if (warp.kind == WarpKind::rational)
    u = body.scalar("u",
                    fmt::format("{} * {} / ({} + {} * {})", d.literal(axis.size * (1 + warp.parameter)), p.r,
                                p.r, d.literal(warp.parameter), p.den),
                    {.operations = 3, .divisions = 1});
  else {
    std::string t = body.scalar("t", fmt::format("{} / {}", p.r, p.den), {.divisions = 1});
    if (warp.kind == WarpKind::power) t = power_of(body, t, warp.parameter);
    u = body.scalar("u", fmt::format("{} * {}", d.literal(axis.size), t), ops(1));
  }
  return plus(body, u, axis.first);
}

std::array<std::string, 2> disk_position(Body& body, const Projection& projection, const Warp& warp,
                                         const Axis& axis_x, const Axis& axis_y) {
  const Dialect& d = body.dialect();
  const Projected p = project(body, projection, true, warp);
  const double half = 0.5 * axis_x.size;
  std::string stretch;
  if (warp.kind == WarpKind::rational) {
    stretch = body.scalar("stretch",
                          fmt::format("{} / ({} + {} * {})", d.literal(half * (1 + warp.parameter)), p.r,
                                      d.literal(warp.parameter), p.den),
                          {.operations = 2, .divisions = 1});
  } else {
    stretch = body.scalar("stretch", fmt::format("{} / {}", d.literal(half), p.den), {.divisions = 1});
    if (warp.kind == WarpKind::power) {
      // t^parameter / t, finite at the normal, where x = y = 0
      const std::string t = body.scalar("t", fmt::format("max({} / {}, {})", p.r, p.den, d.literal(1e-30)),
                                        {.operations = 1, .divisions = 1});
      stretch =
          body.scalar("stretch", fmt::format("{} * {} / {}", stretch, power_of(body, t, warp.parameter), t),
                      {.operations = 1, .divisions = 1});
    }
  }
  const auto at = [&](const std::string& component, const Axis& axis) {
    const std::string middle = d.literal(0.5 * axis.size + axis.first);
    if (axis.size == axis_x.size)
      return body.scalar("u", fmt::format("{} + {} * {}", middle, component, stretch), ops(2));
    return body.scalar(
        "u", fmt::format("{} + {} * {} * {}", middle, d.literal(axis.size / axis_x.size), component, stretch),
        ops(3));
  };
  return {at(p.x, axis_x), at(p.y, axis_y)};
}

}  // namespace burnish
