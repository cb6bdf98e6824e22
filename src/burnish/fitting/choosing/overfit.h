#pragma once

#include <cstddef>

#include <burnish/fitting/choosing/fit_plan.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// How many pairs to draw for a model of so many bytes, and where: many texels learn few pixels by heart, and
/// have some to spare for a highlight's core and the terminator, for which few texels bend the rest.
TrainingOptions training_for(std::size_t bytes, std::size_t texel_bytes, bool isotropic);

/// A fit, and RefineOptions::smooth of it.
struct SmoothFit {
  LobesFit fit;
  double smooth;
};

/// fit_plan, of a set drawn from the source as `drawn` says. Where the set has few pairs of directions a
/// texel and the objective on pairs drawn anew is far above that on the set's, the plan is fitted with ten
/// times options.smooth, and again while the former falls. Throws Error as fit_plan and draw_training_set do.
SmoothFit fit_without_overfit(BrdfRef source, const TrainingSet& set, const LobePlan& plan, std::size_t bytes,
                              std::size_t texel_bytes, const TrainingOptions& drawn,
                              const RefineOptions& options);

}  // namespace burnish
