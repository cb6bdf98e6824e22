#pragma once

#include <functional>
#include <string>
#include <vector>

#include <burnish/fitting/choosing/fit_plan.h>

namespace burnish {

struct SearchOptions {
  std::size_t bytes = 2700, texel_bytes = 6;
  RefineOptions refine;  ///< of every trial
  /// Called with shares of the work expected that never fall, from the calling thread.
  std::function<void(double fraction)> progress;
};

/// A change of the plan that was tried.
struct SearchTrial {
  std::string change;    ///< "start", "lobes 4", "q share x 1.4", "+ s(wi+wo+0.5n)", "- m", …
  double objective = 0;  ///< of PictureLoss, on pairs that the trial was not fitted to
  bool kept = false;
};

struct SearchResult {
  LobePlan plan;
  std::vector<SearchTrial> trials;
};

/// plan_for, the lobes of an anisotropic source as many as serve it best: two, three or four, each fitted to
/// part of the set in few steps, at fewer bytes where that has too few pairs, and judged on another.
/// options.progress is called with rising shares of those trials. Throws Error as default_plan does.
LobePlan plan_for(BrdfRef source, const TrainingSet& set, std::size_t bytes, int lobes,
                  std::size_t texel_bytes, const RefineOptions& options);

/// Finds the factors, projections, warps, sizes and number of lobes that serve the data best at a number of
/// bytes, the future work that [HomomorphicBrdf] names: more or fewer lobes, larger or smaller shares of
/// texels, other warps, factors left out, factors added over further projections (affine combinations, whose
/// coefficients are then refined). Each round tries every change alone, fitted to part of the pairs and
/// judged on another, and then keeps those that go on paying off together, the most rewarding first; two
/// rounds, or until nothing changes. Works on the mean of the channels. Deterministic.
SearchResult search_plan(const TrainingSet& set, const LobePlan& start, const SearchOptions& options);

}  // namespace burnish
