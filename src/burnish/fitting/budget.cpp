#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/budget.h>

namespace burnish {

namespace {

// Highlights are narrow, but a gamma-corrected picture shows their skirts as wide rings: a mild crowding at
// the normal. theta_m spans twice the angle, and only its beginning matters.
constexpr Warp kHalfWarp{WarpKind::power, 0.8}, kDeviationWarp{WarpKind::power, 0.5};

constexpr std::size_t kScaleBytes = 4, kWarpBytes = 4;

// Where successive lobes are split off, in tan(theta_d / 2).
constexpr double kCentres[] = {0.25, 0.6, 0.4, 0.8, 0.15, 0.5, 0.7, 0.3};

std::size_t texel_bytes(int channels, TableFormat format) {
  return static_cast<std::size_t>(channels) * (format == TableFormat::half ? 2 : 4);
}

}  // namespace

ModelSpec isotropic_spec(std::size_t bytes, int lobes, int channels, TableFormat format,
                         const LobeShares& shares) {
  const std::size_t lobe_bytes = bytes / static_cast<std::size_t>(lobes);
  const std::size_t fixed = kScaleBytes * static_cast<std::size_t>(channels) + 2 * kWarpBytes;
  const double texels =
      lobe_bytes > fixed ? static_cast<double>((lobe_bytes - fixed) / texel_bytes(channels, format)) : 0;
  const auto nodes = [&](double share) { return static_cast<int>(share * texels); };
  int p = nodes(shares.p), m = nodes(shares.m), r = nodes(shares.r);
  const int q = static_cast<int>(texels) - p - m - r;
  if (std::min({p, q, m, r}) < 2)
    throw Error(
        fmt::format("fit: expected a budget for {} lobes of four tables, found {} bytes", lobes, bytes));
  ModelSpec spec;
  for (int j = 0; j < lobes; ++j) {
    const auto table = [&](const char* name, int width, Warp warp) {
      spec.tables.push_back({.name = fmt::format("{}{}", name, j + 1),
                             .layout = {.shape = TableShape::line, .width = width, .warp = warp}});
      return static_cast<int>(spec.tables.size()) - 1;
    };
    const int tp = table("p", p, {}), tq = table("q", q, kHalfWarp), tm = table("m", m, kDeviationWarp),
              tr = table("r", r, {});
    spec.lobes.push_back({{.table = tp, .projection = kProjectWo},
                          {.table = tq, .projection = kProjectHalf},
                          {.table = tm, .projection = kProjectDeviation},
                          {.table = tr, .projection = kProjectDifference},
                          {.table = tp, .projection = kProjectWi}});
  }
  return spec;
}

BudgetFit fit_budget(const TrainingSet& set, const BudgetOptions& options) {
  const int lobes = options.lobes > 0 ? options.lobes : 3;
  const ModelSpec whole = isotropic_spec(options.bytes, lobes, set.channels, options.format);
  ModelSpec first{.tables = {whole.tables.begin(), whole.tables.begin() + 4}, .lobes = {whole.lobes.front()}};
  BudgetFit fit;
  LogModel model = fit_one_lobe(first, set, set.values, options.refine.smooth);
  for (int j = 1; j <= lobes; ++j) {
    if (j > 1) {
      model = with_lobe_split(std::move(model), static_cast<std::size_t>(j - 2),
                              kCentres[static_cast<std::size_t>(j - 2) % std::size(kCentres)], "x");
      for (std::size_t t = 0; t < model.spec.tables.size(); ++t)
        model.spec.tables[t].name = whole.tables[t].name;
    }
    fit.summary.refined = refine(model, set, options.refine);
    fit.summary.steps.push_back(
        fmt::format("{} lobes: objective {:.3f} -> {:.3f}, {} steps", j, fit.summary.refined.objective_before,
                    fit.summary.refined.objective_after, fit.summary.refined.iterations));
  }
  fit.brdf = to_brdf(model, options.format);
  return fit;
}

}  // namespace burnish
