#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <burnish/fitting/refine.h>

namespace burnish {

struct BudgetOptions {
  std::size_t bytes = 2700;  ///< most bytes of the model, see FactoredBrdf::bytes
  int lobes = 0;             ///< 0: as many as serve the budget best
  TableFormat format = TableFormat::half;
  RefineOptions refine;
};

struct LobesSummary {
  double objective_before = 0;  ///< of the start of the last refinement, see PictureLoss
  double objective_after = 0;
  int lobes = 0;
  int iterations = 0;  ///< Gauss-Newton steps of all refinements and channels
  std::string stop_reason;
};

struct LobesFit {
  LogModel model;
  LobesSummary summary;
};

/// The model that fit_budget fits: lobes p(wo) p(wi) q(theta_h) m(theta_m) r(theta_d) of 1-D tables for
/// isotropic sources; for others a lobe of 1-D tables and lobes whose p and q are hemispheres. Throws Error
/// if even the smallest model does not fit the bytes.
ModelSpec budget_spec(const BudgetOptions& options, int channels, bool isotropic);

/// Fits the best model of a number of bytes, several lobes refined. Isotropic: one lobe log-linearly
/// [HomomorphicBrdf, eq. 5], then one split off after the other, each split starting from the function there
/// was. Anisotropic: as fit_lobes. Rounding to the table format is left to to_brdf. Throws Error as
/// budget_spec and fit_homomorphic do.
LobesFit fit_budget(const TrainingSet& set, const BudgetOptions& options);

/// Fits a given model of any number of lobes: each starts as the log-linear fit to its part of the data,
/// parts cut along theta_d, or by height where the lobes differ in shape; then all are refined together.
LobesFit fit_lobes(const TrainingSet& set, const ModelSpec& spec, const RefineOptions& options);

}  // namespace burnish
