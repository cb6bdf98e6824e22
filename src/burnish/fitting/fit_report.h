// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <burnish/fitting/baselines/negative_lobes.h>
#include <burnish/fitting/book/complete.h>
#include <burnish/fitting/fit_summary.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/bsdf_part.h>
#include <burnish/reflectance/expected_error.h>
#include <burnish/reflectance/node_figures.h>

namespace burnish {

/// The goal of refining several lobes: pictures at every exposure beside both means, or one mean.
enum class FitLoss { image, relative, log_cos };

/// "image", "relative" or "log_cos".
std::string_view to_string(FitLoss loss) noexcept;
/// Reads what to_string writes; throws Error on anything else.
FitLoss parse_fit_loss(std::string_view name);

/// One lobe, fitted log-linearly.
struct OneLobeReport {
  FitSummary summary;       ///< errors are rms of log f, see HomomorphicFit
  std::size_t samples = 0;  ///< with weight
  double smooth = 0;        ///< as given or chosen
  double floor = 0;         ///< 1/sr
  int reweightings = 0;     ///< passes used
  /// Tables whose share of the smoothness is not 1.
  std::vector<std::pair<std::string, double>> smooth_shares;
  /// For scattered samples, exp(mean |ln((f + e) / (model + e))|) - 1: at the samples, and at those left out in turn
  /// while the smoothness was chosen.
  std::optional<double> relative, relative_cross_validated;
};

/// The trials of search_plan.
struct SearchReport {
  std::size_t trials = 0;
  /// The changes kept and the objective after each.
  std::vector<std::pair<std::string, double>> kept;
};

/// A number of fetches that was tried on part of the pairs, the mean of their channels.
struct FetchTrial {
  int fetches = 0;
  bool lobes = false;  ///< several, of lines or hemispheres; else a form of volume_specs or hemisphere_specs
  /// exp of the objective over the sum of its shares: a geometric mean of errors, on pairs that were not fitted.
  double error = 0;
};

/// Several lobes, refined together.
struct LobesReport {
  FitSummary summary;       ///< errors are objectives, see refine
  std::size_t samples = 0;  ///< pairs fitted
  std::size_t lobes = 0;
  FitLoss loss = FitLoss::image;
  std::uint64_t budget = 0;                   ///< bytes; 0: the lobes were given
  int fetches = 0;                            ///< of the budget; 0: as many as the lobes take
  std::vector<FetchTrial> fetch_trials = {};  ///< where they were chosen
  std::optional<double> smooth;               ///< where it was chosen
  std::optional<SearchReport> search;
};

/// Why a number of bytes was chosen: the model errs no more than the measurement itself, or by less than half a
/// percent; more bytes hardly help; the largest that is tried; what predicts held-out samples best.
enum class BudgetStop { noise, floor, gain, largest, cross_validation };

/// "noise", "floor", "gain", "largest" or "cross-validation".
std::string_view to_string(BudgetStop stop) noexcept;

/// Errors that a measurement and its models have alike, as in ErrorFigures or NodeFigures; those that are known.
struct ErrorLevel {
  double relative = 0;
  std::optional<double> log_cos, rms, psnr;
};

/// A number of bytes that was tried.
struct BudgetTrial {
  std::uint64_t bytes = 0;
  ErrorLevel error;   ///< of its model
  double excess = 0;  ///< how many times that is above the noise, or without noise above half a percent
};

/// The choice of a number of bytes.
struct BudgetChoice {
  std::uint64_t bytes = 0;
  BudgetStop stop = BudgetStop::largest;
  std::optional<ErrorLevel> noise;  ///< what the measurement itself would score, where something tells
  std::vector<BudgetTrial> trials;  ///< of rising bytes; none of few scattered samples
};

/// The result of a method of others.
struct BaselineReport {
  std::string method;
  std::size_t budget = 0;                       ///< bytes
  std::optional<std::size_t> layouts_tried;     ///< of decompositions
  std::optional<FitSummary> summary;            ///< of the others; errors as DgfFit and AnalyticFit say
  std::optional<int> starts;                    ///< of analytic models
  std::optional<NegativeLobes> negative_lobes;  ///< of svd
};

/// The energy that conserve_energy removed, and its cost on pairs that were not fitted.
struct EnergyReport {
  double largest_albedo_before = 0, largest_albedo_after = 0;
  int iterations = 0;
  ErrorFigures before, after;
};

/// The nodes that were fitted, if the target was nodes.
struct NodesReport {
  std::size_t fitted = 0;    ///< nodes, without those that were held out and outliers
  std::size_t outliers = 0;  ///< scattered samples that were left out: see outliers_among
  /// The function between the nodes of an isotropic source: its covariance, and its score at nodes that it had not
  /// seen.
  std::optional<LogCovariance> covariance = {};
  std::optional<NodeFigures> held_out = {};
  /// Errors of the model as stored, at the nodes that were fitted and at those that were held out.
  NodeFigures at_fitted = {};
  std::optional<NodeFigures> at_held_out = {};
  /// The expected error of the model as stored, also where nothing was measured; only for sources with a function
  /// between their nodes.
  std::optional<ExpectedError> expected = {};
};

/// The report of a fit.
struct FitReport {
  std::string source, source_format;
  std::optional<BsdfBlock> block;  ///< the part and band of a file that has several
  bool symmetrized = true;
  std::variant<OneLobeReport, LobesReport, BaselineReport, CompletionReport> how;
  std::optional<BudgetChoice> budget_choice;
  std::optional<NodesReport> nodes;
  std::optional<EnergyReport> energy;
  /// Errors of the model as stored, on 20,000 pairs that were not fitted; none for factors fitted to scattered
  /// samples.
  std::optional<ErrorFigures> held_out;
  double seconds = 0;  ///< of the fit by the wall clock, without what was measured afterwards

  /// Returns the solver's summary; nothing for decompositions and completions.
  std::optional<FitSummary> summary() const;
};

/// A JSON object in one line, the notes that a model's file keeps: source, source_format, of a file of several parts
/// part and band, symmetrized; of one lobe
/// samples, smooth, floor, reweightings, rms_log_before, rms_log_after, iterations, stop_reason, smooth_shares,
/// relative, relative_cross_validated; of several search, budget, fetches, fetch_trials, smooth, samples, lobes,
/// loss, iterations, stop_reason, objective; of baselines method, budget, layouts_tried, error_before, error_after,
/// starts, iterations, stop_reason; of completions samples, used, book_materials, nearest, brightness, colour,
/// relative_at_samples, relative_left_out; of a chosen number of bytes budget_choice; of nodes target, nodes,
/// node_covariance, node_held_out, node_fit, node_test, node_expected; then conserve_energy, psnr, ssim, relative,
/// rms_log, log_cos and negative_lobes. Absent figures are left out; what is not finite is null.
std::string to_json(const FitReport& report);

}  // namespace burnish
