#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/factors/model_file.h>
#include <burnish/fitting/one_lobe/homomorphic.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/half_diff_table.h>
#include <burnish/reflectance/samples.h>

namespace burnish {

/// What is fitted; what it refers to must outlive the fit.
struct FitInput {
  BrdfRef brdf;
  std::string name, format;              ///< for the notes
  std::vector<double> lambda_nm = {};    ///< wavelengths of the channels; empty for grey and RGB
  const Samples* samples = nullptr;      ///< the measurements of a scattered source: these are fitted
  const HalfDiffTable* table = nullptr;  ///< a source that is a table: its entries are fitted
};

/// What several lobes are refined for: pictures at every exposure beside both means, or one mean.
enum class FitLoss { image, relative, log_cos };

struct FitOptions {
  std::string model = "pqp";        ///< see parse_model_spec; ignored with a budget
  std::vector<std::string> tables;  ///< the same
  std::uint64_t budget = 0;         ///< bytes: the best model of several lobes that they hold; 0: none given
  int lobes = 0;                    ///< of the budget; 0: as many as serve it best
  bool search = false;              ///< of the budget: search_plan first
  FitLoss loss = FitLoss::image;    ///< of several lobes
  std::optional<double> smooth;     ///< >= 0; none: the solver's own, or chosen for scattered samples
  bool cross_validate = false;      ///< of one lobe: choose_smoothness, whatever the source
  std::optional<int> reweightings;  ///< of one lobe; none: 4 for scattered samples, else 0
  double floor = HomomorphicOptions{}.floor;  ///< of one lobe, 1/sr
  /// Of tables without one of their own. None: half; with a budget and three channels rgb9e5.
  std::optional<TableFormat> format;
  std::size_t samples = 0;  ///< pairs drawn for one lobe from a source that is a function; 0: the default
  std::uint64_t seed = 1;   ///< of the drawn pairs
  bool symmetrize = true;   ///< fit the reciprocal part, see SymmetrizedBrdf
  bool conserve_energy = false;  ///< see burnish::conserve_energy
  /// Called from the calling thread with what is done ("searching", "fitting") and a rising share of it. What
  /// it throws ends the fit and reaches the caller.
  std::function<void(std::string_view stage, double fraction)> progress;
};

/// Fits a factored BRDF the way `burnish fit` does: one lobe log-linearly (fit_homomorphic), several as
/// fit_plan or fit_lobes do. The notes say what was fitted and how, and hold the error figures of the stored
/// model on 20,000 pairs that were not fitted (of scattered samples: at the samples). Throws Error for a
/// model, table option or format that does not fit, and what the solvers throw.
Model fit(const FitInput& input, const FitOptions& options);

}  // namespace burnish
