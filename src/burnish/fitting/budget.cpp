#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/budget.h>
#include <burnish/math/vec3.h>

namespace burnish {

namespace {

// Highlights are narrow, but a gamma-corrected picture shows their skirts as wide rings: a mild crowding at
// the normal. theta_m spans twice the angle, and only its beginning matters.
constexpr Warp kHalfWarp{WarpKind::power, 0.8}, kDeviationWarp{WarpKind::power, 0.5};
constexpr Warp kDiskWarp{WarpKind::rational, 0.25};

constexpr std::size_t kNumberBytes = 4;  // of a scale or a warp's parameter

// How an isotropic lobe's texels are shared between its tables.
constexpr double kShareP = 0.083, kShareM = 0.183, kShareR = 0.147;

// Where successive lobes are split off, in tan(theta_d / 2).
constexpr double kCentres[] = {0.25, 0.6, 0.4, 0.8, 0.15, 0.5, 0.7, 0.3};

// The way to the last refinement is made on every kThin-th pair and in few steps.
constexpr std::size_t kThin = 4;
constexpr int kRoughSteps = 12;

std::size_t texel_bytes(int channels, TableFormat format) {
  return static_cast<std::size_t>(channels) * (format == TableFormat::half ? 2 : 4);
}

// More texels for each of few lobes resolve rings, more lobes follow how the highlight changes with the
// angles; measured on the materials of docs/accuracy.md.
int lobes_for(std::size_t texels) {
  return std::clamp(static_cast<int>(std::lround(std::log2(static_cast<double>(texels) / 82.0))), 1, 8);
}

class SpecBuilder {
 public:
  int line(const std::string& name, int width, Warp warp = {}) {
    return add({.name = name, .layout = {.shape = TableShape::line, .width = width, .warp = warp}});
  }
  int disk(const std::string& name, int side, Warp warp = {}) {
    return add(
        {.name = name, .layout = {.shape = TableShape::disk, .width = side, .height = side, .warp = warp}});
  }
  void lobe(std::vector<FactorUse> uses) { spec_.lobes.push_back(std::move(uses)); }
  ModelSpec take() { return std::move(spec_); }

