// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <burnish/baselines/np_decoder.h>
#include <burnish/error.h>

#define HWY_TARGET_INCLUDE "burnish/baselines/np_decoder.cpp"
#include <burnish/math/highway-inl.h>

#ifndef BURNISH_BASELINES_NP_DECODER
#define BURNISH_BASELINES_NP_DECODER
namespace burnish {
namespace {

// Outputs computed together, so that sums stay in registers; their weights lie together, biases first.
constexpr std::size_t kTogether = 5;
constexpr std::size_t kWidest = std::ranges::max(NpDecoder::kUnits);
static_assert(kWidest % kTogether == 0);

}  // namespace
}  // namespace burnish
#endif

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

using D = hn::ScalableTag<float>;

// Values of a unit for two vectors of inputs.
constexpr std::size_t kTile = 2 * hn::MaxLanes(D());
static_assert(kTile <= 32);

// y = max(0, bias + sum of weight * x) of some outputs; returns the weights behind theirs.
template <std::size_t outputs>
const float* some_outputs(const float* weights, std::size_t inputs, const float* x, float* y) {
  const D d;
  constexpr std::size_t kLanes = kTile / 2;
  hn::Vec<D> first[outputs], second[outputs];
  for (std::size_t o = 0; o < outputs; ++o) first[o] = second[o] = hn::Set(d, weights[o]);
  weights += outputs;
  for (std::size_t i = 0; i < inputs; ++i, weights += outputs, x += kTile) {
    const auto a = hn::Load(d, x), b = hn::Load(d, x + kLanes);
    for (std::size_t o = 0; o < outputs; ++o) {
      const auto weight = hn::Set(d, weights[o]);
      first[o] = hn::MulAdd(weight, a, first[o]);
      second[o] = hn::MulAdd(weight, b, second[o]);
    }
  }
  for (std::size_t o = 0; o < outputs; ++o) {
    hn::Store(hn::Max(first[o], hn::Zero(d)), d, y + o * kTile);
    hn::Store(hn::Max(second[o], hn::Zero(d)), d, y + o * kTile + kLanes);
  }
  return weights;
}

// At most kTile inputs at a time.
void decode(const float* packed, std::span<const NpDecoder::Inputs> inputs,
            std::span<NpDecoder::Outputs> outputs) {
  alignas(64) float a[kWidest * kTile], b[kWidest * kTile];
  for (std::size_t begin = 0; begin < inputs.size(); begin += kTile) {
    const std::size_t count = std::min(kTile, inputs.size() - begin);

    // units by rows; the rest of an unfilled tile repeats its first input
    for (std::size_t i = 0; i < NpDecoder::kInputs; ++i)
      for (std::size_t k = 0; k < kTile; ++k) a[i * kTile + k] = inputs[begin + (k < count ? k : 0)][i];

    // layers, from one buffer to the other
    float *x = a, *y = b;
    const float* weights = packed;
    for (std::size_t layer = 0; layer + 2 < NpDecoder::kUnits.size(); ++layer, std::swap(x, y))
      for (std::size_t o = 0; o < kWidest; o += kTogether)
        weights = some_outputs<kTogether>(weights, NpDecoder::kUnits[layer], x, y + o * kTile);
    some_outputs<NpDecoder::kOutputs>(weights, kWidest, x, y);

    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t c = 0; c < NpDecoder::kOutputs; ++c) outputs[begin + k][c] = y[c * kTile + k];
  }
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

namespace {

HWY_EXPORT(decode);

}  // namespace

NpDecoder::NpDecoder(std::span<const float> weights) {
  if (weights.size() != kWeights)
    throw Error(fmt::format("decoder: expected {} weights, found {}", kWeights, weights.size()));
  for (std::size_t i = 0; i < kWeights; ++i)
    if (!(std::abs(weights[i]) <= kMaxWeight))
      throw Error(fmt::format("decoder: weight {}: expected a number within {} of 0, found {}", i + 1,
                              kMaxWeight, weights[i]));

  // groups of outputs: biases, then the weights of each input
  packed_.reserve(kWeights);
  for (std::size_t layer = 0; layer + 1 < kUnits.size(); ++layer) {
    const std::size_t inputs = kUnits[layer], outputs = kUnits[layer + 1];
    const auto kernel = weights.first(inputs * outputs), biases = weights.subspan(inputs * outputs, outputs);
    for (std::size_t begin = 0; begin < outputs; begin += kTogether) {
      const std::size_t count = std::min(kTogether, outputs - begin);
      const auto append = [&](std::span<const float> row) {
        const auto group = row.subspan(begin, count);
        packed_.insert(packed_.end(), group.begin(), group.end());
      };
      append(biases);
      for (std::size_t i = 0; i < inputs; ++i) append(kernel.subspan(i * outputs, outputs));
    }
    weights = weights.subspan((inputs + 1) * outputs);
  }
}

void NpDecoder::decode(std::span<const Inputs> inputs, std::span<Outputs> outputs) const noexcept {
  HWY_DYNAMIC_DISPATCH(decode)(packed_.data(), inputs, outputs);
}

}  // namespace burnish
#endif
