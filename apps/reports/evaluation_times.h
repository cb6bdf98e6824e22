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

/// Random pairs of directions above the horizon, each in both forms, the same numbers: floats.
class PairSet {
 public:
  explicit PairSet(std::size_t count);

  std::span<const DirectionPair> pairs() const noexcept { return pairs_; }
  DirectionSpans spans() const noexcept;

 private:
  std::vector<DirectionPair> pairs_;
  std::array<std::vector<float>, 6> components_;
};

/// Evaluates all pairs one by one as a renderer does, which knows no type, only a BrdfRef. `set` and what `eval` refers to
/// must outlive what is returned.
std::function<void()> one_by_one(const PairSet& set, BrdfRef eval);

/// The same, and keeps what evaluates.
template <Brdf Eval>
std::function<void()> one_by_one(const PairSet& set, std::shared_ptr<const Eval> eval) {
  return [run = one_by_one(set, BrdfRef(*eval)), eval] { run(); };
}

/// Evaluates many pairs at once into three planes, as FactoredEvaluator does.
using SpanEval = std::function<void(const DirectionSpans& directions, std::span<float> f)>;

/// The same for all pairs. Throws Error, with the name, where the mean relative error of the values against the
/// truth is above the bound. `set` must outlive what is returned.
std::function<void()> batched(const std::string& name, const PairSet& set, const SpanEval& eval,
                              BrdfRef truth, double bound);

}  // namespace burnish::reports
