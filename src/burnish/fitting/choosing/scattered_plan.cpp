// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/byte_count.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/choosing/scattered_forms.h>
#include <burnish/fitting/choosing/scattered_plan.h>
#include <burnish/fitting/one_lobe/cross_validation.h>

namespace burnish {

namespace {

constexpr std::size_t kFolds = 5;

// All channels share one smoothness, so that a few channels are enough to find it.
constexpr std::size_t kTrialChannels = 3;

// The smoothness of the lobe about wi = wo for many samples, as trials found it for a tape with 7,400. Trials on many
// samples would choose a rougher lobe. Those samples are at few incidences, which every fold contains, so errors
// between the incidences would not be noticed.
constexpr double kRetroSmooth = 1e-7;

std::size_t texels_of(const ModelSpec& spec) {
  std::size_t sum = 0;
  for (const ModelSpec::TableSpec& table : spec.tables) sum += table.layout.node_count();
  return sum;
}

// Returns the source with at most kTrialChannels of its channels, evenly spread.
SampleSource some_channels(const SampleSource& source) {
  const auto channels = source.channels;
  if (channels <= kTrialChannels) return source;
  SampleSource part = source;
  part.channels = kTrialChannels;
  part.fill = [&source, channels](std::size_t begin, std::span<DirectionPair> pairs, std::span<double> values,
                                  std::span<double> weights) {
    std::vector<double> all(pairs.size() * channels);
    source.fill(begin, pairs, all, weights);
    for (std::size_t i = 0; i < pairs.size(); ++i)
      for (std::size_t k = 0; k < kTrialChannels; ++k)
        values[i * kTrialChannels + k] = all[i * channels + (2 * k + 1) * channels / (2 * kTrialChannels)];
  };
  return part;
}

/// Compares models by their predictions.
class Trials {
 public:
  Trials(const SampleSource& source, bool fixed_smooth, const HomomorphicOptions& options)
      : source_(source), fixed_smooth_(fixed_smooth), options_(options) {
    options_.progress = nullptr;
  }

  /// Sets the format of all later trials.
  void store_as(TableFormat format) { options_.format = format; }

  /// Tries the first model, with the given smoothness if there is one.
  ScatteredPlan start(ModelSpec spec, std::optional<double> smooth,
                      const std::function<void(double)>& progress) {
    if (smooth) return attempt(std::move(spec), *smooth);
    HomomorphicOptions options = options_;
    options.progress = progress;
    const SmoothTrial best = choose_smoothness(source_, spec, options).front();
    for (std::size_t t = 0; t < spec.tables.size(); ++t) spec.tables[t].smooth_share = best.shares[t];
    return {.spec = std::move(spec), .smooth = best.smooth, .error = best.error, .format = options_.format};
  }

  /// Tries another model, from the smoothness of a known one, or from `smooth` if that is better. Then changes the
  /// smoothness by decades in either direction as long as that helps.
  ScatteredPlan near(const ModelSpec& spec, const ScatteredPlan& known, std::optional<double> smooth = {}) {
    ModelSpec alike = spec;
    for (ModelSpec::TableSpec& table : alike.tables)
      for (const ModelSpec::TableSpec& other : known.spec.tables)
        if (table.name == other.name) table.smooth_share = other.smooth_share;
    ScatteredPlan best = attempt(std::move(alike), known.smooth);
    if (fixed_smooth_) return best;
    if (smooth)
      if (ScatteredPlan other = attempt(spec, *smooth); *other.error < *best.error) best = std::move(other);
    climb(best, [](ScatteredPlan& plan, double factor) { plan.smooth *= factor; });
    for (std::size_t t = 0; t < best.spec.tables.size(); ++t)
      climb(best, [t](ScatteredPlan& plan, double factor) { plan.spec.tables[t].smooth_share *= factor; });
    return best;
  }

 private:
  ScatteredPlan attempt(ModelSpec spec, double smooth) {
    options_.smooth = smooth;
    const double error = held_out_error(source_, spec, options_, kFolds);
    return {.spec = std::move(spec), .smooth = smooth, .error = error, .format = options_.format};
  }

  // Applies a change by decades in either direction as long as it helps.
  template <class Change>
  void climb(ScatteredPlan& best, const Change& change) {
    constexpr int kDecades = 4;
    for (const double factor : {0.1, 10.0}) {
      int moved = 0;
      for (bool better = true; better && moved < kDecades; moved += better) {
        ScatteredPlan trial = best;
        change(trial, factor);
        trial = attempt(std::move(trial.spec), trial.smooth);
        better = *trial.error < *best.error;
        if (better) best = std::move(trial);
      }
      if (moved > 0) return;  // the other direction would undo it
    }
  }

