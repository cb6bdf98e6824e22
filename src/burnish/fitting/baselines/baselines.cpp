#include <algorithm>
#include <array>
#include <chrono>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/fitting/baselines/analytic_fit.h>
#include <burnish/fitting/baselines/baselines.h>
#include <burnish/fitting/baselines/dgf_fit.h>
#include <burnish/fitting/baselines/separable_fit.h>

namespace burnish {

namespace {

using Json = nlohmann::ordered_json;

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

Baseline fit(BrdfRef source, const SampleSource& samples, const std::string& method,
             const BaselineOptions& options) {
  for (const Decomposition d : {Decomposition::svd, Decomposition::nd, Decomposition::nmf})
    if (method == to_string(d)) {
      SeparableFit fit = fit_separable(
          source, d, {.budget = options.budget, .seed = options.seed, .progress = options.progress});
      return {method, std::move(fit.brdf), Json{{"layouts_tried", fit.tried}}.dump()};
    }
  if (method == "dgf") {
    DgfFit fit = fit_dgf(samples, {.budget = options.budget, .progress = options.progress});
    return {method, std::move(fit.brdf),
            Json{{"error_before", fit.error_before}, {"error_after", fit.error_after}}.dump()};
  }
  AnalyticFit fit = fit_analytic(samples, std::string_view(method).substr(kAnalytic.size()),
                                 {.progress = options.progress});
  return {"analytic", std::move(fit.brdf),
          Json{{"error_before", fit.error_before},
               {"error_after", fit.error_after},
               {"starts", fit.starts},
               {"iterations", fit.iterations},
               {"stop_reason", fit.stop_reason}}
              .dump()};
}

}  // namespace

std::span<const std::string_view> baseline_methods() {
  return kMethods;
}

BaselineFit fit_baseline(BrdfRef source, const SampleSource& samples, std::string_view method,
                         const BaselineOptions& options) {
  std::string name(method);
  std::replace(name.begin(), name.end(), '-', '_');
  if (std::find(kMethods.begin(), kMethods.end(), name) == kMethods.end())
    throw Error(fmt::format("method: expected one of {}, found '{}'", fmt::join(kMethods, ", "), method));
  const auto start = std::chrono::steady_clock::now();
  BaselineFit result{name, fit(source, samples, name, options)};
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.bytes = baseline_bytes(result.baseline.brdf);
  result.cost = evaluation_cost(result.baseline.brdf);
  return result;
}

}  // namespace burnish
