// SPDX-License-Identifier: Apache-2.0
#include <type_traits>

#include <burnish/factors/lookup_expression.h>

namespace burnish {

namespace {

Expr length(const Expr& x, const Expr& y) {
  return sqrt(named("rr", mul_add(x, x, y * y)));
}
Expr length(const Expr& x, const Expr& y, const Expr& z) {
  return named("len", sqrt(mul_add(z, z, named("rr", mul_add(x, x, y * y)))));
}
Expr least_positive(const Expr&) {
  return 1e-30;
}
Expr whole(const Expr& x) {
  return floor(x);
}

#define FORMULA_INLINE inline
#define FORMULA_ATTRIBUTE
#include <burnish/factors/lookup-inl.h>
#include <burnish/parameterization/projection-inl.h>
#undef FORMULA_ATTRIBUTE
#undef FORMULA_INLINE

struct ExprPair {
  ExprVector sum, apart;

  ExprPair(const ExprVector& wi, const ExprVector& wo)
      : sum(named("sum", wi + wo)), apart(named("apart", wi - wo)) {}
  Expr sum_length() const { return length(sum.x, sum.y, sum.z); }
  /// Returns |d| |s_xy|, from roots that theta_d and theta_h take too.
  Expr azimuth_size() const {
    return named("r", length(apart.x, apart.y, apart.z)) * named("r", length(sum.x, sum.y));
  }
};

ExprVector direction(const char* name) {
  return ExprVector(Expr::input(name, ValueType::vector));
}

// The polar angle and x, y of a projected vector; a polar angle alone has no x and y.
struct Projected {
  Polar<Expr> polar;
  Expr x, y;
};

Projected project_expression(const Projection& p, bool azimuth) {
  const ExprVector wi = direction("wi"), wo = direction("wo");
  if (p == kProjectWi || p == kProjectWo) {
    const ExprVector& w = p == kProjectWi ? wi : wo;
    Polar<Expr> polar = polar_of(w, Expr(1.0));
    polar.den = named("den", polar.den);
    return {polar, w.x, w.y};
  }
  if (p.kind == Projection::Kind::affine) {
    const auto [v, polar] = affine(p, wi, wo);
    return {polar, v.x, v.y};
  }
  // A polar angle alone needs no frame; an azimuth takes the components across the half vector.
  const ExprPair pair(wi, wo);
  const Polar<Expr> polar = with_angle(p.kind, [&](const auto& angle) { return angle(pair); });
  if (!azimuth) return {polar, 0.0, 0.0};
  const auto [x, y] = across_half(pair.sum, pair.sum_length(), pair.apart);
  return {polar, x, y};
}

Expr warped(const Warp& warp, double size, const Polar<Expr>& polar) {
  switch (warp.kind) {
    case WarpKind::rational:
      return rational_warp(Expr(size), Expr(warp.parameter), polar);
    case WarpKind::power:
      return power_warp(Expr(size), warp.parameter, polar);
    case WarpKind::identity:
      break;
  }
  return identity_warp(Expr(size), polar);
}

Expr stretched(const Warp& warp, double size, const Polar<Expr>& polar) {
  switch (warp.kind) {
    case WarpKind::rational:
      return rational_stretch(Expr(size), Expr(warp.parameter), polar);
    case WarpKind::power:
      return power_stretch(Expr(size), warp.parameter, polar);
    case WarpKind::identity:
      break;
  }
  return identity_stretch(Expr(size), polar);
}

Expr line_position(const Projection& projection, const Warp& warp, const TableAxis& axis) {
  return named("u", warped(warp, axis.size, project_expression(projection, false).polar) + axis.first);
}

}  // namespace

std::array<Expr, 3> position_expressions(const TableLayout& layout, const FactorUse& use, const TableAxis& x,
                                         const TableAxis& y, const TableAxis& z) {
  if (layout.shape != TableShape::disk) {
    const int axes = axis_count(layout.shape);
    return {line_position(use.projection, layout.warp, x),
            axes > 1 ? line_position(use.projection_y, layout.warp_y, y) : Expr(0.0),
            axes > 2 ? line_position(use.projection_z, layout.warp_z, z) : Expr(0.0)};
  }
  // A disk's position is the middle plus (x, y) times half the size over r, warped.
  const Projected at = project_expression(use.projection, true);
  const Expr stretch = named("stretch", stretched(layout.warp, 0.5 * x.size, at.polar));
  const auto along = [&](const Expr& component, const TableAxis& axis) {
    const Expr scaled = Expr(axis.size / x.size) * component;
    return named("u", mul_add(scaled, stretch, 0.5 * axis.size + axis.first));
  };
  return {along(at.x, x), along(at.y, y), 0.0};
}

CellExpr cell_expression(const Expr& position, int nodes) {
  const Cell<Expr> cell = cell_of(position, Expr(nodes - 1.0));
  return {cell.node, cell.fraction};
}

Expr mix_expression(const Expr& low, const Expr& high, const Expr& fraction) {
  return mix(low, high, fraction);
}

}  // namespace burnish
