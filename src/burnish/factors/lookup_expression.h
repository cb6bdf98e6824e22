// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <burnish/factors/table.h>
#include <burnish/formula/expression.h>

namespace burnish {

/// An axis of a table: its warped tan(theta / 2) in [0, 1] is multiplied with `size` and `first` added, which
/// gives cells, or texture coordinates.
struct TableAxis {
  double size, first;
};

/// Returns the positions of two directions in a table, as expressions over the vectors "wi" and "wo": unit, above the
/// horizon. The formulas are those of parameterization/projection-inl.h, for arithmetic of single precision. A line
/// has one position, disks and grids two, a volume three; those that a table lacks are the number 0. A disk's
/// `x.size` cells are as many rows as there are columns.
std::array<Expr, 3> position_expressions(const TableLayout& layout, const FactorUse& use, const TableAxis& x,
                                         const TableAxis& y, const TableAxis& z);

/// The cell of `nodes` nodes that a position in cells falls into: its first node, a whole number, and how
/// far in it.
struct CellExpr {
  Expr node, fraction;
};
CellExpr cell_expression(const Expr& position, int nodes);

/// The value between two, numbers or vectors.
Expr mix_expression(const Expr& low, const Expr& high, const Expr& fraction);

}  // namespace burnish
