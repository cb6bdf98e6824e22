// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/render/mesh/shapes.h>
#include <burnish/render/mesh/teapot.h>

namespace burnish {

namespace {

struct SurfacePoint {
  Vec3 position, normal, tangent;
};

// A grid of vertices over [0, 1]^2, appended to the mesh; du x dv points outwards.
template <class At>
void append_grid(Mesh& mesh, int columns, int rows, At at) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double u = static_cast<double>(i) / columns, v = static_cast<double>(j) / rows;
      const SurfacePoint p = at(u, v);
      mesh.vertices.push_back({.position = to_floats(p.position),
                               .normal = to_floats(p.normal),
                               .tangent = to_floats(orthogonalized(p.tangent, p.normal)),
                               .uv = {static_cast<float>(u), static_cast<float>(v)}});
    }
  // two triangles a cell
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto& v = mesh.vertices;
    if (v[a].position != v[b].position && v[b].position != v[c].position && v[c].position != v[a].position)
      mesh.triangles.push_back({a, b, c});  // none at the poles
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const auto a = first + static_cast<std::uint32_t>(j * (columns + 1) + i);
      const auto above = a + static_cast<std::uint32_t>(columns) + 1;
      add(a, a + 1, above + 1);
      add(a, above + 1, above);
    }
}

void require(const char* what, int value, int least, int most) {
  if (value < least || value > most)
    throw Error(fmt::format("mesh: expected {} in [{}, {}], found {}", what, least, most, value));
}

struct Curve {
  Vec3 point, direction;
};

// (r cos a, r sin a, k sin b), r = k (2 + cos b), a = 4 pi u, b = 6 pi u
Curve knot_at(double u) noexcept {
  constexpr double k = 0.27;
  const double a = 2 * kTwoPi * u, b = 3 * kTwoPi * u;
  const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b);
  const double r = k * (2 + cb), slope = -1.5 * k * sb;  // dr/da
  return {{r * ca, r * sa, k * sb}, normalize({slope * ca - r * sa, slope * sa + r * ca, 1.5 * k * cb})};
}

SurfacePoint patch_at(const BezierPatch& patch, double u, double v) noexcept {
  // Bernstein polynomials of degree 3 and their derivatives
  struct Weights {
    double value[4], slope[4];
  };
  const auto weights = [](double t) -> Weights {
    const double s = 1 - t;
    return {{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t},
            {-3 * s * s, 3 * s * (s - 2 * t), 3 * t * (2 * s - t), 3 * t * t}};
  };
  const auto sum = [&](const double(&along_u)[4], const double(&along_v)[4]) {
    Vec3 total;
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t i = 0; i < 4; ++i) total = total + along_u[i] * along_v[j] * patch[4 * j + i];
    return total;
  };
  // where a row of control points falls together there is no derivative along u: take those beside it
  constexpr double kBeside = 1e-4;
  const Weights wu = weights(u), wv = weights(v), inner = weights(std::clamp(v, kBeside, 1 - kBeside));
  const Vec3 du = sum(wu.slope, inner.value), dv = sum(wu.value, inner.slope);
  return {sum(wu.value, wv.value), normalize(cross(du, dv)), du};
}

}  // namespace

std::optional<Shape> parse_shape(std::string_view name) noexcept {
  if (name == "sphere") return Shape::sphere;
  if (name == "teapot") return Shape::teapot;
  if (name == "torus-knot") return Shape::torus_knot;
  if (name == "plane") return Shape::plane;
  return {};
}

Mesh make_sphere(int columns, int rows) {
  require("columns", columns, 3, 8192);
  require("rows", rows, 2, 8192);
  Mesh mesh;
  append_grid(mesh, columns, rows, [&](double u, double v) -> SurfacePoint {
    const double phi = kTwoPi * u, sine = v == 0 || v == 1 ? 0 : std::sin(kPi * v);
    const Vec3 n{sine * std::sin(phi), -std::cos(kPi * v), sine * std::cos(phi)};
    return {n, n, {std::cos(phi), 0, -std::sin(phi)}};
  });
  return mesh;
}

Mesh make_torus_knot(int columns, int rows) {
  require("columns", columns, 3, 8192);
  require("rows", rows, 3, 8192);
  constexpr double kTube = 0.14;
  Mesh mesh;
  append_grid(mesh, columns, rows, [&](double u, double v) -> SurfacePoint {
    // around the curve from the direction away from the middle, which comes back to itself
    const Curve c = knot_at(u);
    const Vec3 along = c.direction, side = normalize(cross(along, c.point)), up = cross(side, along);
    const double phi = kTwoPi * v;
    const Vec3 n = std::cos(phi) * up - std::sin(phi) * side;
    return {c.point + kTube * n, n, along};
  });
  return mesh;
}

Mesh make_teapot(int segments) {
  require("segments", segments, 1, 1024);
  // from x -3 ... 3.525 and z 0 ... 3.15 to y up and the unit sphere
  constexpr Vec3 kMiddle{0.24, 0, 1.575};
  constexpr double kScale = 1 / 3.6;
  const auto upright = [](Vec3 p) { return Vec3{p.x, p.z, -p.y}; };
  Mesh mesh;
  for (const BezierPatch& patch : teapot_patches())
    append_grid(mesh, segments, segments, [&](double u, double v) -> SurfacePoint {
      const SurfacePoint p = patch_at(patch, u, v);
      return {kScale * upright(p.position - kMiddle), upright(p.normal), upright(p.tangent)};
    });
  return mesh;
}

Mesh make_plane(int cells) {
  require("cells", cells, 1, 8192);
  Mesh mesh;
  append_grid(mesh, cells, cells, [](double u, double v) -> SurfacePoint {
    constexpr double kSide = std::numbers::sqrt2;
    return {{kSide * (u - 0.5), kSide * (v - 0.5), 0}, {0, 0, 1}, {1, 0, 0}};
  });
  return mesh;
}

Mesh make_shape(Shape shape, int vertices) {
  require("a number of vertices", vertices, 64, 1 << 24);
  const auto nearest = [](double x) { return static_cast<int>(std::lround(x)); };
  const double root = std::sqrt(vertices);
  switch (shape) {
    case Shape::sphere:
      return make_sphere(nearest(root * std::sqrt(2)), nearest(root / std::sqrt(2)));
    case Shape::teapot:
      return make_teapot(std::max(nearest(root / std::sqrt(32.0)) - 1, 1));
    case Shape::plane:
      return make_plane(std::max(nearest(root) - 1, 1));
    case Shape::torus_knot:
      break;
  }
  constexpr double kAspect = 12.5;  // the curve's length over the tube's circumference
  return make_torus_knot(nearest(root * std::sqrt(kAspect)), std::max(nearest(root / std::sqrt(kAspect)), 3));
}

}  // namespace burnish
