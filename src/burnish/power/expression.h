// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <burnish/formula/expression.h>
#include <burnish/power/power.h>

namespace burnish {

/// The member's value as a graph over the inputs "c" and k0, k1, …: the given coefficients' expressions.
Expr power_value_expression(PowerMethod method, const std::vector<Expr>& coefficients);

/// The member's coefficients as graphs over the input "e".
std::vector<Expr> power_coefficient_expressions(PowerMethod method);

/// Returns the cost of the method's value, counted from its graph.
PowerCost count_operations(PowerMethod method);

}  // namespace burnish
