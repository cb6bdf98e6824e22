// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include <burnish/math/vec3.h>

namespace burnish {

/// Two directions of the local frame: wi to the light, wo to the viewer.
struct DirectionPair {
  Vec3 wi, wo;

  friend constexpr bool operator==(const DirectionPair&, const DirectionPair&) = default;
};

/// The concept of every reflectance of this library: a plain value with
/// - channels(): how many values a direction pair has: 1, 3 (linear Rec. 709) or a count of wavelengths;
/// - isotropic(): true where rotating both directions about the normal changes nothing;
/// - eval(wi, wo, f): writes f_r in 1/sr without the cosine into f (size channels()). Returns false, and
///   writes zeros, where the source knows nothing: a hole in a measurement, a direction outside its coverage.
///   Below the horizon (wi.z <= 0 or wo.z <= 0) it writes zeros and returns true. Never throws, nor allocates but in
///   the first call of a ScatteredBrdf; values are finite and, except for sources kept raw on request, >= 0.
/// A source that holds negative values, the noise of a measurement about small ones, also has
/// - eval_raw(wi, wo, f): the same with negative results as they are. eval sets these to zero, and nothing that is
///   interpolated or averaged is cut before.
// clang-format off
template <class T>
concept Brdf = requires(const T& brdf, Vec3 w, std::span<double> f) {
  { brdf.channels() } noexcept -> std::convertible_to<std::size_t>;
  { brdf.isotropic() } noexcept -> std::convertible_to<bool>;
  { brdf.eval(w, w, f) } noexcept -> std::same_as<bool>;
};

template <class T>
concept HasRawValues = Brdf<T> && requires(const T& brdf, Vec3 w, std::span<double> f) {
  { brdf.eval_raw(w, w, f) } noexcept -> std::same_as<bool>;
};
// clang-format on

/// Sets values below zero to zero, as the owners of measured formats do with what they interpolated.
inline void cut_negatives(std::span<double> f) noexcept {
  for (double& value : f) value = value < 0 ? 0 : value;
}

/// A Brdf that evaluates many pairs at a time, faster than one after the other.
// clang-format off
template <class T>
concept SpanBrdf = Brdf<T> && requires(const T& brdf, std::span<const DirectionPair> pairs,
                                       std::span<double> values, std::span<std::uint8_t> known) {
  { brdf.eval(pairs, values, known) } noexcept;
};
// clang-format on

/// A non-owning reference to any Brdf. A span pays the indirection once, not once for each direction.
class BrdfRef {
 public:
  // clang-format off
  template <Brdf T>
    requires(!std::same_as<T, BrdfRef>)
  BrdfRef(const T& brdf) noexcept  // NOLINT: implicit like std::span
      : brdf_(&brdf), channels_(static_cast<std::size_t>(brdf.channels())), isotropic_(brdf.isotropic()),
        eval_one_(&eval_one<T, false>), raw_one_(&eval_one<T, HasRawValues<T>>),
        eval_span_(&eval_span<T, false>), raw_span_(&eval_span<T, HasRawValues<T>>) {
    if constexpr (requires { brdf.reciprocal(); }) reciprocal_ = brdf.reciprocal();
  }
  // clang-format on

  std::size_t channels() const noexcept { return channels_; }
  bool isotropic() const noexcept { return isotropic_; }
  /// True where the source says that exchanged directions give the same bits.
  bool reciprocal() const noexcept { return reciprocal_; }

  /// The same BRDF with eval_raw in the place of eval where it has one: for means, whose noise then cancels.
  BrdfRef unclamped() const noexcept {
    BrdfRef raw = *this;
    raw.eval_one_ = raw_one_;
    raw.eval_span_ = raw_span_;
    return raw;
  }

  /// One pair; see Brdf.
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept { return eval_one_(brdf_, wi, wo, f); }

  /// Many pairs: `values` has pairs.size() * channels() entries, channel fastest; `known` one flag a pair.
  void eval(std::span<const DirectionPair> pairs, std::span<double> values,
            std::span<std::uint8_t> known) const noexcept {
    eval_span_(brdf_, pairs, values, known);
  }

 private:
  using EvalOne = bool(const void*, const Vec3&, const Vec3&, std::span<double>) noexcept;
  using EvalSpan = void(const void*, std::span<const DirectionPair>, std::span<double>,
                        std::span<std::uint8_t>) noexcept;

  template <Brdf T, bool raw>
  static bool eval_one(const void* brdf, const Vec3& wi, const Vec3& wo, std::span<double> f) noexcept {
    const T& concrete = *static_cast<const T*>(brdf);
    if constexpr (raw)
      return concrete.eval_raw(wi, wo, f);
    else
      return concrete.eval(wi, wo, f);
  }
  template <Brdf T, bool raw>
  static void eval_span(const void* brdf, std::span<const DirectionPair> pairs, std::span<double> values,
                        std::span<std::uint8_t> known) noexcept {
    const T& concrete = *static_cast<const T*>(brdf);
    const auto channels = concrete.channels();
    const auto each = [&](const auto& eval) {
      for (std::size_t i = 0; i < pairs.size(); ++i)
        known[i] = eval(pairs[i].wi, pairs[i].wo, values.subspan(i * channels, channels));
    };
    if constexpr (!raw && SpanBrdf<T>) {
      concrete.eval(pairs, values, known);
    } else if constexpr (raw && requires { concrete.eval_raw(pairs, values, known); }) {
      concrete.eval_raw(pairs, values, known);
    } else if constexpr (raw) {
      each([&](Vec3 wi, Vec3 wo, std::span<double> f) { return concrete.eval_raw(wi, wo, f); });
    } else {
      each([&](Vec3 wi, Vec3 wo, std::span<double> f) { return concrete.eval(wi, wo, f); });
    }
  }

  const void* brdf_;
  std::size_t channels_;
  bool isotropic_, reciprocal_ = false;
  EvalOne* eval_one_;
  EvalOne* raw_one_;
  EvalSpan* eval_span_;
  EvalSpan* raw_span_;
};

static_assert(SpanBrdf<BrdfRef>);

/// The reciprocal part of a source, 1/2 [f(wi, wo) + f(wo, wi)]; where only one of the two is known, that
/// one. Measured tables are seldom exactly reciprocal, exactly reciprocal models are fitted to and scored
/// against this. Both orders are cut at zero before they are averaged, as the source's owner evaluates them;
/// raw values average raw ones. A source that says it is reciprocal is evaluated once. Channels: at most
/// kMaxChannels.
class SymmetrizedBrdf {
 public:
  static constexpr std::size_t kMaxChannels = 1024;

  explicit SymmetrizedBrdf(BrdfRef source);

  std::size_t channels() const noexcept { return source_.channels(); }
  bool isotropic() const noexcept { return source_.isotropic(); }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
  bool eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
  void eval(std::span<const DirectionPair> pairs, std::span<double> values,
            std::span<std::uint8_t> known) const noexcept;
  void eval_raw(std::span<const DirectionPair> pairs, std::span<double> values,
                std::span<std::uint8_t> known) const noexcept;

 private:
  BrdfRef source_;
};

static_assert(HasRawValues<SymmetrizedBrdf> && SpanBrdf<SymmetrizedBrdf>);

}  // namespace burnish
