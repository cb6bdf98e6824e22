// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/eval/tabulated_sampler.h>
#include <burnish/formula/expression.h>

namespace burnish {

/// A direction to the light and its density.
struct DrawnExpr {
  Expr x, y, z, pdf;
};

/// The names under which a graph reads a sampler's tables, and how.
struct SamplerArrays {
  std::string row_edges = "row_edges", cell_edges = "cell_edges";  ///< arrays of integers
  /// A texture of one channel that holds both arrays instead, if it has a name. Its rows have kSamplerTextureWidth
  /// numbers. Those of row_edges come first; those of cell_edges begin in the next row.
  std::string texture = {};
};
inline constexpr int kSamplerTextureWidth = 64;

/// Returns TabulatedSampler::sample_wi as expressions of wo and u, whose third component is not read. Other inputs
/// are the tables.
DrawnExpr sample_expression(const SamplerTables& tables, const ExprVector& wo, const ExprVector& u,
                            const SamplerArrays& arrays = {});
/// Returns the same over the numbers "wo_x", "wo_y", "wo_z", "u_x" and "u_y".
DrawnExpr sample_expression(const SamplerTables& tables);

/// Returns TabulatedSampler::pdf as an expression of wi, wo and the tables.
Expr pdf_expression(const SamplerTables& tables, const ExprVector& wi, const ExprVector& wo,
                    const SamplerArrays& arrays = {});
/// Returns the same over the numbers "wi_x" to "wo_z".
Expr pdf_expression(const SamplerTables& tables);

}  // namespace burnish
