// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <burnish/fitting/fit_summary.h>
#include <burnish/fitting/refinement/log_model.h>
#include <burnish/fitting/refinement/lookups.h>
#include <burnish/fitting/refinement/picture_loss.h>
#include <burnish/fitting/refinement/training_set.h>

namespace burnish {

/// coupled_unknowns up to which steps are solved by a Cholesky factorization.
inline constexpr std::size_t kMaxCholeskyUnknowns = 1000;

struct RefineOptions {
  ErrorTerms shares = PictureLoss{}.shares;  ///< see PictureLoss
  /// Factor of the smoothness term: the integrals over each table of the squared second derivatives of log
  /// lambda; >= 0.
  double smooth = 1e-8;
  /// Storage format of tables without one of their own: values stay within its range.
  TableFormat format = TableFormat::half;
  int max_iterations = 40;  ///< Gauss-Newton steps a channel
  /// The one channel to refine, for models without tables that channels share. Empty: all channels.
  std::optional<std::size_t> channel = {};
  double least_progress = 2e-4;  ///< stop after three steps in a row that lowered the objective by less
  /// Called with rising shares of the work done, from the calling thread.
  std::function<void(double fraction)> progress;
};

/// Returns a callback for a part of the work that runs from `from` to `to` of the whole; null if `whole` is
/// null.
std::function<void(double fraction)> part_of_progress(std::function<void(double fraction)> whole, double from,
                                                      double to);

/// Lowers the error that PictureLoss states, by damped Gauss-Newton steps (Levenberg-Marquardt) on the
/// logarithms of the tables [Marquardt1963]. All lambda stay positive, and every accepted step lowers the
/// objective.
/// Channels are refined side by side, or as one system where a table is shared. Channels of the same data
/// and start are refined once.
/// Steps are solved directly for up to kMaxCholeskyUnknowns unknowns, by preconditioned conjugate gradients
/// for more. The result does not depend on the number of threads.
/// The summary's errors are the objective with the smoothness term, means over the channels. Its iterations
/// are of all channels. Throws Error if smooth or max_iterations is negative, or if model and data differ in
/// channels.
FitSummary refine(LogModel& model, const TrainingSet& set, const RefineOptions& options);
/// The same, given the set's lookups by models of this spec.
FitSummary refine(LogModel& model, const TrainingSet& set, const Lookups& lookups,
                  const RefineOptions& options);

class Descent;

/// refine() of one channel in parts. A second process may continue what a first one began, to the same bits.
class ChannelRefinement {
 public:
  /// Prepares the refinement of options.channel of a model without tables that channels share. It reports no
  /// progress.
  /// The set and its lookups must outlive this object. Throws Error as refine().
  ChannelRefinement(const LogModel& model, const TrainingSet& set, const Lookups& lookups,
                    const RefineOptions& options);
  ChannelRefinement(ChannelRefinement&&) noexcept;
  ChannelRefinement& operator=(ChannelRefinement&&) noexcept;
  ~ChannelRefinement();

  /// Takes at most `steps` further steps, and at most options.max_iterations in all.
  void run(int steps);
  /// Returns all that another object of the same model, set and options needs to continue. Call after a run.
  std::vector<double> state() const;
  /// Restores a state of another object in place of the first run.
  void go_on_from(std::span<const double> state);
  /// Writes the channel's tables into the model.
  void finish(LogModel& model) const;

 private:
  std::unique_ptr<Descent> descent_;
};

/// The objective that refine lowers, without the smoothness term; mean over the channels.
double objective(const LogModel& model, const TrainingSet& set, const ErrorTerms& shares);
double objective(const LogModel& model, const TrainingSet& set, const Lookups& lookups,
                 const ErrorTerms& shares);

}  // namespace burnish
