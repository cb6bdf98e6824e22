// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/choosing/frontal_pixels.h>
#include <burnish/fitting/choosing/overfit.h>
#include <burnish/fitting/fitted_source.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/node_figures.h>
#include <burnish/reflectance/outliers.h>

namespace burnish {

namespace {

constexpr std::size_t kMostScattered = 150'000;  // if there are more samples, a part is fitted, to save time
constexpr double kFrontalShare = 0.1;            // share of pixels, see with_frontal_pixels

// Pairs that the fit did not see, for the reported error.
constexpr std::size_t kHeldOutPairs = 20'000;
constexpr int kHeldOutSphereSize = 128;  // baselines use the defaults of FigureOptions

/// Returns evenly spaced samples, at most `most` of them.
Samples at_most(std::size_t most, const Samples& samples) {
  const std::size_t step = (samples.size() + most - 1) / most;
  if (step <= 1) return samples;
  std::vector<std::size_t> subset;
  for (std::size_t i = 0; i < samples.size(); i += step) subset.push_back(i);
  return select(samples, subset);
}

}  // namespace

std::function<void(double)> Stages::of(std::string stage) const {
  if (!options_->progress) return nullptr;
  stage += what_;
  return
      [options = options_, stage = std::move(stage)](double fraction) { options->progress(stage, fraction); };
}

Stages Stages::with(std::string_view what) const {
  Stages more = *this;
  more.what_ += what;
  return more;
}

FittedSource::FittedSource(const Source& source, const FitOptions& options, const Stages& stages)
    : source_(source), options_(options), brdf_(source.ref()) {
  if (options.samples == std::size_t{0}) throw Error("fit: expected at least one sample, found 0");
  if (options.symmetrize) symmetrized_.emplace(brdf_);
  if (options.target.value_or(default_target(source, options)) == FitTarget::nodes)
    take_nodes(stages);
  else if (options.hold_out)
    throw Error("fit: expected nodes as the target with nodes held out, found function");
}

BrdfRef FittedSource::reference() const {
  if (between_) return *between_;
  return symmetrized_ ? BrdfRef(*symmetrized_) : brdf_;
}

const Samples* FittedSource::samples() const noexcept {
  if (between_) return nullptr;
  return nodes_ ? &nodes_->samples : source_.samples();
}

const HalfDiffTable* FittedSource::table() const noexcept {
  return nodes_ ? nullptr : std::get_if<HalfDiffTable>(&source_.brdf);
}

void FittedSource::take_nodes(const Stages& stages) {
  // Held-out nodes and outliers among scattered samples are left out.
  nodes_ = measured_nodes(source_);
  if (options_.hold_out) nodes_ = nodes_without(*nodes_, *options_.hold_out);
  const std::size_t measured = nodes_->size();
  if (source_.samples()) nodes_ = without_outliers(*std::move(nodes_));
  NodesReport& report =
      nodes_report_.emplace(NodesReport{.fitted = nodes_->size(), .outliers = measured - nodes_->size()});
  if (!nodes_->samples.isotropic) return;

  // An isotropic source is interpolated between nodes by the function that predicts left-out nodes best.
  const auto told = stages.of("kriging the nodes");
  report.covariance = choose_covariance(*nodes_, told);
  report.held_out = held_out_figures(*nodes_, *report.covariance);
  const BrdfRef function = symmetrized_ ? BrdfRef(*symmetrized_) : brdf_;
  if (source_.samples())
    between_.emplace(*nodes_, *report.covariance);
  else
    between_.emplace(with_gaps_filled(*nodes_, measured_nodes(source_), function), *report.covariance);
  if (told) told(1);
}

TrainingSet FittedSource::drawn_set(TrainingOptions drawn, const Stages& stages) const {
  drawn.seed = options_.seed;
  if (samples()) return training_set_of(at_most(kMostScattered, *samples()), options_.symmetrize);
  if (const auto sampling = stages.of("sampling")) sampling(0);
  TrainingSet set = with_frontal_pixels(reference(), draw_training_set(reference(), drawn), kFrontalShare);
  if (judged_at_nodes()) add_nodes(set);
  return set;
}

/// Adds pairs at the nodes, with the function's values. Nodes are dense at highlights. Together these pairs have the
/// same weight as the other pairs.
void FittedSource::add_nodes(TrainingSet& set) const {
  const double others = std::accumulate(set.weights.begin() + static_cast<std::ptrdiff_t>(set.picture_count),
                                        set.weights.end(), 0.0);
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < nodes_->size(); ++i)
    if (std::min(nodes_->samples.pairs[i].wi.z, nodes_->samples.pairs[i].wo.z) > NodeScoring{}.least_cosine)
      near.push_back(i);
  std::vector<double> f(set.channels);
  for (const std::size_t i : near) {
    const DirectionPair& pair = nodes_->samples.pairs[i];
    between_->eval(pair.wi, pair.wo, f);
    set.pairs.push_back(pair);
    set.weights.push_back(static_cast<float>(others / static_cast<double>(near.size())));
    for (const double value : f) set.values.push_back(static_cast<float>(value));
  }
}

TrainingSet FittedSource::training_set(bool spread_phi_h) const {
  if (samples()) return training_set_of(*samples(), options_.symmetrize);
  TrainingOptions drawn = training_for(0, 1, isotropic());
  drawn.seed = options_.seed;
  drawn.spread_phi_h = spread_phi_h;
  return with_frontal_pixels(reference(), draw_training_set(reference(), drawn), kFrontalShare);
}

SampleSource FittedSource::sample_source(std::size_t drawn, bool spread_phi_h,
                                         const HalfDiffTable* table) const {
  if (samples()) return from_samples(*samples(), options_.symmetrize);
  if (table) return from_table(*table, options_.symmetrize, spread_phi_h);
  return from_brdf(reference(), options_.samples.value_or(drawn), options_.seed, spread_phi_h);
}

TableFormat FittedSource::format() const {
  if (!options_.format) return channels() == 3 ? TableFormat::rgb9e5 : TableFormat::half;
  check_format(*options_.format);
  return *options_.format;
}

void FittedSource::check_format(TableFormat format) const {
  if (!holds_channels(format, channels()))
    throw Error(
        fmt::format("format {}: expected a source of 3 channels, found {}", to_string(format), channels()));
}

FigureOptions FittedSource::held_out_of_baselines() const {
  return {.count = kHeldOutPairs, .seed = options_.seed + 1};
}

FigureOptions FittedSource::held_out() const {
  FigureOptions figures = held_out_of_baselines();
  figures.image_size = kHeldOutSphereSize;
  return figures;
}

NoiseScale FittedSource::noise_scale() const {
  if (nodes_) return {*nodes_, nodes_report_->held_out};
  if (const Samples* all = samples()) return {measured_nodes(*all), {}};
  return {source_, reference(), options_.symmetrize, held_out()};
}

}  // namespace burnish
