// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/factors/factored_brdf.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

/// A weighted sum of errors and of its weights.
struct ErrorSum {
  double error = 0, weight = 0;

  double mean() const noexcept { return error / weight; }
};

/// Sum over samples above the horizon and channels of weight * |log((max(f, 0) + floor) / (model + floor))|;
/// floor > 0. Independent of the number of threads.
ErrorSum log_error(const SampleSource& source, const FactoredBrdf& model, double floor);

}  // namespace burnish
