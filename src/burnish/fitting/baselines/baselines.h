#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <burnish/baselines/baseline_file.h>
#include <burnish/baselines/evaluation_cost.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

/// What others would do: "svd", "nd", "nmf", "dgf", and "analytic:" with one of fittable_models().
std::span<const std::string_view> baseline_methods();

struct BaselineOptions {
  std::size_t budget = 2640;  ///< bytes; analytic models take less
  std::uint64_t seed = 1;
  std::function<void(double fraction)> progress = {};  ///< called with rising shares of the work
};

/// A fitted baseline and what it costs.
struct BaselineFit {
  std::string method;
  Baseline baseline;  ///< its notes say how the fit went
  std::size_t bytes = 0;
  double seconds = 0;                  ///< of the fit, by the wall clock
  std::optional<EvaluationCost> cost;  ///< nothing for analytic models
};

/// Fits one baseline. Decompositions resample `source`; the others take `samples` of it. Both should be
/// symmetrized: every baseline is reciprocal. A '-' in a model's name stands for '_'. Throws Error for
/// another method, and as fit_separable, fit_dgf and fit_analytic.
BaselineFit fit_baseline(BrdfRef source, const SampleSource& samples, std::string_view method,
                         const BaselineOptions& options);

}  // namespace burnish
