// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/fitting/one_lobe/log_rows.h>

namespace burnish {

/// Solves a log-linear problem by conjugate gradients on the normal equations, without forming them. Throws Error
/// if no sample has weight, or the system is not positive definite.
LogSolution solve_by_conjugate_gradients(const RowMaker& rows, const HomomorphicOptions& options);

}  // namespace burnish
