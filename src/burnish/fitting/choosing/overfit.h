// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Returns the number and distribution of pairs to draw for a model of so many bytes. Many texels would fit few
/// pixels exactly and predict no others, so they need more pairs. They can also resolve a highlight's core and the
/// terminator, so pairs are denser there; few texels would fit other directions worse for that.
TrainingOptions training_for(std::size_t bytes, std::size_t texel_bytes, bool isotropic);

/// A fit, and the RefineOptions::smooth that it used.
struct SmoothFit {
  LobesFit fit;
  double smooth;
};

/// Runs fit_plan on a set that was drawn from the source as in `drawn`. If the set has few pairs a texel, new pairs
/// are drawn as a check. Their objective may be far above the set's. Then the plan is fitted with ten times
/// options.smooth, and so on as long as the objective on the new pairs falls. Throws Error as fit_plan and
/// draw_training_set do.
SmoothFit fit_without_overfit(BrdfRef source, const TrainingSet& set, const LobePlan& plan, std::size_t bytes,
                              std::size_t texel_bytes, const TrainingOptions& drawn,
                              const RefineOptions& options);

}  // namespace burnish
