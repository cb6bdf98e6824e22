// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <burnish/baselines/np_brdf.h>
#include <burnish/error.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

// Exchanged directions negate half their difference, and with it both coordinates across the half vector, to
// the last bit: cosine and sine of twice the azimuth stay.
NpDecoder::Inputs inputs_of(const DirectionPair& pair, const NpBrdf::Code& code) noexcept {
  // the frame that turns the half vector onto the normal
  const Vec3 sum = pair.wi + pair.wo, difference = pair.wi - pair.wo;
  const Vec3 h = normalize(sum);
  const double sin_h = std::hypot(h.x, h.y);
  const double cos_phi = sin_h > 0 ? h.x / sin_h : 1, sin_phi = sin_h > 0 ? h.y / sin_h : 0;

  // the difference vector in it, and twice its azimuth; 0 where there is none
  const double x = h.z * (cos_phi * difference.x + sin_phi * difference.y) - sin_h * difference.z;
  const double y = cos_phi * difference.y - sin_phi * difference.x, square = x * x + y * y;
  const double cos_2phi = square > 0 ? (x * x - y * y) / square : 1,
               sin_2phi = square > 0 ? 2 * x * y / square : 0;
  const double theta_d = std::atan2(length(difference), length(sum));

  NpDecoder::Inputs inputs{static_cast<float>(0.5 * (1 + cos_2phi)), static_cast<float>(0.5 * (1 + sin_2phi)),
                           static_cast<float>(std::atan2(sin_h, h.z) / kHalfPi),
                           static_cast<float>(theta_d / kHalfPi)};
  std::ranges::copy(code, inputs.end() - NpBrdf::kCode);
  return inputs;
}

// Decodes an output of the network, which was trained on 1/0.15 of log(1 + x), four times over.
double decoded(float output) noexcept {
  constexpr int kTimes = 4;
  constexpr double kScale = 0.15, kMaxExponent = 700;  // exp(700) is still finite
  double x = kScale * static_cast<double>(output);
  for (int i = 0; i < kTimes; ++i) x = std::expm1(std::min(x, kMaxExponent));
  return x;
}

}  // namespace

NpBrdf::NpBrdf(std::shared_ptr<const NpDecoder> decoder, const Code& code, Value value)
    : decoder_(std::move(decoder)), code_(code), value_(value) {
  for (std::size_t i = 0; i < code.size(); ++i)
    if (!(std::abs(code[i]) <= NpDecoder::kMaxWeight))
      throw Error(fmt::format("code: number {}: expected one within {} of 0, found {}", i + 1,
                              NpDecoder::kMaxWeight, code[i]));
}

bool NpBrdf::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  const DirectionPair pair{wi, wo};
  std::uint8_t known = 0;
  eval({&pair, 1}, f, {&known, 1});
  return known != 0;
}

void NpBrdf::eval(std::span<const DirectionPair> pairs, std::span<double> values,
                  std::span<std::uint8_t> known) const noexcept {
  std::ranges::fill(values, 0.0);
  std::ranges::fill(known, std::uint8_t{1});

  constexpr std::size_t kBlock = 256;
  std::array<std::size_t, kBlock> place;
  std::array<NpDecoder::Inputs, kBlock> inputs;
  std::array<NpDecoder::Outputs, kBlock> outputs;
  for (std::size_t next = 0; next < pairs.size();) {
    // the next pairs above the horizon
    std::size_t count = 0;
    for (; next < pairs.size() && count < kBlock; ++next)
      if (pairs[next].wi.z > 0 && pairs[next].wo.z > 0) {
        place[count] = next;
        inputs[count++] = inputs_of(pairs[next], code_);
      }

    decoder_->decode(std::span(inputs).first(count), std::span(outputs).first(count));
    for (std::size_t k = 0; k < count; ++k) {
      const auto& [wi, wo] = pairs[place[k]];
      const double divisor = value_ == Value::with_cosine ? std::max(0.5 * (wi.z + wo.z), kMinCosine) : 1;
      for (std::size_t c = 0; c < NpDecoder::kOutputs; ++c)
        values[place[k] * NpDecoder::kOutputs + c] = decoded(outputs[k][c]) / divisor;
    }
  }
}

}  // namespace burnish
