// SPDX-License-Identifier: Apache-2.0
#include "evaluation_times.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish::reports {

PairSet::PairSet(std::size_t count) : pairs_(draw_pairs(count, 1, false)) {
  for (auto& [wi, wo] : pairs_) {
    double* const values[] = {&wi.x, &wi.y, &wi.z, &wo.x, &wo.y, &wo.z};
    for (std::size_t k = 0; k < components_.size(); ++k) {
      components_[k].push_back(static_cast<float>(*values[k]));
      *values[k] = static_cast<double>(components_[k].back());
    }
  }
}

DirectionSpans PairSet::spans() const noexcept {
  return {components_[0], components_[1], components_[2], components_[3], components_[4], components_[5]};
}

std::function<void()> one_by_one(const PairSet& set, BrdfRef eval) {
  return [&set, eval] {
    std::array<double, 3> f{};
    for (const auto& [wi, wo] : set.pairs()) {
      eval.eval(wi, wo, f);
      [[maybe_unused]] volatile double used = f[0] + f[1] + f[2];
    }
  };
}

std::function<void()> batched(const std::string& name, const PairSet& set, const SpanEval& eval,
                              BrdfRef truth, double bound) {
  const auto values = std::make_shared<std::vector<float>>(3 * set.pairs().size());
  eval(set.spans(), *values);
  constexpr std::size_t kChecked = 4096;
  const std::size_t plane = set.pairs().size(), checked = std::min(plane, kChecked);
  double error = 0;
  for (std::size_t i = 0; i < checked; ++i) {
    std::array<double, 3> expected{};
    truth.eval(set.pairs()[i].wi, set.pairs()[i].wo, expected);
    for (std::size_t c = 0; c < expected.size(); ++c)
      error += std::abs(static_cast<double>((*values)[c * plane + i]) - expected[c]) / (expected[c] + 1e-6);
  }
  error /= static_cast<double>(3 * checked);
  if (!(error <= bound))
    throw Error(
        fmt::format("{}: expected values within {:.2g}, found an error of {:.2g}", name, bound, error));
  return [&set, eval, values] { eval(set.spans(), *values); };
}

}  // namespace burnish::reports
