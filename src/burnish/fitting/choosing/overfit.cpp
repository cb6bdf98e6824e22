// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <burnish/fitting/choosing/overfit.h>

namespace burnish {

namespace {

constexpr std::size_t kManyTexels = 6000, kTexelsOnce = 16'384;
constexpr std::size_t kIsotropicDirections = 60'000, kAnisotropicDirections = 200'000;
constexpr std::size_t kEnoughPairs = 40;  // a texel
constexpr std::size_t kHeldOutPictures = 5000, kHeldOutDirections = 15'000;
constexpr double kMaxGap = 2, kStiffer = 10, kMaxSmooth = 1e-3;

bool has_few_pairs(const LogModel& model, const TrainingSet& set) {
  std::size_t texels = 0;
  for (const ModelSpec::TableSpec& table : model.spec.tables) texels += table.layout.node_count();
  return set.size() < kEnoughPairs * texels;
}

}  // namespace

TrainingOptions training_for(std::size_t bytes, std::size_t texel_bytes, bool isotropic) {
  if (!isotropic) return {.directions = kAnisotropicDirections};
  if (bytes <= kManyTexels * texel_bytes) return {.directions = kIsotropicDirections};
  const std::size_t texels = bytes / texel_bytes, times = std::max<std::size_t>(1, texels / kTexelsOnce);
  return {.pictures = times * 40'000, .directions = times * 50'000, .crowded = true};
}

SmoothFit fit_without_overfit(BrdfRef source, const TrainingSet& set, const LobePlan& plan, std::size_t bytes,
                              std::size_t texel_bytes, const TrainingOptions& drawn,
                              const RefineOptions& options) {
  SmoothFit result{.fit = fit_plan(set, plan, bytes, texel_bytes, options, kLobeStarts),
                   .smooth = options.smooth};
  if (!has_few_pairs(result.fit.model, set)) return result;
  TrainingOptions anew = drawn;
  anew.pictures = kHeldOutPictures;
  anew.directions = kHeldOutDirections;
  anew.seed += 2;  // the error that is finally reported uses seed + 1
  TrainingSet held_out = draw_training_set(source, anew);
  held_out.exposure = set.exposure;
  double error = objective(result.fit.model, held_out, options.shares);
  if (error < objective(result.fit.model, set, options.shares) + kMaxGap) return result;
  RefineOptions stiffer = options;
  while (stiffer.smooth < kMaxSmooth) {
    stiffer.smooth *= kStiffer;
    LobesFit candidate = fit_plan(set, plan, bytes, texel_bytes, stiffer, kLobeStarts);
    const double next = objective(candidate.model, held_out, options.shares);
    if (!(next < error)) break;
    result = {std::move(candidate), stiffer.smooth};
    error = next;
  }
  return result;
}

}  // namespace burnish
