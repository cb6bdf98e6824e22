#pragma once

#include <burnish/eval/tabulated_sampler.h>
#include <burnish/formula/expression.h>

namespace burnish {

/// A direction to the light and its density.
struct DrawnExpr {
  Expr x, y, z, pdf;
};

/// TabulatedSampler::sample_wi as expressions over the numbers "wo_x", "wo_y", "wo_z", "u_x" and "u_y" and
/// the arrays of integers "row_edges" and "cell_edges", those of the tables.
DrawnExpr sample_expression(const SamplerTables& tables);

/// TabulatedSampler::pdf, over "wi_x" to "wo_z".
Expr pdf_expression(const SamplerTables& tables);

}  // namespace burnish
