#include <utility>

#include <burnish/fitting/overfit.h>

namespace burnish {

namespace {

constexpr std::size_t kEnoughPairs = 40;  // a texel
constexpr double kMostGap = 2, kStiffer = 10, kMostSmooth = 1e-3;

}  // namespace

bool is_overfit(const LobesFit& fit, const TrainingSet& set, const TrainingSet& held_out,
                const ErrorTerms& shares) {
  std::size_t texels = 0;
  for (const ModelSpec::TableSpec& table : fit.model.spec.tables) texels += table.layout.node_count();
  return set.size() < kEnoughPairs * texels &&
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

}  // namespace burnish
