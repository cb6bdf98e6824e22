// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <burnish/error.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

SymmetrizedBrdf::SymmetrizedBrdf(BrdfRef source) : source_(source) {
  if (source.channels() > kMaxChannels) throw Error("a source to symmetrize has at most 1024 channels");
}

namespace {

// Joins both orders of a pair: takes the mean, or the one that is known.
bool join_orders(std::span<double> f, bool known, std::span<const double> swapped,
                 bool swapped_known) noexcept {
  if (known && swapped_known)
    for (std::size_t c = 0; c < f.size(); ++c) f[c] = 0.5 * (f[c] + swapped[c]);
  else if (swapped_known)
    for (std::size_t c = 0; c < f.size(); ++c) f[c] = swapped[c];
  return known || swapped_known;
}

bool mean_of_orders(BrdfRef source, Vec3 wi, Vec3 wo, std::span<double> f) noexcept {
  if (source.reciprocal()) return source.eval(wi, wo, f);
  std::array<double, SymmetrizedBrdf::kMaxChannels> buffer;
  const std::span<double> swapped(buffer.data(), f.size());
  const bool known = source.eval(wi, wo, f);
  return join_orders(f, known, swapped, source.eval(wo, wi, swapped));
}

// In blocks, which sources that evaluate many pairs at a time are faster at.
void means_of_orders(BrdfRef source, std::span<const DirectionPair> pairs, std::span<double> values,
                     std::span<std::uint8_t> known) noexcept {
  if (source.reciprocal()) return source.eval(pairs, values, known);
  constexpr std::size_t kMost = SymmetrizedBrdf::kMaxChannels;  // values, and of one channel pairs
  std::array<DirectionPair, kMost> turned;
  std::array<double, kMost> swapped;
  std::array<std::uint8_t, kMost> swapped_known;
  source.eval(pairs, values, known);
  const std::size_t channels = source.channels(), block = kMost / channels;
  for (std::size_t begin = 0; begin < pairs.size(); begin += block) {
    const std::size_t count = std::min(block, pairs.size() - begin);
    for (std::size_t i = 0; i < count; ++i) turned[i] = {pairs[begin + i].wo, pairs[begin + i].wi};
    source.eval(std::span(turned).first(count), std::span(swapped).first(count * channels),
                std::span(swapped_known).first(count));
    for (std::size_t i = 0; i < count; ++i)
      known[begin + i] =
          join_orders(values.subspan((begin + i) * channels, channels), known[begin + i] != 0,
                      std::span(swapped).subspan(i * channels, channels), swapped_known[i] != 0);
  }
}

}  // namespace

bool SymmetrizedBrdf::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  return mean_of_orders(source_, wi, wo, f);
}

bool SymmetrizedBrdf::eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  return mean_of_orders(source_.unclamped(), wi, wo, f);
}

void SymmetrizedBrdf::eval(std::span<const DirectionPair> pairs, std::span<double> values,
                           std::span<std::uint8_t> known) const noexcept {
  means_of_orders(source_, pairs, values, known);
}

void SymmetrizedBrdf::eval_raw(std::span<const DirectionPair> pairs, std::span<double> values,
                               std::span<std::uint8_t> known) const noexcept {
  means_of_orders(source_.unclamped(), pairs, values, known);
}

}  // namespace burnish