 private:
  int add(ModelSpec::TableSpec table) {
    spec_.tables.push_back(std::move(table));
    return static_cast<int>(spec_.tables.size()) - 1;
  }
  ModelSpec spec_;
};

[[noreturn]] void refuse(std::size_t bytes, int lobes) {
  throw Error(fmt::format("fit: expected a budget that holds {} lobe{} of four tables, found {} bytes", lobes,
                          lobes == 1 ? "" : "s", bytes));
}

ModelSpec isotropic_spec(std::size_t texels, int lobes, std::size_t bytes) {
  SpecBuilder builder;
  for (int j = 0; j < lobes; ++j) {
    // what division leaves goes to the first lobes
    const auto n = static_cast<int>(texels / static_cast<std::size_t>(lobes) +
                                    (static_cast<std::size_t>(j) < texels % static_cast<std::size_t>(lobes)));
    const int p = static_cast<int>(kShareP * n), m = static_cast<int>(kShareM * n),
              r = static_cast<int>(kShareR * n), q = n - p - m - r;
    if (std::min({p, q, m, r}) < 2) refuse(bytes, lobes);
    const std::string number = std::to_string(j + 1);
    const int tp = builder.line("p" + number, p), tq = builder.line("q" + number, q, kHalfWarp),
              tm = builder.line("m" + number, m, kDeviationWarp), tr = builder.line("r" + number, r);
    builder.lobe({{.table = tp, .projection = kProjectWo},
                  {.table = tq, .projection = kProjectHalf},
                  {.table = tm, .projection = kProjectDeviation},
                  {.table = tr, .projection = kProjectDifference},
                  {.table = tp, .projection = kProjectWi}});
  }
  return builder.take();
}

// One lobe of lines for what is spread wide, the others of hemispheres.
ModelSpec anisotropic_spec(std::size_t texels, int lobes, std::size_t bytes) {
  constexpr int kBase = 12, kRing = 24;
  constexpr double kDiskShareP = 0.04;
  SpecBuilder builder;
  const int ta = builder.line("a", kBase), tb = builder.line("b", kBase), tc = builder.line("c", kBase);
  builder.lobe({{.table = ta, .projection = kProjectWo},
                {.table = tb, .projection = kProjectHalf},
                {.table = tc, .projection = kProjectDifference},
                {.table = ta, .projection = kProjectWi}});
  if (lobes < 2) throw Error("fit: expected at least two lobes for an anisotropic source, found one");
  const auto others = static_cast<std::size_t>(lobes - 1);
  if (texels < 3 * kBase + others * (2 * kRing + 2 * 9)) refuse(bytes, lobes);
  const auto left = static_cast<double>((texels - 3 * kBase) / others - 2 * kRing);
  const int p = std::max(3, static_cast<int>(std::sqrt(kDiskShareP * left)));
  const int q = static_cast<int>(std::sqrt(left - p * p));
  for (std::size_t j = 0; j < others; ++j) {
    const std::string number = std::to_string(j + 1);
    const int tp = builder.disk("p" + number, p), tq = builder.disk("q" + number, q, kDiskWarp),
              tm = builder.line("m" + number, kRing, kDeviationWarp), tr = builder.line("r" + number, kRing);
    builder.lobe({{.table = tp, .projection = kProjectWo},
                  {.table = tq, .projection = kProjectHalf},
                  {.table = tm, .projection = kProjectDeviation},
                  {.table = tr, .projection = kProjectDifference},
                  {.table = tp, .projection = kProjectWi}});
  }
  return builder.take();
}

std::size_t parameter_bytes(int lobes, int channels, bool isotropic) {
  const int warps = isotropic ? 2 * lobes : 2 * (lobes - 1);
  return kNumberBytes * static_cast<std::size_t>(lobes * channels + warps);
}

/// Refines on part of the data, then on all.
void refine_in_steps(LogModel& model, const TrainingSet& coarse, const TrainingSet* fine,
                     const RefineOptions& options, double from, double to, LobesSummary& summary) {
  RefineOptions rough = options;
  if (!fine) rough.max_iterations = std::min(kRoughSteps, options.max_iterations);
  const auto add = [&](const TrainingSet& set, double begin, double end) {
    if (options.progress)
      rough.progress = [&, begin, end](double f) { options.progress(begin + f * (end - begin)); };
    const RefineSummary done = refine(model, set, rough);
    summary.iterations += done.iterations;
    summary.objective_before = done.objective_before;
    summary.objective_after = done.objective_after;
    summary.stop_reason = done.stop_reason;
  };
  const double middle = fine ? from + 0.3 * (to - from) : to;
  rough.max_iterations = std::min(fine ? 2 * kRoughSteps : kRoughSteps, options.max_iterations);
  add(coarse, from, middle);
  if (!fine) return;
  rough.max_iterations = std::max(0, options.max_iterations - rough.max_iterations);
  add(*fine, middle, to);
}

double soft_step(double t, double centre) {
  return 1 / (1 + std::exp((centre - t) / 0.1));
}

bool has_disk(const ModelSpec& spec, const std::vector<FactorUse>& lobe) {
  return std::ranges::any_of(lobe, [&](const FactorUse& use) {
    return spec.tables[static_cast<std::size_t>(use.table)].layout.shape == TableShape::disk;
  });
}

// The tables of one lobe alone.
ModelSpec lobe_spec(const ModelSpec& spec, std::size_t lobe, std::vector<std::size_t>& tables) {
  ModelSpec part{.tables = {}, .lobes = {spec.lobes[lobe]}};
  for (FactorUse& use : part.lobes.front()) {
    const auto t = static_cast<std::size_t>(use.table);
    auto known = std::ranges::find(tables, t);
    if (known == tables.end()) {
      part.tables.push_back(spec.tables[t]);
      known = tables.insert(tables.end(), t);
    }
    use.table = static_cast<int>(known - tables.begin());
  }
  return part;
}

}  // namespace

ModelSpec budget_spec(const BudgetOptions& options, int channels, bool isotropic) {
  const std::size_t per_texel = texel_bytes(channels, options.format);
  int lobes = options.lobes;
  if (lobes <= 0) lobes = isotropic ? lobes_for(options.bytes / per_texel) : 2;
  const std::size_t parameters = parameter_bytes(lobes, channels, isotropic);
  if (options.bytes <= parameters) refuse(options.bytes, lobes);
  const std::size_t texels = (options.bytes - parameters) / per_texel;
  return isotropic ? isotropic_spec(texels, lobes, options.bytes)
                   : anisotropic_spec(texels, lobes, options.bytes);
}

LobesFit fit_budget(const TrainingSet& set, const BudgetOptions& options) {
  const ModelSpec whole = budget_spec(options, set.channels, set.isotropic);
  if (!set.isotropic) return fit_lobes(set, whole, options.refine);
  const std::size_t lobes = whole.lobes.size();
  const TrainingSet coarse = thinned(set, kThin);
  constexpr std::ptrdiff_t kTables = 4;
  LobesFit fit{.model = fit_one_lobe({.tables = {whole.tables.begin(), whole.tables.begin() + kTables},
                                      .lobes = {whole.lobes.front()}},
                                     coarse, coarse.values, options.refine.smooth)};
  fit.summary.lobes = static_cast<int>(lobes);
  // the work grows with the square of the lobes
  const auto done = [&](std::size_t j) {
    return static_cast<double>(j * j * j) / static_cast<double>(3 * lobes * lobes * lobes);
  };
  for (std::size_t j = 1; j <= lobes; ++j) {
    if (j > 1) {
      fit.model = with_lobe_split(std::move(fit.model), j - 2, kCentres[(j - 2) % std::size(kCentres)], "+");
      ModelSpec spec{
          .tables = {whole.tables.begin(), whole.tables.begin() + static_cast<std::ptrdiff_t>(j) * kTables},
          .lobes = {whole.lobes.begin(), whole.lobes.begin() + static_cast<std::ptrdiff_t>(j)}};
      fit.model = resampled(fit.model, spec);
    }
    const bool last = j == lobes;
    refine_in_steps(fit.model, coarse, last ? &set : nullptr, options.refine, done(j - 1), last ? 1 : done(j),
                    fit.summary);
  }
  return fit;
}

LobesFit fit_lobes(const TrainingSet& set, const ModelSpec& spec, const RefineOptions& options) {
  const std::size_t lobes = spec.lobes.size(), channels = static_cast<std::size_t>(set.channels);
  if (lobes == 0) throw Error("fit: expected at least one lobe");
  LobesFit fit{.model = {.spec = spec, .channels = set.channels, .log_values = {}}};
  fit.model.log_values.resize(spec.tables.size());
  fit.summary.lobes = static_cast<int>(lobes);

  // A low value of each channel stands for what is spread wide.
  std::vector<float> low(channels);
  for (std::size_t c = 0; c < channels; ++c) {
    std::vector<float> values;
    for (std::size_t i = 0; i < set.size(); ++i) values.push_back(set.values[i * channels + c]);
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 5);
    std::nth_element(values.begin(), place, values.end());
    low[c] = *place;
  }
  const bool any_disk = std::ranges::any_of(spec.lobes, [&](const auto& l) { return has_disk(spec, l); });
  std::size_t wide = 0;
  for (const auto& lobe : spec.lobes) wide += any_disk && !has_disk(spec, lobe);
  const std::size_t narrow = lobes - wide;