  const SampleSource& source_;
  bool fixed_smooth_;
  HomomorphicOptions options_;
};

// Returns the lobe about wi = wo, if options ask for one and bytes and fetches hold it.
std::optional<ModelSpec> asked_retro_spec(const SampleSource& source, std::size_t bytes,
                                          const HomomorphicOptions& options, int fetches) {
  if (options.backscatter <= 0) return std::nullopt;
  return retro_spec_within(bytes, source, options.format, fetches);
}

// Returns the plan for many samples: a model as fine as the bytes hold, or the lobe about wi = wo if it predicts
// better.
ScatteredPlan plan_many(const SampleSource& source, std::size_t bytes, std::optional<double> smooth,
                        const HomomorphicOptions& options, int fetches) {
  // Trials are the same as those of choose_smoothness for many samples.
  const auto error_at = [&](const ModelSpec& spec, double smoothness) {
    HomomorphicOptions trial = options;
    trial.smooth = smoothness;
    trial.reweightings = 0;
    return held_out_error(source, spec, trial, 2);
  };
  const auto planned = [&](ModelSpec spec) {
    Trials trials(source, smooth.has_value(), options);
    ScatteredPlan best = trials.start(std::move(spec), smooth, options.progress);
    if (auto retro = asked_retro_spec(source, bytes, options, fetches)) {
      const double smoothness = smooth.value_or(kRetroSmooth);
      if (error_at(*retro, smoothness) < error_at(best.spec, best.smooth))
        best = {.spec = std::move(*retro), .smooth = smoothness, .error = {}, .format = options.format};
    }
    best.error.reset();
    return best;
  };
  const std::size_t texel = texel_bytes(options.format, source.channels);
  for (std::size_t within = bytes;; within -= std::min(within, texel)) {
    LobePlan plan = default_plan(within, source.isotropic ? 1 : 2, source.isotropic, texel);
    plan.wide.clear();
    plan.wide_texels = 0;
    ModelSpec spec = plan_to_spec(plan, within, source.channels, texel);
    if (model_bytes(spec, source.channels, options.format) > bytes) continue;
    if (fetches > 0 && fetch_count(spec) > static_cast<std::size_t>(fetches))
      for (const std::string& set : scattered_factor_sets(fetches, source.isotropic))
        if (auto fewer = scattered_spec(set, bytes, bytes, source, options.format)) return planned(*fewer);
    return planned(std::move(spec));
  }
}

}  // namespace

ScatteredPlan plan_scattered(const SampleSource& source, std::size_t bytes, std::optional<double> smooth,
                             std::optional<TableFormat> format, const HomomorphicOptions& options,
                             int fetches) {
  // The formats to choose from; the first is the default.
  std::vector<TableFormat> formats{format.value_or(TableFormat::half)};
  if (!format && source.channels == 3) formats.push_back(TableFormat::rgb9e5);
  const auto least = [&](TableFormat of) {
    return least_scattered_bytes(source.channels, source.isotropic, of);
  };
  const auto too_large = [&](TableFormat of) { return least(of) > bytes; };
  if (std::ranges::all_of(formats, too_large))
    throw Error(
        fmt::format("fit: expected a budget of at least {} bytes for {} channels in format {}, found {}",
                    least(formats.back()), source.channels, to_string(formats.back()), bytes));
  std::erase_if(formats, too_large);
  HomomorphicOptions chosen = options;
  chosen.format = formats.front();
  if (source.distinct > kManySamples) return plan_many(source, bytes, smooth, chosen, fetches);

  // The models go from coarse to fine as long as that helps, or through all sets of factors.
  const SampleSource part = some_channels(source);
  Trials trials(part, smooth.has_value(), chosen);
  const std::vector<std::string> sets = scattered_factor_sets(fetches, source.isotropic);
  std::vector<ModelSpec> specs = scattered_specs(source, bytes, formats.front(), sets);
  std::vector<ScatteredPlan> found{trials.start(specs.front(), smooth, options.progress)};
  const auto best = [&] { return std::ranges::min_element(found, {}, &ScatteredPlan::error); };
  for (auto spec = specs.begin() + 1; spec != specs.end(); ++spec)
    found.push_back(trials.near(*spec, *best()));
  // If the models without a lobe about wi = wo are best as constants, their smoothness is no guide for this lobe. So
  // kRetroSmooth is tried too.
  if (const auto spec = asked_retro_spec(source, bytes, chosen, fetches)) {
    found.push_back(trials.near(*spec, *best(), kRetroSmooth));
    specs.push_back(*spec);
  }
  // The smaller format is tried if it resolves more.
  for (auto other = formats.begin() + 1; other != formats.end(); ++other) {
    trials.store_as(*other);
    const ModelSpec finest = scattered_specs(source, bytes, *other, sets).back();
    if (texels_of(finest) > texels_of(specs.back())) found.push_back(trials.near(finest, *best()));
  }

  // Finally the errors of all channels are compared.
  if (part.channels != source.channels)
    for (ScatteredPlan& plan : found) {
      chosen.smooth = plan.smooth;
      plan.error = held_out_error(source, plan.spec, chosen, kFolds);
    }
  return *best();
}

}  // namespace burnish
