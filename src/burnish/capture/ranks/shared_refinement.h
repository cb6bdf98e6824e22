#pragma once

#include <burnish/capture/ranks/fit_crew.h>
#include <burnish/fitting/refinement/log_model.h>
#include <burnish/fitting/refinement/refine.h>
#include <burnish/fitting/refinement/training_set.h>

namespace burnish {

/// refine() of a model of three channels without tables that these share, the channels shared by the ranks of a crew,
/// all of which call this with the same model, set and options; null: this process alone. The same bits at every rank
/// and for any number of them. Throws Error as refine().
void refine_together(FitCrew* crew, LogModel& model, const TrainingSet& set, const RefineOptions& options);

}  // namespace burnish
