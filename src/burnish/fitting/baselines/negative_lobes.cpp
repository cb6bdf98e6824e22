// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include <burnish/fitting/baselines/negative_lobes.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {

namespace {

/// A sum of signed terms with a constant added, then clamped.
struct BiasedBrdf {
  const SeparableBrdf* brdf;
  double bias;

  std::size_t channels() const noexcept { return brdf->channels(); }
  bool isotropic() const noexcept { return brdf->isotropic(); }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    brdf->eval_signed(wi, wo, f);
    if (wi.z > 0 && wo.z > 0)
      for (double& value : f) value = std::max(0.0, value + bias);
    return true;
  }
};

static_assert(Brdf<BiasedBrdf>);

NodeTable without_negatives(NodeTable table) {
  for (float& value : table.values) value = std::max(value, 0.0f);
  return table;
}

}  // namespace

NegativeLobes negative_lobes(const SeparableBrdf& brdf, const Scorer& scorer) {
  const FigureOptions& options = scorer.options();
  std::vector<double> f(brdf.channels());
  std::size_t negative = 0, count = 0;
  double least = 0;
  for (const auto& [wi, wo] : draw_pairs(options.count, options.seed, scorer.reference().isotropic())) {
    brdf.eval_signed(wi, wo, f);
    for (const double value : f) {
      negative += value < 0;
      least = std::min(least, value);
      ++count;
    }
  }
  const SeparableBrdf unsigned_tables(without_negatives(brdf.u()), without_negatives(brdf.v()),
                                      {brdf.scale().begin(), brdf.scale().end()});
  return {.negative_share = static_cast<double>(negative) / static_cast<double>(count),
          .bias = -least,
          .sum_clamped = scorer.score(brdf),
          .tables_clamped = scorer.score(unsigned_tables),
          .biased = scorer.score(BiasedBrdf{&brdf, -least})};
}

}  // namespace burnish
