#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include <burnish/error.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/choosing/backscatter.h>
#include <burnish/fitting/choosing/fetch_plan.h>
#include <burnish/fitting/choosing/hemisphere_plan.h>
#include <burnish/fitting/choosing/lay_out.h>
#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/choosing/order_tables.h>
#include <burnish/fitting/choosing/trial_sets.h>
#include <burnish/fitting/numerics/node_numbers.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/mirror_asymmetry.h>

namespace burnish {

namespace {

// Below this many texels lines serve better, where there are fetches for them.
constexpr double kMinVolumeTexels = 1200;

// Of the texels: lines along theta_h, which rings of films need, and along other angles, which are smooth.
constexpr double kRingShare = 0.07, kLineShare = 0.016, kGridShare = 0.14;
constexpr int kMinLineNodes = 6, kMaxRingNodes = 512, kMaxLineNodes = 64;
// Of a grid b(theta_d,theta_h): its share of the texels, nodes along theta_d for each along theta_h, most texels, least
// nodes along theta_d; the texels of a model from which on it is tried.
constexpr double kHighlightShare = 0.2, kHighlightAspect = 1 / 1.5, kMaxHighlightTexels = 800;
constexpr int kMinHighlightNodes = 6;
constexpr std::size_t kMinGridTexels = 600;
constexpr Warp kDeviationWarp{WarpKind::power, 0.5}, kSkewWarp{WarpKind::power, 0.7};
// Of what the order of the directions changes: nodes along theta_i and a share.
constexpr int kOrderNodes = 8;
constexpr double kOrderShare = 0.25;

// How a volume's nodes are shared out: the best differ among materials.
constexpr VolumeForm kForms[] = {{30, 20, 6}, {40, 15, 6}, {24, 24, 6}, {20, 30, 6}};
constexpr double kBothSides = 2;  // times as many along the azimuth where it tells mirror images apart
// Of theta_d where a lobe stands at 0.
constexpr Warp kRetroWarp{WarpKind::power, 0.5};

// The way to the last refinement is made on about this many pairs, in few steps, at this share of the nodes.
constexpr std::size_t kCoarsePairs = 24'000, kCoarseNodes = 5000;
constexpr double kCoarseShare = 0.25;
constexpr int kCoarseSteps = 10, kCoarseStepsAfterTrial = 4, kFullSteps = 6, kHeldSteps = 4,
              kManyFullSteps = 4, kManyHeldSteps = 3;
// The log-linear start counts values about zero as the relative error does, and is smooth and rough at once.
const HomomorphicOptions kStart{.smooth = 1e-5, .floor = PictureLoss::kFloor, .tolerance = 0.03};
// Trials go so few steps, for gains that another draw of pairs would not give.
constexpr int kTrialSteps = 4, kLobesTrialSteps = 30;
// Of progress, where trials, steps with few pairs and steps with all of them end.
constexpr double kTrialTime = 0.1, kCoarseTime = 0.3, kFullTime = 0.8;
constexpr int kFetches[] = {2, 3, 4, 6, 8, 12, 24};

constexpr double kGoldenStep = 0.6180339887498949;  // of azimuths
constexpr double kFrontalCosine = 1e-3;

/// Adds a model's tables and their uses, all of one lobe.
class SpecBuilder {
 public:
  void add(const char* name, TableLayout layout, const std::vector<FactorUse>& uses) {
    const std::size_t table = spec_.tables.size();
    spec_.tables.push_back({.name = name, .layout = layout});
    if (spec_.lobes.empty()) spec_.lobes.emplace_back();
    for (FactorUse use : uses) {
      use.table = table;
      spec_.lobes.front().push_back(use);
    }
  }
  void add_line(const char* name, int nodes, const std::vector<Projection>& over, Warp warp = {}) {
    std::vector<FactorUse> uses;
    for (const Projection& projection : over) uses.push_back({.projection = projection});
    add(name, {.width = nodes, .warp = warp}, uses);
  }
  const ModelSpec& spec() const noexcept { return spec_; }

 private:
  ModelSpec spec_;
};

/// What a source asks of its tables.
struct SourceTraits {
  bool twisted;  ///< not its own mirror image
  bool ordered;  ///< the order of the directions matters
  bool retro;    ///< has a lobe about wi = wo

