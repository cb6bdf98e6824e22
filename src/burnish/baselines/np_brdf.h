// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <burnish/baselines/np_decoder.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// A material as seven numbers, decoded by a network that many materials share [Zheng 2021]. The decoder's
/// inputs are (1 + cos 2 phi_d) / 2, (1 + sin 2 phi_d) / 2, theta_h and theta_d over pi/2, and the code; an
/// output y stands for f_r = g(g(g(g(0.15 y)))) with g(x) = exp(x) - 1, or for f_r times the cosine.
/// Isotropic, three channels (linear Rec. 709), >= 0, reciprocal to the last bit; not its own mirror image.
class NpBrdf {
 public:
  static constexpr std::size_t kCode = NpDecoder::kInputs - 4;
  using Code = std::array<float, kCode>;
  /// The meaning of a decoded value. A reciprocal network cannot know which of the two cosines a value was multiplied
  /// by: `with_cosine` is divided by their mean, at least kMinCosine.
  enum class Value { reflectance, with_cosine };
  static constexpr double kMinCosine = 0.02;

  /// Throws Error unless the code's numbers are within NpDecoder::kMaxWeight of 0. `decoder` is one.
  NpBrdf(std::shared_ptr<const NpDecoder> decoder, const Code& code, Value value);

  static constexpr std::size_t channels() noexcept { return NpDecoder::kOutputs; }
  static constexpr bool isotropic() noexcept { return true; }
  static constexpr bool reciprocal() noexcept { return true; }
  /// One pair takes as long as 32 of a span.
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
  void eval(std::span<const DirectionPair> pairs, std::span<double> values,
            std::span<std::uint8_t> known) const noexcept;

  const Code& code() const noexcept { return code_; }
  Value value() const noexcept { return value_; }
  /// Returns the bytes of the code; NpDecoder::bytes() more are shared.
  static constexpr std::size_t bytes() noexcept { return sizeof(Code); }

 private:
  std::shared_ptr<const NpDecoder> decoder_;
  Code code_;
  Value value_;
};

static_assert(SpanBrdf<NpBrdf>);

}  // namespace burnish
