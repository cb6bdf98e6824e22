// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/fitting/one_lobe/log_rows.h>

namespace burnish {

/// Solves a log-linear problem by gathering the normal equations in one pass and factorizing them: for up to
/// some hundred unknowns. Throws Error if no sample has weight.
LogSolution solve_normal_equations(const RowMaker& rows, const HomomorphicOptions& options);

}  // namespace burnish