  Warp difference_warp() const noexcept { return retro ? kRetroWarp : Warp{}; }
};

SourceTraits traits_of(BrdfRef source) {
  return {mirror_asymmetry(source) > kMinAsymmetry, order_matters(source), backscatters(source)};
}

// What stands beside the volume first: a line along theta_h, for rings, or a grid over theta_h and theta_d.
enum class Beside { line, grid };

/// The tables beside a volume, in the order in which fetches are spent on them.
class TablesBeside {
 public:
  TablesBeside(const CostLimit& limit, const SourceTraits& traits)
      : texels_(static_cast<double>(limit.bytes / limit.texel_bytes)),
        traits_(traits),
        left_(limit.fetches - 1) {}

  SpecBuilder build(Beside beside) && {
    const int line = nodes(kLineShare, kMaxLineNodes);
    if (traits_.ordered && takes(1)) add_by_half("c", kOrderNodes, kOrderShare, kProjectWi);
    const bool grid = beside == Beside::grid && takes(1);
    if (grid) add_highlight();
    if (takes(1)) builder_.add_line("z", nodes(kRingShare, kMaxRingNodes), {kProjectHalf}, kHalfRootWarp);
    if (takes(2)) builder_.add_line("p", line, {kProjectWo, kProjectWi});
    if (!grid && takes(1)) builder_.add_line("r", line, {kProjectDifference}, traits_.difference_warp());
    if (takes(1)) add_deviation();
    if (takes(2))
      builder_.add_line("s", line, {Projection{.wi = 1, .wo = 0.5}, Projection{.wi = 0.5, .wo = 1}},
                        kSkewWarp);
    return std::move(builder_);
  }

 private:
  int nodes(double share, int most) const {
    return std::clamp(static_cast<int>(share * texels_), kMinLineNodes, most);
  }
  bool takes(int fetches) {
    const bool room = left_ >= fetches;
    if (room) left_ -= fetches;
    return room;
  }
  void add_by_half(const char* name, int width, double share, const Projection& along_x, Warp warp = {}) {
    builder_.add(name,
                 {.shape = TableShape::grid,
                  .width = width,
                  .height = nodes(share / width, kMaxRingNodes),
                  .warp = warp,
                  .warp_y = kHalfRootWarp},
                 {{.projection = along_x, .projection_y = kProjectHalf}});
  }
  void add_highlight() {
    const double share = std::min(kHighlightShare, kMaxHighlightTexels / texels_);
    const int width =
        std::max(kMinHighlightNodes, static_cast<int>(std::sqrt(share * kHighlightAspect * texels_)));
    add_by_half("b", width, share, kProjectDifference, traits_.difference_warp());
  }
  void add_deviation() {
    const int side = std::max(4, static_cast<int>(std::sqrt(kGridShare * texels_)));
    builder_.add("k", {.shape = TableShape::grid, .width = side, .height = side, .warp = kDeviationWarp},
                 {{.projection = kProjectDeviation, .projection_y = kProjectDifference}});
  }

  double texels_;
  const SourceTraits& traits_;
  int left_;  ///< fetches
  SpecBuilder builder_;
};

// The tables that a number of fetches has room for; the volume takes what the others leave.
ModelSpec volume_spec(VolumeForm form, Beside beside, const CostLimit& limit, std::size_t channels,
                      const SourceTraits& traits) {
  SpecBuilder builder = TablesBeside(limit, traits).build(beside);

  // The volume has no nodes yet: the count so far is what the other tables and all numbers take.
  builder.add("g", {.shape = TableShape::volume, .warp = kHalfRootWarp, .warp_y = traits.difference_warp()},
              {{.projection = kProjectHalf,
                .projection_y = kProjectDifference,
                .projection_z = traits.twisted ? kProjectSide : kProjectAzimuth}});
  ModelSpec spec = builder.spec();
  const std::size_t taken = model_bytes(spec, channels, limit.texel_bytes);
  const std::size_t rest = limit.bytes > taken ? (limit.bytes - taken) / limit.texel_bytes : 0;

  // It takes the rest.
  if (traits.twisted) form.azimuth *= kBothSides;
  TableLayout& volume = spec.tables.back().layout;
  volume = volume_of(form, static_cast<double>(rest));
  volume.warp_y = traits.difference_warp();
  if (volume.width < 2) throw Error("fit: expected a budget that holds a table of three axes");
  spec.tables.back().circle_z = traits.twisted;
  return spec;
}

TrainingSet about(const TrainingSet& set, std::size_t pairs) {
  return thinned(set, std::max<std::size_t>(1, set.size() / pairs));
}

/// Trials of models of an isotropic source.
struct IsotropicTrials : TrialSets {
  using TrialSets::TrialSets;

