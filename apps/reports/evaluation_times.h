// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <burnish/eval/factored_eval.h>
#include <burnish/reflectance/brdf.h>

namespace burnish::reports {

/// Random pairs of directions above the horizon in both forms, with the same numbers: floats.
class PairSet {
 public:
  explicit PairSet(std::size_t count);

  std::span<const DirectionPair> pairs() const noexcept { return pairs_; }
  DirectionSpans spans() const noexcept;

 private:
  std::vector<DirectionPair> pairs_;
  std::array<std::vector<float>, 6> components_;
};

/// Returns a function that evaluates all pairs one by one through a BrdfRef. A renderer does so too, since it does not
/// know the type. `set` and the referent of `eval` must outlive the function.
std::function<void()> one_by_one(const PairSet& set, BrdfRef eval);

/// Returns the same function, which also keeps `eval` alive.
template <Brdf Eval>
std::function<void()> one_by_one(const PairSet& set, std::shared_ptr<const Eval> eval) {
  return [run = one_by_one(set, BrdfRef(*eval)), eval] { run(); };
}

/// Evaluates many pairs at once into three planes, as FactoredEvaluator does.
using SpanEval = std::function<void(const DirectionSpans& directions, std::span<float> f)>;

/// Returns a function that evaluates all pairs at once. Throws Error, with the name, where the mean relative error of
/// the values against the truth exceeds the bound. `set` must outlive the function.
std::function<void()> batched(const std::string& name, const PairSet& set, const SpanEval& eval,
                              BrdfRef truth, double bound);

}  // namespace burnish::reports
