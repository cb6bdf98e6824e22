#include <utility>

#include <burnish/fitting/overfit.h>

namespace burnish {

namespace {

constexpr std::size_t kEnoughPairs = 40;  // a texel
constexpr std::size_t kHeldOutPictures = 5000, kHeldOutDirections = 15'000;
constexpr double kMostGap = 2, kStiffer = 10, kMostSmooth = 1e-3;

bool has_few_pairs(const LobesFit& fit, const TrainingSet& set) {
  std::size_t texels = 0;
  for (const ModelSpec::TableSpec& table : fit.model.spec.tables) texels += table.layout.node_count();
  return set.size() < kEnoughPairs * texels;
}

}  // namespace

bool is_overfit(const LobesFit& fit, const TrainingSet& set, const TrainingSet& held_out,
                const ErrorTerms& shares) {
  return has_few_pairs(fit, set) &&
         objective(fit.model, held_out, shares) > objective(fit.model, set, shares) + kMostGap;
}

void fit_smoother(const TrainingSet& set, const TrainingSet& held_out, const LobePlan& plan,
                  std::size_t bytes, std::size_t texel_bytes, RefineOptions& options, LobesFit& fit) {
  RefineOptions stiffer = options;
  double error = objective(fit.model, held_out, options.shares);
  while (stiffer.smooth < kMostSmooth) {
    stiffer.smooth *= kStiffer;
    LobesFit candidate = fit_plan(set, plan, bytes, texel_bytes, stiffer);
    const double next = objective(candidate.model, held_out, options.shares);
    if (!(next < error)) break;
    fit = std::move(candidate);
    error = next;
    options.smooth = stiffer.smooth;
  }
}

LobesFit fit_without_overfit(BrdfRef source, const TrainingSet& set, const LobePlan& plan, std::size_t bytes,
                             std::size_t texel_bytes, std::uint64_t seed, RefineOptions& options) {
  LobesFit fit = fit_plan(set, plan, bytes, texel_bytes, options);
  if (!has_few_pairs(fit, set)) return fit;
  TrainingSet held_out = draw_training_set(
      source, {.pictures = kHeldOutPictures, .directions = kHeldOutDirections, .seed = seed});
  held_out.exposure = set.exposure;
  if (is_overfit(fit, set, held_out, options.shares))
    fit_smoother(set, held_out, plan, bytes, texel_bytes, options, fit);
  return fit;
}

}  // namespace burnish
