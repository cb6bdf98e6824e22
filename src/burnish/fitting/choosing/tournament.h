// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <burnish/factors/model_spec.h>
#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/fit_report.h>
#include <burnish/fitting/refinement/refine.h>
#include <burnish/fitting/refinement/training_set.h>

namespace burnish {

/// Returns every step-th pair, beginning at `first`.
TrainingSet part_of(const TrainingSet& set, std::size_t first, std::size_t step);

/// Returns the set with one channel, the mean of its channels.
TrainingSet mean_of_channels(const TrainingSet& set);

/// Two parts of a set, each of every step-th pair, without a common pair.
struct TrialParts {
  /// Precondition: step >= 2.
  TrialParts(const TrainingSet& set, std::size_t step);

  TrainingSet fitted;  ///< pairs that candidates are fitted to
  TrainingSet judged;  ///< pairs that judge them
};

/// A model that takes part in a tournament.
struct Candidate {
  ModelSpec spec;                                          ///< tables with all their nodes
  std::optional<LobePlan> plan = {};                       ///< the plan of the spec, for lobes
  LogModel fit = {};                                       ///< the present fit, maybe at fewer nodes
  double error = std::numeric_limits<double>::infinity();  ///< in the last heat; infinite before one
};

/// The rules of a competition: each candidate is fitted to one part of the pairs and judged on the other.
struct Heat {
  TrialParts parts;
  RefineOptions options;      ///< for the fits
  ErrorTerms shares;          ///< for the objective that judges them
  double worth_of_fetch = 0;  ///< >= 0; a fetch must lower the objective by this share of shares.sum()

  /// Returns the objective of a model on the judged part.
  double error_of(const LogModel& fit) const;

  /// Fits all candidates, on all threads, and sets their errors: the objective on the judged part, and what their
  /// fetches cost. `fit` sets Candidate::fit. `progress` is called on the calling thread, if it is not empty, with the
  /// share of the candidates that are done.
  void play(std::span<Candidate> candidates, const std::function<void(Candidate&)>& fit,
            const std::function<void(double)>& progress = {}) const;
};

/// Returns the candidates of the least errors, at most `count`, the best first.
std::vector<Candidate> finalists(std::vector<Candidate> candidates, std::size_t count);

/// Returns the candidate of the least error, the first of equal ones. Precondition: not empty.
Candidate& winner(std::span<Candidate> candidates);

/// A knee's factor: the error of the model that is chosen may be this many times the least.
inline constexpr double kKneeFactor = 1.02;

/// Returns the trial that reports a candidate's number of fetches. Its error is exp(error / shares.sum()).
FetchTrial fetch_trial_of(const Candidate& candidate, const ErrorTerms& shares);

/// Candidates that differ in fetches.
struct FetchTrials {
  std::vector<FetchTrial> trials;     ///< by rising fetches
  std::vector<Candidate> candidates;  ///< the candidates of these trials
};
/// For each number of fetches, returns the best of its candidates.
FetchTrials best_of_each_fetch_count(std::vector<Candidate> candidates, const ErrorTerms& shares);

/// Returns the trial of the fewest fetches whose error is within kKneeFactor of the least. Precondition: at least one
/// trial, by rising fetches.
const FetchTrial& trial_at_knee(std::span<const FetchTrial> trials);

/// Options for a trial: tables of floats, at most `steps` steps, no progress.
RefineOptions in_few_steps(RefineOptions options, int steps);

/// Calls work(k) for `count` trials on all threads. Calls `progress`, if it is not empty, on the calling thread with
/// the share that is done.
void for_each_trial(std::size_t count, const std::function<void(double)>& progress,
                    const std::function<void(std::size_t)>& work);

}  // namespace burnish