  std::size_t wide_seen = 0, narrow_seen = 0;
  for (std::size_t j = 0; j < lobes; ++j) {
    const bool is_wide = any_disk && !has_disk(spec, spec.lobes[j]);
    const std::size_t group = is_wide ? wide : narrow, place = is_wide ? wide_seen++ : narrow_seen++;
    std::vector<float> target(set.values.size());
    for (std::size_t i = 0; i < set.size(); ++i) {
      const double t = project_tan_half(kProjectDifference, set.pairs[i].wi, set.pairs[i].wo);
      const auto cut = [&](std::size_t k) {
        return k == 0       ? 1.0
               : k == group ? 0.0
                            : soft_step(t, static_cast<double>(k) / static_cast<double>(group));
      };
      const double share = cut(place) - cut(place + 1);
      for (std::size_t c = 0; c < channels; ++c) {
        const double f = set.values[i * channels + c];
        const double base = wide > 0 ? std::min<double>(0.9 * f, low[c]) : 0;
        target[i * channels + c] = static_cast<float>(share * (is_wide ? base : f - base));
      }
    }
    std::vector<std::size_t> tables;
    const LogModel part = fit_one_lobe(lobe_spec(spec, j, tables), set, target, options.smooth);
    for (std::size_t k = 0; k < tables.size(); ++k) fit.model.log_values[tables[k]] = part.log_values[k];
  }
  const TrainingSet coarse = thinned(set, kThin);
  refine_in_steps(fit.model, coarse, &set, options, 0.1, 1, fit.summary);
  return fit;
}

}  // namespace burnish
