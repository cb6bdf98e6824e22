// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <benchmark/benchmark.h>

#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/half_diff_table.h>

namespace burnish {
namespace {

/// A glossy lobe over a diffuse floor.
struct Glossy {
  std::size_t channels() const noexcept { return 3; }
  bool isotropic() const noexcept { return true; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    const double lobe = std::pow(half_vector(wi, wo).z, 200);
    for (std::size_t c = 0; c < 3; ++c) f[c] = 0.1 + (10 + static_cast<double>(c)) * lobe;
    return true;
  }
};

/// A lookup of MERL's size, its mean relative error beside its speed.
template <class Lookup>
void lookups(benchmark::State& state) {
  static const HalfDiffTable table = tabulate_half_diff(Glossy{}, 90, 90, 180, false);
  const Lookup lookup = [] {
    if constexpr (std::same_as<Lookup, NearestHalfDiff>)
      return NearestHalfDiff{&table};
    else
      return BrdfRef(table);
  }();
  const auto pairs = draw_pairs(1 << 16, 1, false);
  std::array<double, 3> f, truth;
  double error = 0;
  for (const auto& [wi, wo] : pairs) {
    lookup.eval(wi, wo, f);
    Glossy{}.eval(wi, wo, truth);
    error += std::abs(f[0] / truth[0] - 1);
  }
  error /= static_cast<double>(pairs.size());
  if (!(error < 0.1)) return state.SkipWithError("the lookup is wrong");
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& [wi, wo] = pairs[i++ % pairs.size()];
    lookup.eval(wi, wo, f);
    benchmark::DoNotOptimize(f);
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["relative_error"] = error;
}

BENCHMARK(lookups<NearestHalfDiff>)->Name("half_diff_table/nearest");
BENCHMARK(lookups<BrdfRef>)->Name("half_diff_table/trilinear");

}  // namespace
}  // namespace burnish
