#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <iterator>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/choosing/search.h>
#include <burnish/fitting/choosing/trial_sets.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

// A trial is fitted to every kFit-th pair in few steps and judged on as many others.
constexpr std::size_t kFit = 6;
constexpr int kTrialSteps = 8;
constexpr int kMaxRounds = 2;
// A change must pay for its risk: gains below are within what another draw of pairs would give.
constexpr double kMinGain = 0.01;
// Lobes of an anisotropic source are judged by models of no more texels than there are so many pairs for.
constexpr std::size_t kJudgedPairs = 8;
constexpr int kMaxAnisotropicLobes = 4;

/// One way to change a plan; nothing where it does not apply.
struct Change {
  std::string name;
  std::function<std::optional<LobePlan>(const LobePlan&)> apply;
};

PlannedFactor* find(LobePlan& plan, const std::string& name) {
  const auto at = std::ranges::find(plan.factors, name, &PlannedFactor::name);
  return at == plan.factors.end() ? nullptr : &*at;
}

double mean_share(const LobePlan& plan) {
  double sum = 0;
  for (const PlannedFactor& f : plan.factors) sum += f.share;
  return sum / static_cast<double>(plan.factors.size());
}

// Projections that the default plans do not have. A pair stands for both directions.
std::vector<std::pair<std::string, std::vector<Projection>>> further_projections() {
  std::vector<std::pair<std::string, std::vector<Projection>>> list;
  for (const double n : {-0.5, 0.5, 2.0}) list.push_back({"t", {Projection{.wi = 1, .wo = 1, .n = n}}});
  for (const double b : {-0.5, 0.5})
    list.push_back({"t", {Projection{.wi = 1, .wo = b}, Projection{.wi = b, .wo = 1}}});
  list.push_back(
      {"t", {Projection{.wi = 1, .wo = -0.5, .n = 0.5}, Projection{.wi = -0.5, .wo = 1, .n = 0.5}}});
  return list;
}

std::vector<Change> changes_of_lobes() {
  std::vector<Change> changes;
  for (const int step : {1, -1})
    changes.push_back(
        {step > 0 ? "one lobe more" : "one lobe fewer", [step](LobePlan p) -> std::optional<LobePlan> {
           p.lobes += step;
           if (p.lobes < 1) return {};
           return p;
         }});
  return changes;
}

std::vector<Change> changes_of_factor(const std::string& name) {
  std::vector<Change> changes;
  for (const double scale : {1.5, 0.67})
    changes.push_back(
        {fmt::format("share of {} x {}", name, scale), [=](LobePlan p) -> std::optional<LobePlan> {
           PlannedFactor* f = find(p, name);
           if (!f || p.factors.size() < 2) return {};
           f->share *= scale;
           return p;
         }});
  for (const Warp warp : {Warp{}, Warp{WarpKind::power, 0.5}, Warp{WarpKind::power, 0.7},
                          Warp{WarpKind::rational, 0.1}, Warp{WarpKind::rational, -1.3}})
    changes.push_back(
        {fmt::format("{} spaced {}", name, to_string(warp)), [=](LobePlan p) -> std::optional<LobePlan> {
           PlannedFactor* f = find(p, name);
           if (!f || f->warp == warp) return {};
           f->warp = warp;
           return p;
         }});
  changes.push_back({fmt::format("one {} for all lobes", name), [=](LobePlan p) -> std::optional<LobePlan> {
                       PlannedFactor* f = find(p, name);
                       const auto own = std::ranges::count(p.factors, false, &PlannedFactor::every_lobe);
                       if (!f || f->every_lobe || p.lobes < 2 || own < 2) return {};
                       f->every_lobe = true;
                       return p;
                     }});
  changes.push_back({fmt::format("without {}", name), [=](LobePlan p) -> std::optional<LobePlan> {
                       if (p.factors.size() < 3 || !find(p, name)) return {};
                       std::erase_if(p.factors, [&](const PlannedFactor& f) { return f.name == name; });
                       return p;
                     }});
  return changes;
}

std::vector<Change> changes_by_projections() {
  std::vector<Change> changes;
  for (const auto& [name, uses] : further_projections())
    changes.push_back({fmt::format("with {}({})", name, to_string(uses.front())),
                       [added = name, along = uses](LobePlan p) -> std::optional<LobePlan> {
                         if (find(p, added)) return {};
                         p.factors.push_back({added, TableShape::line, along, 0.4 * mean_share(p), {}});
                         return p;
                       }});
  return changes;
}