  struct Trial {
    LogModel model;
    double objective = std::numeric_limits<double>::infinity();
  };

  /// Of a model with a volume, of as many nodes as the pairs determine.
  Trial try_volume(const ModelSpec& spec, const RefineOptions& options) const {
    const double nodes = static_cast<double>(coupled_unknowns(spec, 1));
    const ModelSpec trial =
        at_fewer_nodes(spec, std::min(1.0, static_cast<double>(fitted.size()) / (6 * nodes)));
    LogModel model = fit_one_lobe(trial, fitted, fitted.values, kStart);
    refine(model, fitted, in_few_steps(options, kTrialSteps));
    const double value = objective(model, judged, options.shares);
    return {.model = std::move(model), .objective = value};
  }
  /// Of lobes of lines.
  double objective_of(const LobePlan& plan, const CostLimit& limit, const RefineOptions& options) const {
    const LobesFit fit =
        fit_plan(fitted, plan, limit.bytes, limit.texel_bytes, in_few_steps(options, kLobesTrialSteps));
    return objective(fit.model, judged, options.shares);
  }
};

struct BestSpec {
  const ModelSpec& spec;
  std::optional<LogModel> trial;  ///< what was tried of it, where several were
};

/// The spec that serves a part of the pairs best that it was not fitted to; of many nodes, which serve alike
/// however they are shared out, the first.
BestSpec best_of(const std::vector<ModelSpec>& specs, const TrainingSet& set, const RefineOptions& options) {
  if (specs.size() == 1 || coupled_unknowns(specs.front(), 1) > kCoarseNodes) return {specs.front(), {}};
  const IsotropicTrials sets(set);
  std::vector<IsotropicTrials::Trial> trials(specs.size());
  for_each_trial(specs.size(), options, 0, kTrialTime,
                 [&](std::size_t k) { trials[k] = sets.try_volume(specs[k], options); });
  const auto best = static_cast<std::size_t>(
      std::ranges::min_element(trials, {}, &IsotropicTrials::Trial::objective) - trials.begin());
  return {specs[best], std::move(trials[best].model)};
}

}  // namespace

bool takes_lobes(BrdfRef source, const CostLimit& limit) {
  const bool few_bytes = static_cast<double>(limit.bytes / limit.texel_bytes) < kMinVolumeTexels;
  if (!few_bytes || !source.isotropic()) return few_bytes;
  const LobePlan plan = plan_for(source, limit.bytes, 0, limit.texel_bytes);
  return plan_fits(plan, limit.bytes, source.channels(), limit.texel_bytes) &&
         fetch_count(plan_to_spec(plan, limit.bytes, source.channels(), limit.texel_bytes)) <=
             static_cast<std::size_t>(limit.fetches);
}

bool holds_model(BrdfRef source, const CostLimit& limit) {
  if (takes_lobes(source, limit))
    return plan_fits(plan_within(source, limit), limit.bytes, source.channels(), limit.texel_bytes);
  try {
    if (source.isotropic())
      volume_spec(kForms[0], Beside::line, limit, source.channels(),
                  {.twisted = true, .ordered = limit.fetches > 1 && order_matters(source), .retro = true});
    else
      hemisphere_specs(limit, source.channels());
    return true;
  } catch (const Error&) {
    return false;
  }
}

LobePlan plan_within(BrdfRef source, const CostLimit& limit) {
  if (source.isotropic()) return plan_for(source, limit.bytes, 0, limit.texel_bytes);
  LobePlan plan = default_plan(limit.bytes, 2, false, limit.texel_bytes);
  const auto fetches = [&] {
    std::size_t sum = 0;
    for (const auto* factors : {&plan.factors, &plan.wide})
      for (const PlannedFactor& factor : *factors) sum += factor.uses.size();
    return sum;
  };
  // what serves least goes first: of what is spread wide all but theta_d, and at last all but the half vector
  const auto drop = [&](const char* name) {
    if (fetches() <= static_cast<std::size_t>(limit.fetches)) return;
    for (auto* factors : {&plan.factors, &plan.wide})
      std::erase_if(*factors, [&](const PlannedFactor& factor) { return factor.name == name; });
  };
  for (const char* name : {"b", "a", "m", "p", "r", "c"}) drop(name);
  if (plan.wide.empty()) plan.wide_texels = 0;
  return plan;
}

std::vector<ModelSpec> volume_specs(BrdfRef source, const CostLimit& limit) {
  SourceTraits traits = traits_of(source);
  std::vector<ModelSpec> specs;
  const auto add = [&] {
    const auto add_form = [&](const VolumeForm& form, Beside beside) {
      specs.push_back(volume_spec(form, beside, limit, source.channels(), traits));
    };
    // of many nodes the first is taken untried
    const int spare =
        limit.bytes / limit.texel_bytes < kMinGridTexels ? 0 : limit.fetches - 1 - traits.ordered;
    if (traits.twisted && spare >= 1) add_form(kForms[0], Beside::grid);
    for (const VolumeForm& form : kForms) add_form(form, Beside::line);
    if (!traits.twisted && spare >= 2) add_form(kForms[0], Beside::grid);
  };
  // beside what matters more, the table may not be worth its bytes
  if (limit.fetches > 1 && traits.ordered) add();
  traits.ordered = false;
  add();
  return specs;
}

std::vector<FetchTrial> try_fetches(BrdfRef source, const TrainingSet& set, CostLimit limit,
                                    const RefineOptions& options) {
  // what the bytes hold, each but once
  const LobePlan lobes = plan_for(source, limit.bytes, 0, limit.texel_bytes);
  std::vector<int> fetches(std::begin(kFetches), std::end(kFetches));
  if (plan_fits(lobes, limit.bytes, source.channels(), limit.texel_bytes))
    fetches.push_back(static_cast<int>(
        fetch_count(plan_to_spec(lobes, limit.bytes, source.channels(), limit.texel_bytes))));
  const int of_lobes = fetches.back();
  std::ranges::sort(fetches);
  const SourceTraits traits = traits_of(source);
  struct Candidate {
    int fetches;
    std::optional<ModelSpec> spec;  ///< none: lobes
  };
  std::vector<Candidate> candidates;
  for (const int n : fetches) {
    limit.fetches = n;
    if (!holds_model(source, limit)) continue;
    Candidate next{.fetches = of_lobes, .spec = {}};
    if (!takes_lobes(source, limit)) {
      next.spec = volume_spec(kForms[0], Beside::line, limit, source.channels(),
                              {traits.twisted, traits.ordered && n > 1, traits.retro});
      next.fetches = static_cast<int>(fetch_count(*next.spec));
    }
    if (candidates.empty() || candidates.back().fetches != next.fetches)
      candidates.push_back(std::move(next));
  }

  // side by side
  const IsotropicTrials sets(mean_of_channels(set));
  const double shares = options.shares.sum();
  std::vector<FetchTrial> trials(candidates.size());
  for_each_chunk(candidates.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
    const Candidate& candidate = candidates[k];
    const double value = candidate.spec ? sets.try_volume(*candidate.spec, options).objective
                                        : sets.objective_of(lobes, limit, options);
    trials[k] = {.fetches = candidate.fetches, .lobes = !candidate.spec, .error = std::exp(value / shares)};
  });
  return trials;
}

