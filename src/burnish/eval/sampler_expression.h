// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/eval/tabulated_sampler.h>
#include <burnish/formula/expression.h>

namespace burnish {

/// A direction to the light and its density.
struct DrawnExpr {
  Expr x, y, z, pdf;
};

/// Returns TabulatedSampler::sample_wi as expressions. Their inputs are the numbers "wo_x", "wo_y", "wo_z", "u_x" and
/// "u_y", and the tables' arrays of integers "row_edges" and "cell_edges".
DrawnExpr sample_expression(const SamplerTables& tables);

/// Returns TabulatedSampler::pdf as an expression of "wi_x" to "wo_z" and these arrays.
Expr pdf_expression(const SamplerTables& tables);

}  // namespace burnish
