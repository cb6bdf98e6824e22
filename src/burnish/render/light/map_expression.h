// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/formula/expression.h>

namespace burnish {

/// Returns the image of a vector of the world in the half of a parabolic pair that `axis` lies in (parabolic_pair.h).
ExprVector in_half_of(const ExprVector& axis, const ExprVector& w);

/// Texture coordinates of a direction of the world in a pair of maps of `side` texels a side.
struct MapCoordinates {
  Expr x, y;
};
MapCoordinates map_coordinates(const ExprVector& w, int side);

}  // namespace burnish
