// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/error.h>
#include <burnish/fitting/baselines/analytic_fit.h>
#include <burnish/fitting/baselines/baselines.h>
#include <burnish/fitting/baselines/dgf_fit.h>
#include <burnish/fitting/baselines/separable_fit.h>
#include <burnish/math/closest_name.h>

namespace burnish {

namespace {

constexpr std::array<std::string_view, 9> kMethods = {"svd",
                                                      "nd",
                                                      "nmf",
                                                      "dgf",
                                                      "analytic:cook_torrance",
                                                      "analytic:ggx",
                                                      "analytic:ward",
                                                      "analytic:ashikhmin_shirley",
                                                      "analytic:lafortune"};
constexpr std::string_view kAnalytic = "analytic:";

}  // namespace

std::span<const std::string_view> baseline_methods() {
  return kMethods;
}

BaselineFit fit_baseline(BrdfRef source, const SampleSource& samples, std::string_view method,
                         const BaselineOptions& options) {
  std::string name(method);
  std::replace(name.begin(), name.end(), '-', '_');
  if (std::find(kMethods.begin(), kMethods.end(), name) == kMethods.end())
    throw Error(fmt::format("method: expected one of {}, found '{}'{}", fmt::join(kMethods, ", "), method,
                            did_you_mean(name, kMethods)));

  for (const Decomposition d : {Decomposition::svd, Decomposition::nd, Decomposition::nmf})
    if (name == to_string(d)) {
      SeparableFit fit = fit_separable(
          source, d, {.budget = options.budget, .seed = options.seed, .progress = options.progress});
      return {.method = name,
              .brdf = std::move(fit.brdf),
              .layouts_tried = fit.tried,
              .summary = {},
              .starts = {}};
    }
  if (name == "dgf") {
    DgfFit fit = fit_dgf(samples, {.budget = options.budget, .progress = options.progress});
    return {.method = name,
            .brdf = std::move(fit.brdf),
            .layouts_tried = {},
            .summary = fit.summary,
            .starts = {}};
  }
  AnalyticFit fit =
      fit_analytic(samples, std::string_view(name).substr(kAnalytic.size()), {.progress = options.progress});
  return {.method = name,
          .brdf = std::move(fit.brdf),
          .layouts_tried = {},
          .summary = fit.summary,
          .starts = fit.starts};
}

}  // namespace burnish
