#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <burnish/fitting/refine.h>

namespace burnish {

/// How the bytes of one lobe p(wo) p(wi) q(theta_h) m(theta_m) r(theta_d) are spent: shares of its texels.
struct LobeShares {
  double p = 0.083, q = 0.587, m = 0.183, r = 0.147;
};

struct BudgetOptions {
  std::size_t bytes = 2700;  ///< most bytes of the model, see FactoredBrdf::bytes
  int lobes = 0;             ///< 0: as many as the budget serves best
  TableFormat format = TableFormat::half;
  RefineOptions refine;
};

struct BudgetSummary {
  RefineSummary refined;           ///< the last refinement
  std::vector<std::string> steps;  ///< what was done, a line each
};

struct BudgetFit {
  FactoredBrdf brdf;
  BudgetSummary summary;
};

/// The largest model of `lobes` lobes within the budget. Isotropic: every table 1-D. Throws Error if even the
/// smallest does not fit.
ModelSpec isotropic_spec(std::size_t bytes, int lobes, int channels, TableFormat format,
                         const LobeShares& shares = {});

/// Fits the best model of a number of bytes: one lobe log-linearly [HomomorphicBrdf, eq. 5], refined, then
/// split in two along theta_d and refined again until there are `lobes`. Each split starts from the function
/// it had.
BudgetFit fit_budget(const TrainingSet& set, const BudgetOptions& options);

}  // namespace burnish
