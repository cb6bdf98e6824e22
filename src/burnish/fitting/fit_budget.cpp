// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/choosing/budget_ladder.h>
#include <burnish/fitting/choosing/order_tables.h>
#include <burnish/fitting/fit_budget.h>
#include <burnish/fitting/fit_one.h>
#include <burnish/fitting/fit_within.h>
#include <burnish/fitting/one_lobe/cross_validation.h>

namespace burnish {

namespace {

// The fetches of DefaultBudget.
constexpr int kIsotropicFetches = 2, kAnisotropicFetches = 6;

void check(const Budget& budget) {
  if (budget.bytes && (*budget.bytes == 0 || *budget.bytes > kMaxBudget))
    throw Error(fmt::format("fit: expected a budget of 1 to {} bytes, found {}", kMaxBudget, *budget.bytes));
  if (budget.fetches.value_or(1) < 1)
    throw Error(fmt::format("fit: expected at least one fetch, found {}", *budget.fetches));
  if (budget.lobes.value_or(1) < 1)
    throw Error(fmt::format("fit: expected at least one lobe, found {}", *budget.lobes));
  if (budget.fetches && (budget.lobes || budget.search))
    throw Error("fit: expected no number of lobes and no search with fetches, found one");
}

FittedModel model_of(FittedLobe fitted) {
  return {.brdf = std::move(fitted.brdf), .how = std::move(fitted.report)};
}
FittedModel model_of(FittedLobes fitted) {
  return {.brdf = std::move(fitted.brdf), .how = std::move(fitted.report)};
}

/// Fits models within a number of bytes.
class BudgetFitter {
 public:
  /// `usual`: no option gave a number of fetches, so they are those of DefaultBudget.
  BudgetFitter(const FittedSource& source, const FitOptions& options, const Budget& budget, bool usual,
               const Stages& stages)
      : source_(source), options_(options), budget_(budget), usual_(usual), stages_(stages) {
    if (usual) budget_.fetches = source.isotropic() ? kIsotropicFetches : kAnisotropicFetches;
  }

  FittedModel run() const { return budget_.bytes ? fit_to(*budget_.bytes, stages_) : fit_to_noise(); }

 private:
  FittedModel fit_to(std::uint64_t bytes, const Stages& stages) const {
    // Few scattered samples do not determine several lobes.
    if (source_.scattered()) return fit_samples_to(bytes, stages);
    const WithinBytes within(source_, options_, budget_, bytes, stages);
    if (!budget_.fetches) {
      within.check();
      return model_of(takes_knee() ? within.fit_at_knee() : within.fit_lobes());
    }
    return model_of(source_.judged_at_nodes() && usual_ ? within.fit_nodes()
                                                        : within.fit_with(*budget_.fetches));
  }

  FittedModel fit_samples_to(std::uint64_t bytes, const Stages& stages) const {
    return model_of(fit_scattered(source_, options_, budget_.scattered, bytes,
                                  usual_ ? std::nullopt : budget_.fetches, stages));
  }

  /// True if the library chooses the number of fetches. If the order of the directions matters, it does not: lobes
  /// share a table of wi and then fit better than the models of the trials.
  bool takes_knee() const {
    return !budget_.fetches && !budget_.lobes && !budget_.search && !order_matters(source_.reference());
  }

  /// Tries more and more bytes, until the model's error is no larger than the measurement's, or more bytes hardly
  /// help.
  FittedModel fit_to_noise() const {
    if (source_.scattered() && source_.samples()->size() <= kManySamples) {
      FittedModel model = fit_samples_to(kBudgetLadder.back(), stages_);
      model.budget_choice = {.bytes = std::get<FactoredBrdf>(model.brdf).bytes(),
                             .stop = BudgetStop::cross_validation};
      return model;
    }
    const NoiseScale scale = source_.noise_scale();
    BudgetChoice choice{.noise = scale.noise()};
    std::optional<FittedModel> best;
    for (const std::uint64_t bytes : kBudgetLadder) {
      const Stages stages = stages_.with(fmt::format(" to {} bytes", bytes));
      if (!source_.scattered() && !WithinBytes(source_, options_, budget_, bytes, stages).holds()) continue;
      FittedModel next = fit_to(bytes, stages);
      const ErrorLevel error = scale.error_of(std::get<FactoredBrdf>(next.brdf));
      choice.trials.push_back({.bytes = bytes, .error = error, .excess = scale.excess(error)});
      const auto stop = stop_after(choice.trials, scale.noise().has_value());
      if (stop != BudgetStop::gain) {
        best = std::move(next);
        choice.bytes = bytes;
      }
      if (!stop) continue;
      choice.stop = *stop;
      break;
    }
    if (!best) return fit_to(kBudgetLadder.back(), stages_);  // its error names the least bytes
    best->budget_choice = std::move(choice);
    return *std::move(best);
  }

  const FittedSource& source_;
  const FitOptions& options_;
  Budget budget_;
  bool usual_;
  const Stages& stages_;
};

}  // namespace

FittedModel fit_budget(const FittedSource& source, const FitOptions& options, const Budget& budget,
                       const Stages& stages) {
  check(budget);
  const bool usual = !budget.bytes && !budget.fetches && !budget.lobes && !budget.search;
  return BudgetFitter(source, options, budget, usual, stages).run();
}

FittedModel fit_budget(const FittedSource& source, const FitOptions& options, const DefaultBudget& budget,
                       const Stages& stages) {
  const Budget bytes{.bytes = kDefaultBudget, .loss = budget.loss, .scattered = budget.scattered};
  return BudgetFitter(source, options, bytes, true, stages).run();
}

}  // namespace burnish
