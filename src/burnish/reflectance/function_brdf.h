// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <span>

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// A function of one's own as a Brdf, for sources that are no file. Evaluation allocates. Copies share the function.
class FunctionBrdf {
 public:
  /// Writes f_r in 1/sr of every pair, channel fastest, each finite and at least 0. Both directions of every pair lie
  /// above the horizon. Called from several threads at a time, of one pair or of thousands.
  /// It may throw: pairs are unknown then, and it is not called again before `rethrow_since` has thrown what it threw.
  /// Loops in threads inside it take up no work from outside it.
  using Function = std::function<void(std::span<const DirectionPair> pairs, std::span<double> values)>;

  /// Throws Error without a function, and for other than 1 to SymmetrizedBrdf::kMaxChannels channels.
  FunctionBrdf(std::size_t channels, bool isotropic, Function function);

  std::size_t channels() const noexcept { return channels_; }
  bool isotropic() const noexcept { return isotropic_; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
  void eval(std::span<const DirectionPair> pairs, std::span<double> values,
            std::span<std::uint8_t> known) const noexcept;

  /// Returns how many calls of the function have thrown so far.
  std::size_t failures() const noexcept;
  /// Throws what the function threw last, once, if calls have thrown since `failures` was `count`; Error where another
  /// caller has had it. Whoever evaluates a source asks before and after, since evaluation itself never throws.
  void rethrow_since(std::size_t count) const;

 private:
  struct State;

  bool fill(std::span<const DirectionPair> pairs, std::span<double> values) const noexcept;

  std::size_t channels_;
  bool isotropic_;
  std::shared_ptr<State> state_;
};

static_assert(SpanBrdf<FunctionBrdf>);

}  // namespace burnish
