// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/formula/expression.h>
#include <burnish/reflectance/analytic/openpbr.h>

namespace burnish {

/// f_r of OpenPBR in 1/sr, a vector, as an expression over the vectors wi and wo: unit, above the horizon. The formulas
/// of OpenPbr::eval with the parameters as constants; layers of weight 0 are not in it.
Expr openpbr_expression(const OpenPbr& material);

}  // namespace burnish
