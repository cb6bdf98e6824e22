// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <burnish/error.h>
#include <burnish/eval/factored_eval.h>
#include <burnish/eval/tabulated_sampler.h>
#include <burnish/reflectance/kriged_nodes.h>
#include <burnish/source.h>

#include "module.h"

namespace burnish::python {

/// burnish.Source: an opened BRDF, and objects that are made from it at their first use. It never moves, so references
/// into it hold. It never changes, so threads may share it.
class OpenedBrdf {
 public:
  explicit OpenedBrdf(Source source) : source_(std::move(source)) {}
  virtual ~OpenedBrdf() = default;
  OpenedBrdf(const OpenedBrdf&) = delete;

  const Source& source() const noexcept { return source_; }
  BrdfRef ref() const noexcept { return source_.ref(); }
  /// Returns the model, or nullptr where the source is none.
  const FactoredBrdf* model() const noexcept { return std::get_if<FactoredBrdf>(&source_.brdf); }

  /// Returns the user's own function, or nullptr where the source is none.
  const FunctionBrdf* function() const noexcept { return std::get_if<FunctionBrdf>(&source_.brdf); }

  /// Throws the exception that a user's function raises.
  const TabulatedSampler& sampler() const;
  /// Returns the function that knows a measurement's errors, made at the first call. Throws Error, naming the source,
  /// where it is no measurement or has no node far enough above the horizon.
  const KrigedNodes& uncertain() const;
  /// Requires a model.
  const FactoredEvaluator& evaluator() const {
    std::call_once(evaluator_made_, [&] { evaluator_.emplace(*model()); });
    return *evaluator_;
  }

 private:
  Source source_;
  mutable std::once_flag sampler_made_, evaluator_made_, uncertain_made_;
  mutable std::optional<TabulatedSampler> sampler_;
  mutable std::optional<FactoredEvaluator> evaluator_;
  mutable std::unique_ptr<const KrigedNodes> uncertain_;
};

/// Keeps exceptions of users' functions, since evaluation never throws. rethrow() throws those raised after the
/// construction.
class FunctionWatch {
 public:
  explicit FunctionWatch(std::initializer_list<const OpenedBrdf*> sources) {
    for (const OpenedBrdf* source : sources) add(*source);
  }
  void add(const OpenedBrdf& source) {
    if (const FunctionBrdf* function = source.function())
      watched_.push_back({function, function->failures()});
  }
  void rethrow() const {
    for (const auto& [function, failures] : watched_) function->rethrow_since(failures);
  }

 private:
  std::vector<std::pair<const FunctionBrdf*, std::size_t>> watched_;
};

/// Returns the result of `body`, run without the GIL. An exception that a user's function raised meanwhile is rethrown.
/// It replaces an Error that it may have caused.
template <class Body>
auto without_gil(const FunctionWatch& watch, const Body& body) {
  const nb::gil_scoped_release released;
  const auto run = [&] {
    try {
      return body();
    } catch (const Error&) {
      watch.rethrow();
      throw;
    }
  };
  if constexpr (std::is_void_v<decltype(body())>) {
    run();
    watch.rethrow();
  } else {
    auto result = run();
    watch.rethrow();
    return result;
  }
}

/// burnish.Model: a source whose BRDF is factored.
class OpenedModel : public OpenedBrdf {
 public:
  OpenedModel(const std::string& name, Model model) : OpenedBrdf(to_source(name, std::move(model))) {}
  explicit OpenedModel(Source source) : OpenedBrdf(std::move(source)) {}

  const FactoredBrdf& brdf() const noexcept { return *model(); }
};

/// burnish.Baseline: a fit by another method.
class OpenedBaseline : public OpenedBrdf {
 public:
  OpenedBaseline(const std::string& name, Baseline baseline)
      : OpenedBrdf(to_source(name, baseline)), baseline_(std::move(baseline)) {}

  const Baseline& baseline() const noexcept { return baseline_; }

 private:
  Baseline baseline_;
};

/// Returns the native model for writing.
inline Model to_model(const OpenedModel& opened) {
  return to_model(opened.source());
}

/// A BRDF made reciprocal, unless it is so by construction or `symmetrize` is false.
class Reciprocal {
 public:
  Reciprocal(const OpenedBrdf& opened, bool symmetrize) : opened_(opened) {
    if (symmetrize && !(opened.model() && opened.model()->reciprocal())) symmetrized_.emplace(opened.ref());
  }
  Reciprocal(const Reciprocal&) = delete;

  BrdfRef ref() const noexcept { return symmetrized_ ? BrdfRef(*symmetrized_) : opened_.ref(); }
  const OpenedBrdf& opened() const noexcept { return opened_; }

 private:
  const OpenedBrdf& opened_;
  std::optional<SymmetrizedBrdf> symmetrized_;
};

}  // namespace burnish::python