const FetchTrial& trial_at_knee(std::span<const FetchTrial> trials) {
  const double least = std::ranges::min(trials, {}, &FetchTrial::error).error;
  return *std::ranges::find_if(trials,
                               [&](const FetchTrial& trial) { return trial.error <= kKneeFactor * least; });
}

TrainingOptions training_for_volumes(const CostLimit& limit) {
  const std::size_t texels = limit.bytes / limit.texel_bytes,
                    times = std::clamp<std::size_t>(texels / 8192, 1, 4);
  return {.pictures = times * 40'000, .directions = times * 50'000, .crowded = true};
}

TrainingSet with_frontal_pixels(BrdfRef source, TrainingSet set, double share) {
  const auto count = static_cast<std::size_t>(share * static_cast<double>(set.picture_count));
  const auto channels = set.channels;

  // low-discrepancy normals, half of them uniform on the disk, half with theta = pi/2 u^2
  std::vector<DirectionPair> pairs;
  std::vector<float> weights;
  for (std::size_t i = 0; i < count; ++i) {
    const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(count), v = std::fmod(2 * u, 1.0),
                 phi = kTwoPi * std::fmod(static_cast<double>(i) * kGoldenStep, 1.0);
    const double theta = u < 0.5 ? std::asin(std::sqrt(v)) : kHalfPi * v * v;
    if (!(std::cos(theta) > kFrontalCosine) || !(theta > 0)) continue;
    const double even = std::sin(2 * theta), crowded = 1 / std::sqrt(kTwoPi * theta);
    const Vec3 w{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    pairs.push_back({w, w});
    weights.push_back(static_cast<float>(2 * even / (even + crowded)));
  }
  std::vector<double> values(pairs.size() * channels);
  std::vector<std::uint8_t> known(pairs.size());
  source.eval(pairs, values, known);

  // after the pixels that there are
  TrainingSet more = set;
  const auto cut = [&](auto& v, std::size_t at) {
    v.erase(v.begin() + static_cast<std::ptrdiff_t>(at), v.end());
  };
  cut(more.pairs, set.picture_count);
  cut(more.weights, set.picture_count);
  cut(more.values, set.picture_count * channels);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!known[i]) continue;
    more.pairs.push_back(pairs[i]);
    more.weights.push_back(weights[i]);
    for (std::size_t c = 0; c < channels; ++c)
      more.values.push_back(static_cast<float>(std::max(values[i * channels + c], 0.0)));
  }
  more.picture_count = more.size();
  const auto append = [](auto& to, const auto& from, std::size_t at) {
    to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(at), from.end());
  };
  append(more.pairs, set.pairs, set.picture_count);
  append(more.weights, set.weights, set.picture_count);
  append(more.values, set.values, set.picture_count * channels);
  return more;
}

