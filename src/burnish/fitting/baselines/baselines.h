// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <burnish/baselines/baseline_file.h>
#include <burnish/fitting/fit_summary.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

/// The methods of others: "svd", "nd", "nmf", "dgf", and "analytic:" with one of fittable_models().
std::span<const std::string_view> baseline_methods();

struct BaselineOptions {
  std::size_t budget = 2640;  ///< bytes; analytic models take less
  std::uint64_t seed = 1;
  std::function<void(double fraction)> progress = {};  ///< called with rising shares of the work
};

/// A fitted baseline and how that went.
struct BaselineFit {
  std::string method;  ///< as baseline_methods() writes it
  BaselineBrdf brdf;
  std::optional<std::size_t> layouts_tried;  ///< of decompositions, see SeparableFit
  std::optional<FitSummary> summary;         ///< of the others, see DgfFit and AnalyticFit
  std::optional<int> starts;                 ///< of analytic models
};

/// Fits one baseline. Decompositions resample `source`; the others take `samples` of it. Both should be
/// symmetrized: every baseline is reciprocal. A '-' in a model's name stands for '_'. Throws Error for
/// another method, and as fit_separable, fit_dgf and fit_analytic.
BaselineFit fit_baseline(BrdfRef source, const SampleSource& samples, std::string_view method,
                         const BaselineOptions& options);

}  // namespace burnish
