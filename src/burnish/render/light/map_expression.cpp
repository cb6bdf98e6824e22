// SPDX-License-Identifier: Apache-2.0
#include <burnish/render/light/map_expression.h>
#include <burnish/render/light/prefiltered_formula.h>

namespace burnish {

ExprVector in_half_of(const ExprVector& axis, const ExprVector& w) {
  return {w.x, named("up", if_less(axis.y, 0.0, -w.y, w.y)), w.z};
}

MapCoordinates map_coordinates(const ExprVector& w, int side) {
  const auto [x, y] = map_place(in_half_of(w, w), side);
  const Expr half = if_less(w.y, 0.0, static_cast<double>(side), 0.0);
  return {named("place_x", (x + half + 0.5) * (0.5 / side)), named("place_y", (y + 0.5) * (1.0 / side))};
}

}  // namespace burnish