std::vector<Change> changes_of_coefficients() {  // of skewed directions
  std::vector<Change> changes;
  for (const char* name : {"s", "t"})
    for (const double scale : {1.4, 0.7})
      changes.push_back(
          {fmt::format("coefficients of {} x {}", name, scale), [=](LobePlan p) -> std::optional<LobePlan> {
             PlannedFactor* f = find(p, name);
             if (!f) return {};
             if (f->uses.size() == 2) {
               f->uses[0].wo *= scale;
               f->uses[1].wi *= scale;
             } else {
               f->uses[0].n *= scale;
             }
             return p;
           }});
  return changes;
}

std::vector<Change> list_changes(const LobePlan& plan) {
  std::vector<Change> changes = changes_of_lobes();
  const auto add = [&](std::vector<Change> further) {
    std::ranges::move(further, std::back_inserter(changes));
  };
  for (const PlannedFactor& factor : plan.factors) add(changes_of_factor(factor.name));
  add(changes_by_projections());
  add(changes_of_coefficients());
  return changes;
}

/// A plan as far as it was tried.
struct Candidate {
  LobePlan plan;
  LogModel model;
  double objective = INFINITY;
};

/// The search of search_plan.
class PlanSearch {
 public:
  PlanSearch(const TrainingSet& set, const SearchOptions& options)
      : set_(set), options_(options), refinement_(options.refine) {
    const TrainingSet grey = mean_of_channels(set);
    fitted_ = part_of(grey, 0, kFit);
    judged_ = part_of(grey, kFit / 2, kFit);
    // told again at every step, so that a callback can end the search
    refinement_.progress = [this](double) {
      if (std::this_thread::get_id() == caller_) report();
    };
  }
  PlanSearch(const PlanSearch&) = delete;

  SearchResult run(const LobePlan& start) {
    Candidate best = fit(start, nullptr);
    best = fit(start, &best);  // as many steps as every change gets
    result_.trials = {{"start", best.objective, true}};
    for (int round = 0; round < kMaxRounds; ++round)
      if (!improve(round, best)) break;
    result_.plan = best.plan;
    if (set_.channels > 1) share_channels();
    share_done_ = 1;
    report();
    return std::move(result_);
  }

 private:
  bool fits(const LobePlan& plan) const {
    return plan_fits(plan, options_.bytes, set_.channels, options_.texel_bytes);
  }

  /// Where the lobes stay, a plan starts from the functions that are known. Throws Error where the bytes do not
  /// hold it.
  Candidate fit(const LobePlan& plan, const Candidate* from) const {
    Candidate result{.plan = plan, .model = {}};
    RefineOptions steps = refinement_;
    if (from && from->plan.lobes == plan.lobes) {
      steps.max_iterations = kTrialSteps;
      result.model =
          resampled(from->model, plan_to_spec(plan, options_.bytes, set_.channels, options_.texel_bytes));
      refine(result.model, fitted_, steps);
    } else {
      steps.max_iterations = 2 * kTrialSteps;
      result.model = fit_plan(fitted_, plan, options_.bytes, options_.texel_bytes, steps).model;
    }
    result.objective = objective(result.model, judged_, options_.refine.shares);
    return result;
  }