LobesFit fit_volumes(const TrainingSet& set, const std::vector<ModelSpec>& specs,
                     const RefineOptions& options) {
  const auto [spec, trial] = best_of(specs, set, options);

  // few nodes and pairs, from where a trial came to
  const TrainingSet coarse = about(set, kCoarsePairs);
  const bool many = coupled_unknowns(spec, 1) > kCoarseNodes;
  const ModelSpec start = many ? at_fewer_nodes(spec, kCoarseShare) : spec;
  LobesFit fit{.model = trial ? resampled(*trial, start) : fit_one_lobe(start, coarse, coarse.values, kStart),
               .summary = {}};
  const auto refine_part = [&](const TrainingSet& part, TableFormat format, int steps, double from,
                               double to) {
    RefineOptions these = options;
    these.format = format;
    these.max_iterations = std::min(steps, options.max_iterations);
    these.progress = part_of_progress(options.progress, from, to);
    const FitSummary done = refine(fit.model, part, these);
    const int before = fit.summary.iterations;
    fit.summary = done;
    fit.summary.iterations += before;
  };
  refine_part(coarse, TableFormat::single, trial ? kCoarseStepsAfterTrial : kCoarseSteps, kTrialTime,
              kCoarseTime);

  // all of them; what shares an exponent is held in its reach only once it stands
  if (many) fit.model = resampled(fit.model, spec);
  refine_part(set, TableFormat::single, many ? kManyFullSteps : kFullSteps, kCoarseTime, kFullTime);
  refine_part(set, options.format, many ? kManyHeldSteps : kHeldSteps, kFullTime, 1);
  return fit;
}

}  // namespace burnish
