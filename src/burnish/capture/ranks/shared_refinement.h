// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/capture/ranks/fit_crew.h>
#include <burnish/fitting/refinement/log_model.h>
#include <burnish/fitting/refinement/refine.h>
#include <burnish/fitting/refinement/training_set.h>

namespace burnish {

/// Runs refine() for a model of three channels that share no table. The ranks of a crew share the channels. All ranks
/// call this with the same model, set and options; null: this process alone. The result has the same bits at every
/// rank and for any number of ranks. Throws Error as refine().
void refine_together(FitCrew* crew, LogModel& model, const TrainingSet& set, const RefineOptions& options);

}  // namespace burnish