  /// One round: every change alone, then together those that pay. False where none does.
  bool improve(int round, Candidate& best) {
    const std::vector<Change> changes = list_changes(best.plan);
    const std::vector<double> values = try_alone(changes, best, round);

    // the most rewarding first
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < changes.size(); ++k)
      if (values[k] < best.objective - kMinGain) order.push_back(k);
    std::ranges::sort(order, {}, [&](std::size_t k) { return std::pair(values[k], k); });
    std::vector<bool> kept(changes.size());
    for (const std::size_t k : order) {
      const auto changed = changes[k].apply(best.plan);
      if (!changed || !fits(*changed)) continue;
      Candidate next;
      attempt([&] { next = fit(*changed, &best); });
      drop_failures();
      kept[k] = next.objective < best.objective - kMinGain;
      if (kept[k]) best = std::move(next);
    }
    for (std::size_t k = 0; k < changes.size(); ++k)
      if (values[k] < INFINITY) result_.trials.push_back({changes[k].name, values[k], kept[k]});
    return std::ranges::any_of(kept, [](bool b) { return b; });
  }

  /// The objective of each change, infinite where it does not apply or the bytes do not hold it.
  std::vector<double> try_alone(const std::vector<Change>& changes, const Candidate& best, int round) {
    std::vector<std::optional<LobePlan>> changed;
    for (const Change& change : changes) {
      changed.push_back(change.apply(best.plan));
      if (changed.back() && !fits(*changed.back())) changed.back().reset();
    }
    std::vector<double> values(changes.size(), INFINITY);
    std::atomic<std::size_t> finished = 0;
    for_each_chunk(changes.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
      if (changed[k]) attempt([&] { values[k] = fit(*changed[k], &best).objective; });
      const std::size_t now = ++finished;
      if (std::this_thread::get_id() != caller_) return;
      share_done_ =
          (round + 0.8 * static_cast<double>(now) / static_cast<double>(changes.size())) / kMaxRounds;
      report();
    });
    drop_failures();
    return values;
  }

  /// Keeps tables of one channel where those cost less than they save; only the colours can tell.
  void share_channels() {
    const TrainingSet fitted = part_of(set_, 0, kFit), judged = part_of(set_, kFit / 2, kFit);
    RefineOptions steps = refinement_;
    steps.max_iterations = 2 * kTrialSteps;
    std::vector<LobePlan> plans{result_.plan};
    for (std::size_t k = 0; k < result_.plan.factors.size(); ++k) {
      plans.push_back(result_.plan);
      plans.back().factors[k].grey = true;
    }
    std::vector<char> held(plans.size());  // by the bytes
    for (std::size_t k = 0; k < plans.size(); ++k) held[k] = fits(plans[k]);
    std::vector<double> values(plans.size(), INFINITY);
    for_each_chunk(plans.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
      if (!held[k]) return;
      attempt([&] {
        const LobesFit fit = fit_plan(fitted, plans[k], options_.bytes, options_.texel_bytes, steps);
        values[k] = objective(fit.model, judged, options_.refine.shares);
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

  /// Keeps what a trial throws for drop_failures(), unless it is what ends the search.
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
  /// Trials that have no solution are none; rethrows what is no Error.
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
  RefineOptions refinement_;
  TrainingSet fitted_, judged_;  ///< grey
  SearchResult result_;
  std::thread::id caller_ = std::this_thread::get_id();
  double share_done_ = 0;
  std::atomic<bool> ended_ = false;  ///< by the callback
  std::mutex mutex_;
  std::vector<std::exception_ptr> failures_;  ///< guarded by it
};

}  // namespace

LobePlan plan_for(BrdfRef source, const TrainingSet& set, std::size_t bytes, int lobes,
                  std::size_t texel_bytes, const RefineOptions& options) {
  LobePlan best = plan_for(source, bytes, lobes, texel_bytes);
  if (source.isotropic() || lobes > 0) return best;

  // each number of lobes, fitted to part of the grey set and judged on another
  const TrainingSet grey = mean_of_channels(set);
  const TrainingSet fitted = part_of(grey, 0, kFit), judged = part_of(grey, kFit / 2, kFit);
  const std::size_t judged_bytes = std::min(bytes, texel_bytes * fitted.size() / kJudgedPairs);
  RefineOptions steps = options;
  steps.max_iterations = 2 * kTrialSteps;
  double least = INFINITY;
  for (int count = 2; count <= kMaxAnisotropicLobes; ++count) {
    const LobePlan plan = plan_for(source, bytes, count, texel_bytes),
                   trial = plan_for(source, judged_bytes, count, texel_bytes);
    if (!plan_fits(plan, bytes, set.channels, texel_bytes) || !plan_fits(trial, judged_bytes, 1, texel_bytes))
      continue;
    if (options.progress)
      steps.progress = [&, count](double f) {
        options.progress((count - 2 + f) / (kMaxAnisotropicLobes - 1));
      };
    const LobesFit fit = fit_plan(fitted, trial, judged_bytes, texel_bytes, steps);
    const double value = objective(fit.model, judged, options.shares);
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
