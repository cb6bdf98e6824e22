// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/fitting/fit.h>
#include <burnish/fitting/fitted_model.h>
#include <burnish/fitting/fitted_source.h>

namespace burnish {

/// The best model within a budget, whose bytes are chosen where it has none, see Budget. Throws Error for a budget that
/// contradicts itself or holds no model, and what the fits throw.
FittedModel fit_budget(const FittedSource& source, const FitOptions& options, const Budget& budget,
                       const Stages& stages);
/// The same of the default budget.
FittedModel fit_budget(const FittedSource& source, const FitOptions& options, const DefaultBudget& budget,
                       const Stages& stages);

}  // namespace burnish
