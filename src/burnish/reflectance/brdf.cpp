#include <array>

#include <burnish/error.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

SymmetrizedBrdf::SymmetrizedBrdf(BrdfRef source) : source_(source) {
  if (source.channels() > kMaxChannels) throw Error("a source to symmetrize has at most 1024 channels");
}

bool SymmetrizedBrdf::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  if (source_.reciprocal()) return source_.eval(wi, wo, f);
  std::array<double, kMaxChannels> buffer;
  const std::span<double> swapped(buffer.data(), f.size());
  const bool known = source_.eval(wi, wo, f);
  const bool swapped_known = source_.eval(wo, wi, swapped);
  if (known && swapped_known)
    for (std::size_t c = 0; c < f.size(); ++c) f[c] = 0.5 * (f[c] + swapped[c]);
  else if (swapped_known)
    for (std::size_t c = 0; c < f.size(); ++c) f[c] = swapped[c];
  return known || swapped_known;
}

void SymmetrizedBrdf::eval(std::span<const DirectionPair> pairs, std::span<double> values,
                           std::span<std::uint8_t> known) const noexcept {
  if (source_.reciprocal()) return source_.eval(pairs, values, known);
  const auto channels = static_cast<std::size_t>(source_.channels());
  for (std::size_t i = 0; i < pairs.size(); ++i)
    known[i] = eval(pairs[i].wi, pairs[i].wo, values.subspan(i * channels, channels));
}

}  // namespace burnish
