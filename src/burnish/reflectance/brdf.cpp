#include <array>

#include <burnish/error.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

SymmetrizedBrdf::SymmetrizedBrdf(BrdfRef source) : source_(source) {
  if (source.channels() > kMaxChannels) throw Error("a source to symmetrize has at most 1024 channels");
}

namespace {

bool mean_of_orders(BrdfRef source, Vec3 wi, Vec3 wo, std::span<double> f) noexcept {
  if (source.reciprocal()) return source.eval(wi, wo, f);
  std::array<double, SymmetrizedBrdf::kMaxChannels> buffer;
  const std::span<double> swapped(buffer.data(), f.size());
  const bool known = source.eval(wi, wo, f);
  const bool swapped_known = source.eval(wo, wi, swapped);
  if (known && swapped_known)
    for (std::size_t c = 0; c < f.size(); ++c) f[c] = 0.5 * (f[c] + swapped[c]);
  else if (swapped_known)
    for (std::size_t c = 0; c < f.size(); ++c) f[c] = swapped[c];
  return known || swapped_known;
}

void means_of_orders(BrdfRef source, std::span<const DirectionPair> pairs, std::span<double> values,
                     std::span<std::uint8_t> known) noexcept {
  if (source.reciprocal()) return source.eval(pairs, values, known);
  const auto channels = source.channels();
  for (std::size_t i = 0; i < pairs.size(); ++i)
    known[i] = mean_of_orders(source, pairs[i].wi, pairs[i].wo, values.subspan(i * channels, channels));
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
