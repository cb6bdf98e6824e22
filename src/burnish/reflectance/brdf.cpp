#include <array>

#include <burnish/error.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

SymmetrizedBrdf::SymmetrizedBrdf(BrdfRef source) : source_(source) {
  if (source.channels() > kMaxChannels) throw Error("a source to symmetrize has at most 1024 channels");
}

bool SymmetrizedBrdf::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
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

}  // namespace burnish
