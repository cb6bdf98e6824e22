// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/choosing/plan_changes.h>
#include <burnish/fitting/choosing/search.h>
#include <burnish/fitting/choosing/tournament.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

// A trial is fitted to every kSearchPart-th pair in few steps and judged on an equal number of other pairs.
constexpr std::size_t kSearchPart = 6;
constexpr int kSearchSteps = 8;
constexpr int kMaxRounds = 2;
// A change must gain at least this: another draw of pairs would change errors as much.
constexpr double kMinGain = 0.01;
// Models that judge an anisotropic source's lobes have at most one texel for this many pairs.
constexpr std::size_t kJudgedPairs = 8;
constexpr int kMaxAnisotropicLobes = 4;

/// A part of the pairs that plans are fitted to and another that judges them. Each trial sets its number of steps.
Heat heat_of_plans(const TrainingSet& set, const RefineOptions& options) {
  return {.parts = TrialParts(set, kSearchPart), .options = options, .shares = options.shares};
}

/// Runs search_plan.
class PlanSearch {
 public:
  PlanSearch(const TrainingSet& set, const SearchOptions& options)
      : set_(set), options_(options), grey_(heat_of_plans(mean_of_channels(set), options.refine)) {
    // Progress is reported at every step, so that a callback can end the search.
    grey_.options.progress = [this](double) {
      if (std::this_thread::get_id() == caller_) report();
    };
  }
  PlanSearch(const PlanSearch&) = delete;

  SearchResult run(const LobePlan& start) {
    Candidate best = fit(start, nullptr);
    best = fit(start, &best);  // every change gets as many steps
    result_.trials = {{"start", best.error, true}};
    for (int round = 0; round < kMaxRounds; ++round)
      if (!improve(round, best)) break;
    result_.plan = *best.plan;
    if (set_.channels > 1) share_channels();
    share_done_ = 1;
    report();
    return std::move(result_);
  }

 private:
  bool fits(const LobePlan& plan) const {
    return plan_fits(plan, options_.bytes, set_.channels, options_.texel_bytes);
  }

  /// Fits a plan. It starts from known functions if the number of lobes is the same. Throws Error if the bytes do not
  /// hold the plan.
  Candidate fit(const LobePlan& plan, const Candidate* from) const {
    Candidate result{.spec = plan_to_spec(plan, options_.bytes, set_.channels, options_.texel_bytes),
                     .plan = plan};
    RefineOptions steps = grey_.options;
    if (from && from->plan->lobes == plan.lobes) {
      steps.max_iterations = kSearchSteps;
      result.fit = resampled(from->fit, result.spec);
      refine(result.fit, grey_.parts.fitted, steps);
    } else {
      steps.max_iterations = 2 * kSearchSteps;
      result.fit = fit_plan(grey_.parts.fitted, plan, options_.bytes, options_.texel_bytes, steps).model;
    }
    result.error = grey_.error_of(result.fit);
    return result;
  }

