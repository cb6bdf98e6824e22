#pragma once

#include <cstdint>

#include <burnish/fitting/budget.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// fit_plan, of a set drawn from the source with `seed`. Where the set has few pairs of directions a texel
/// and the objective on pairs drawn anew is far above that on the set's, the plan is fitted with ten times
/// options.smooth, and again while the former falls. Leaves the smoothness of the fit returned in the
/// options. Throws Error as fit_plan and draw_training_set do.
LobesFit fit_without_overfit(BrdfRef source, const TrainingSet& set, const LobePlan& plan, std::size_t bytes,
                             std::size_t texel_bytes, std::uint64_t seed, RefineOptions& options);

}  // namespace burnish
