// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <burnish/fitting/choosing/fit_plan.h>

namespace burnish {

struct SearchOptions {
  std::size_t bytes = 2700, texel_bytes = 6;
  RefineOptions refine;  ///< for every trial
  /// Called from the calling thread with the share of the expected work that is done; it never falls.
  std::function<void(double fraction)> progress;
};

/// A change of the plan that was tried.
struct SearchTrial {
  std::string change;    ///< "start", "lobes 4", "q share x 1.4", "+ s(wi+wo+0.5n)", "- m", …
  double objective = 0;  ///< PictureLoss on pairs that the trial was not fitted to
  bool kept = false;
};

struct SearchResult {
  LobePlan plan;
  std::vector<SearchTrial> trials;
};

/// Returns plan_for with the number of lobes that fits an anisotropic source best: two, three or four. Each number is
/// fitted in few steps to part of the set and judged on another part. If that part has too few pairs, these trials
/// use fewer bytes. Calls options.progress with rising shares of the trials. Throws Error as default_plan does.
LobePlan plan_for(BrdfRef source, const TrainingSet& set, std::size_t bytes, int lobes,
                  std::size_t texel_bytes, const RefineOptions& options);

/// Finds the factors, projections, warps, sizes and number of lobes that serve the data best at a number of bytes,
/// which [HomomorphicBrdf] names as future work. It tries more or fewer lobes, larger or smaller shares of texels,
/// other warps, and removed factors. It also adds factors over further projections (affine combinations, whose
/// coefficients are then refined). Each round tries every change alone, fitted to part of the pairs and judged on
/// another part. It then keeps those that still pay off together, the best first. There are two rounds, or fewer if
/// nothing changes. The search works on the mean of the channels. Deterministic.
SearchResult search_plan(const TrainingSet& set, const LobePlan& start, const SearchOptions& options);

}  // namespace burnish