  /// Runs one round: every change alone, then the useful ones together. False if none is useful.
  bool improve(int round, Candidate& best) {
    const std::vector<PlanChange> changes = list_changes(*best.plan);
    const std::vector<double> values = try_alone(changes, best, round);

    // The changes with the best values come first.
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < changes.size(); ++k)
      if (values[k] < best.error - kMinGain) order.push_back(k);
    std::ranges::sort(order, {}, [&](std::size_t k) { return std::pair(values[k], k); });
    std::vector<bool> kept(changes.size());
    for (const std::size_t k : order) {
      const auto changed = changes[k].apply(*best.plan);
      if (!changed || !fits(*changed)) continue;
      Candidate next;
      attempt([&] { next = fit(*changed, &best); });
      drop_failures();
      kept[k] = next.error < best.error - kMinGain;
      if (kept[k]) best = std::move(next);
    }
    for (std::size_t k = 0; k < changes.size(); ++k)
      if (values[k] < INFINITY) result_.trials.push_back({changes[k].name, values[k], kept[k]});
    return std::ranges::any_of(kept, [](bool b) { return b; });
  }

  /// Returns the objective of each change; infinite if it does not apply or the bytes do not hold it.
  std::vector<double> try_alone(const std::vector<PlanChange>& changes, const Candidate& best, int round) {
    std::vector<std::optional<LobePlan>> changed;
    for (const PlanChange& change : changes) {
      changed.push_back(change.apply(*best.plan));
      if (changed.back() && !fits(*changed.back())) changed.back().reset();
    }
    std::vector<double> values(changes.size(), INFINITY);
    std::atomic<std::size_t> finished = 0;
    for_each_chunk(changes.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
      if (changed[k]) attempt([&] { values[k] = fit(*changed[k], &best).error; });
      const std::size_t now = ++finished;
      if (std::this_thread::get_id() != caller_) return;
      share_done_ =
          (round + 0.8 * static_cast<double>(now) / static_cast<double>(changes.size())) / kMaxRounds;
      report();
    });
    drop_failures();
    return values;
  }

  /// Uses tables of one channel if they save more than they cost; only trials in colour show that.
  void share_channels() {
    Heat colour = heat_of_plans(set_, options_.refine);
    colour.options.progress = grey_.options.progress;
    colour.options.max_iterations = 2 * kSearchSteps;
    std::vector<LobePlan> plans{result_.plan};
    for (std::size_t k = 0; k < result_.plan.factors.size(); ++k) {
      plans.push_back(result_.plan);
      plans.back().factors[k].grey = true;
    }
    std::vector<char> held(plans.size());  // true if the bytes hold the plan
    for (std::size_t k = 0; k < plans.size(); ++k) held[k] = fits(plans[k]);
    std::vector<double> values(plans.size(), INFINITY);
    for_each_chunk(plans.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
      if (!held[k]) return;
      attempt([&] {
        values[k] = colour.error_of(
            fit_plan(colour.parts.fitted, plans[k], options_.bytes, options_.texel_bytes, colour.options)
                .model);
      });
    });
    drop_failures();
    const auto best = static_cast<std::size_t>(std::ranges::min_element(values) - values.begin());
    const bool gained = values[best] < values.front() - kMinGain;
    for (std::size_t k = 1; k < plans.size(); ++k)
      result_.trials.push_back({fmt::format("one channel of {}", result_.plan.factors[k - 1].name), values[k],
                                gained && k == best});
    if (gained) result_.plan = plans[best];
  }

  /// Runs a trial and keeps its exception for drop_failures(). If the search was ended, rethrows it.
  template <class Trial>
  void attempt(const Trial& trial) {
    try {
      trial();
    } catch (...) {
      if (ended_) throw;
      const std::lock_guard lock(mutex_);
      failures_.push_back(std::current_exception());
    }
  }
  /// Ignores failed trials that threw Error; rethrows any other exception.
  void drop_failures() {
    for (const std::exception_ptr& failure : std::exchange(failures_, {})) {
      try {
        std::rethrow_exception(failure);
      } catch (const Error&) {
      }
    }
  }

  void report() {
    if (!options_.progress) return;
    try {
      options_.progress(share_done_);
    } catch (...) {
      ended_ = true;
      throw;
    }
  }

  const TrainingSet& set_;
  const SearchOptions& options_;
  Heat grey_;  ///< with the mean of the channels
  SearchResult result_;
  std::thread::id caller_ = std::this_thread::get_id();
  double share_done_ = 0;
  std::atomic<bool> ended_ = false;  ///< by the callback
  std::mutex mutex_;
  std::vector<std::exception_ptr> failures_;  ///< guarded by mutex_
};

}  // namespace

LobePlan plan_for(BrdfRef source, const TrainingSet& set, std::size_t bytes, int lobes,
                  std::size_t texel_bytes, const RefineOptions& options) {
  LobePlan best = plan_for(source, bytes, lobes, texel_bytes);
  if (source.isotropic() || lobes > 0) return best;

  // Each number of lobes is fitted to part of the grey set and judged on another part.
  Heat heat = heat_of_plans(mean_of_channels(set), options);
  const TrainingSet& fitted = heat.parts.fitted;
  const std::size_t judged_bytes = std::min(bytes, texel_bytes * fitted.size() / kJudgedPairs);
  heat.options.max_iterations = 2 * kSearchSteps;
  double least = INFINITY;
  for (int count = 2; count <= kMaxAnisotropicLobes; ++count) {
    const LobePlan plan = plan_for(source, bytes, count, texel_bytes),
                   trial = plan_for(source, judged_bytes, count, texel_bytes);
    if (!plan_fits(plan, bytes, set.channels, texel_bytes) || !plan_fits(trial, judged_bytes, 1, texel_bytes))
      continue;
    if (options.progress)
      heat.options.progress = [&, count](double f) {
        options.progress((count - 2 + f) / (kMaxAnisotropicLobes - 1));
      };
    const double value =
        heat.error_of(fit_plan(fitted, trial, judged_bytes, texel_bytes, heat.options).model);
    if (!(value < least - kMinGain)) continue;
    least = value;
    best = plan;
  }
  return best;
}

SearchResult search_plan(const TrainingSet& set, const LobePlan& start, const SearchOptions& options) {
  return PlanSearch(set, options).run(start);
}

}  // namespace burnish
