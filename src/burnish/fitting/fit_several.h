// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/fitting/fit.h>
#include <burnish/fitting/fitted_model.h>
#include <burnish/fitting/fitted_source.h>
#include <burnish/fitting/refinement/refine.h>

namespace burnish {

/// Returns the options that refine several lobes for a loss: the options' smoothness, the source's format.
RefineOptions refine_options(const FittedSource& source, const FitOptions& options, FitLoss loss,
                             const Stages& stages);

/// Returns true if the last steps look at albedos: for a function that is fitted for pictures.
bool counts_albedos(const FittedSource& source, FitLoss loss);

/// Adds the albedos of what is fitted to the set, and their share to the loss. Precondition: source.samples() is null.
void add_albedos(const FittedSource& source, TrainingSet& set, RefineOptions& refine);

/// The fit as it is stored, after last steps that look at albedos where these count. `report` says its loss and what
/// was chosen; the rest is added.
FittedLobes finish(const FittedSource& source, LobesFit fit, TrainingSet set, RefineOptions refine,
                   LobesReport report, const Stages& stages);

/// The same without last steps.
FittedLobes rounded(const LobesFit& fit, const TrainingSet& set, const RefineOptions& refine,
                    LobesReport report);

/// Lobes as given, refined together. Throws Error as parse_model_spec and fit_lobes do.
FittedLobes fit_given(const FittedSource& source, const FitOptions& options, const GivenLobes& form,
                      const Stages& stages);

}  // namespace burnish
