// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <burnish/capture/ranks/sampled_texels.h>
#include <burnish/capture/ranks/shared_refinement.h>
#include <burnish/capture/ranks/shared_work.h>
#include <burnish/capture/surface_lobes.h>
#include <burnish/capture/surface_normals.h>
#include <burnish/capture/texels/texel_starts.h>
#include <burnish/capture/training_pixels.h>
#include <burnish/error.h>
#include <burnish/fitting/one_lobe/homomorphic.h>
#include <burnish/fitting/refinement/log_model.h>
#include <burnish/fitting/refinement/refine.h>
#include <burnish/fitting/refinement/rounding.h>

namespace burnish {

namespace {

// The number of values of a capture that are kept to fit lobes to.
constexpr std::size_t kSampleValues = 6'000'000;
// Pixels that lobes are refined on: half of them count as pixels, half as pairs.
constexpr std::size_t kTrainingPixels = 150'000, kStartPixels = 15'000;
constexpr std::uint64_t kFirstRoundStream = 100;  // for training pixels; smaller ones are for starts
// The same shares as for models with volumes (fitting/fit.cpp).
constexpr ErrorTerms kShares{.pictures = 3, .dimmed = 0.3, .relative = 0.4, .log_cos = 0.4};
// Volumes are smooth, so that they are sound at directions that no picture has; lines hold what is narrow.
constexpr double kSmooth = 1e-6, kLineSmoothShare = 1e-3;
// The first rounds use few nodes, few texels and few pixels.
constexpr double kCoarseShare = 1.0 / 6;
constexpr std::size_t kCoarsePixels = 24'000;
constexpr std::size_t kCoarseTexels = 1500;
constexpr int kCoarseSteps = 2, kFullSteps = 4, kLastSteps = 6, kFullRounds = 3;
const HomomorphicOptions kStart{
    .smooth = 1e-5, .floor = PictureLoss::kFloor, .tolerance = 0.03, .progress = {}};
// Nodes of a lobe's tables, relative to each other: theta_h, theta_d, phi_d.
constexpr double kHalfNodes = 30, kDifferenceNodes = 20, kAzimuthNodes = 6;
constexpr double kLineShare = 0.07;
constexpr std::size_t kTexelBytes = 4;  // rgb9e5
constexpr double kCodeRoom = 1.25;      // a weight's scale over nearly all texels' values
constexpr double kNearlyAll = 0.999;

/// Returns the model of K lobes z(theta_h) g(theta_h,theta_d,phi_d), each of that many bytes.
ModelSpec spec_of_lobes(std::size_t lobes, std::size_t bytes) {
  const double texels = static_cast<double>(bytes / kTexelBytes) - 4;
  const int line = std::clamp(static_cast<int>(kLineShare * texels), 8, 256);
  const double scale = std::cbrt((texels - line) / (kHalfNodes * kDifferenceNodes * kAzimuthNodes));
  const auto nodes = [&](double share, int least) {
    return std::max(least, static_cast<int>(share * scale));
  };
  const int x = nodes(kHalfNodes, 4), y = nodes(kDifferenceNodes, 3), z = nodes(kAzimuthNodes, 2);
  std::string model;
  std::vector<std::string> tables;
  for (std::size_t j = 0; j < lobes; ++j) {
    // names are letters
    const std::string suffix(1, static_cast<char>('a' + j));
    model += fmt::format("{}z{}(theta_h) g{}(theta_h,theta_d,phi_d)", j > 0 ? " + " : "", suffix, suffix);
    tables.push_back(fmt::format("z{}={},power:0.5", suffix, line));
    tables.push_back(fmt::format("g{}={}x{}x{},power:0.5", suffix, x, y, z));
  }
  ModelSpec spec = parse_model_spec(model, tables, true);
  for (ModelSpec::TableSpec& table : spec.tables)
    if (table.layout.shape == TableShape::line) table.smooth_share = kLineSmoothShare;
  return spec;
}

/// The values that all steps of the lobes see. None of them changes once texels are sampled.
struct LobeSetting {
  const SurfaceTask& task;
  const CaptureForm& form;
  double exposure;
  bool clipped;  // true if any fitted pixel is

  bool is_coarse(int round) const noexcept { return round + kFullRounds < task.rounds; }
  /// Returns the bytes of each lobe's tables in a round.
  std::size_t bytes_in(int round) const noexcept {
    const std::size_t all = task.options.lobe_bytes;
    const auto few = static_cast<std::size_t>(kCoarseShare * static_cast<double>(all));
    return is_coarse(round) ? std::max(few, kMinLobeBytes) : all;
  }
};

/// Lobes after a number of rounds; after 0 rounds as they start.
struct LobesInRounds {
  int rounds = 0;
  LogModel model;
  FactoredBrdf brdf;  // the model's; after the last round rounded to what is stored
};

/// Some texels, and the values found for them under the latest lobes: only normals before the first lobes.
struct FittedTexels {
  TexelSamples samples;
  TexelFits fits;
};

[[noreturn]] void refuse_checkpoint(const SurfaceTask& task) {
  throw Error::in_file(task.options.checkpoint.string(), "lobes and texels of this capture", "others");
}

/// Returns the normals that texels begin with.
std::vector<float> starting_normals(const LobeSetting& setting, const TexelSamples& samples) {
  const SurfaceTask& task = setting.task;
  if (task.normals != NormalsFrom::estimate)
    return normals_at(samples.texels, task.known_normals, setting.form.width);
  task.progress("normals", 0);
  std::vector<float> normals = first_normals(samples, setting.form, setting.exposure, task.options.crew);
  task.progress("normals", 1);
  return normals;
}

/// Finds weights and trust, and unknown normals, starting from the normals that the texels have.
void fit_texels(const LobeSetting& setting, const FactoredBrdf& lobes, bool last, FittedTexels& texels) {
  const SurfaceTask& task = setting.task;
  const TexelSolver solver(lobes, setting.form, setting.exposure);
  texels.fits = solve_together(task.options.crew, solver, texels.samples, std::move(texels.fits.normals),
                               {.passes = 3,
                                .normals = task.normals == NormalsFrom::estimate,
                                .normal_steps = last ? 8 : 4,
                                .trust = true});
}

/// Returns first lobes, each the log-linear fit to texels that look like one material. Fits the texels to them.
LobesInRounds started_lobes(const LobeSetting& setting, FittedTexels& texels) {
  const SurfaceTask& task = setting.task;
  const SurfaceFitOptions& options = task.options;
  task.progress("starting lobes", 0);
  const auto sets =
      pure_texels(texels.samples, setting.form, texels.fits.normals, setting.exposure, options.lobes);
  const std::size_t bytes = setting.bytes_in(0);
  const ModelSpec spec = spec_of_lobes(options.lobes, bytes), alone = spec_of_lobes(1, bytes);
  const KnownTexels known{.samples = texels.samples,
                          .form = setting.form,
                          .exposure = setting.exposure,
                          .fits = texels.fits,
                          .lobes = nullptr,
                          .trust = PixelTrust::alike};
  const auto started = made_together(options.crew, sets.size(), [&](std::size_t j) {
    const TrainingSet set = training_pixels(known, sets[j], kStartPixels, options.seed, j);
    const LogModel lobe = fit_one_lobe(alone, set, set.values, kStart);
    std::string made;
    for (const auto& table : lobe.log_values) append_values<double>(made, table);
    task.progress("starting lobes", static_cast<double>(j + 1) / static_cast<double>(sets.size()));
    return made;
  });
  LobesInRounds lobes{
      .rounds = 0, .model = {.spec = spec, .channels = kCaptureChannels, .log_values = {}}, .brdf = {}};
  std::vector<std::vector<double>>& tables = lobes.model.log_values;
  for (const ModelSpec::TableSpec& table : spec.tables)
    tables.emplace_back(table.layout.node_count() * kCaptureChannels);
  for (std::size_t j = 0, t = 0; j < started.size(); ++j)
    for (std::string_view rest = started[j]; !rest.empty(); ++t) take_values<double>(rest, tables[t]);
  lobes.brdf = to_brdf(lobes.model, TableFormat::single);
  fit_texels(setting, lobes.brdf, false, texels);
  return lobes;
}

/// Returns the lobes of a checkpoint and moves its tables out.
LobesInRounds resumed_lobes(const LobeSetting& setting, LobesCheckpoint& begun) {
  const SurfaceTask& task = setting.task;
  const ModelSpec spec = spec_of_lobes(task.options.lobes, setting.bytes_in(begun.rounds - 1));
  const bool alike = begun.rounds < task.rounds &&
                     std::ranges::equal(begun.log_values, spec.tables, {}, &std::vector<double>::size,
                                        [](const ModelSpec::TableSpec& table) {
                                          return table.layout.node_count() * kCaptureChannels;
                                        });
  if (!alike) refuse_checkpoint(task);
  LobesInRounds lobes{
      .rounds = begun.rounds,
      .model = {.spec = spec, .channels = kCaptureChannels, .log_values = std::move(begun.log_values)},
      .brdf = {}};
  lobes.brdf = to_brdf(lobes.model, TableFormat::single);
  return lobes;
}

/// Takes the texels of a checkpoint, to which its round was fitted. If they are a part, takes the normals of all too.
void resume_texels(const LobeSetting& setting, std::size_t lobes, LobesCheckpoint begun, FittedTexels& texels,
                   std::vector<float>& normals_of_all) {
  if (begun.fits.weights.size() != texels.samples.size() * lobes ||
      begun.fits.normals.size() != texels.fits.normals.size() ||
      begun.fits.trust.size() != texels.samples.states.size() ||
      begun.normals_of_all.size() != normals_of_all.size())
    refuse_checkpoint(setting.task);
  texels.fits = std::move(begun.fits);
  normals_of_all = std::move(begun.normals_of_all);
}

/// Returns the trust in pixels in a round. Before the first refinement the lobes are wrong, not the pixels. Where
/// highlights are clipped, the few unclipped pixels tell how bright lobes are, but look like outliers until lobes are
/// bright. So large errors alone count against a pixel while lobes have few nodes.
PixelTrust trust_in(const LobeSetting& setting, int round) noexcept {
  if (round == 0) return PixelTrust::alike;
  return setting.clipped && setting.is_coarse(round) ? PixelTrust::mild : PixelTrust::as_found;
}

/// One round: fits the lobes to pixels of the texels, then the texels to the lobes. Writes both to the checkpoint,
/// with the normals of all texels if these texels are a part.
void refine_round(const LobeSetting& setting, const std::vector<float>& normals_of_all, LobesInRounds& lobes,
                  FittedTexels& texels) {
  const SurfaceTask& task = setting.task;
  const int round = lobes.rounds;
  const bool last = round + 1 == task.rounds, coarse = setting.is_coarse(round);
  LogModel& model = lobes.model;
  if (round > 0 && setting.bytes_in(round) != setting.bytes_in(round - 1))
    model = resampled(model, spec_of_lobes(task.options.lobes, setting.bytes_in(round)));
  std::vector<std::size_t> all(texels.samples.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const KnownTexels known{.samples = texels.samples,
                          .form = setting.form,
                          .exposure = setting.exposure,
                          .fits = texels.fits,
                          .lobes = &lobes.brdf,
                          .trust = trust_in(setting, round)};
  const TrainingSet set = ordered_by_cells(
      training_pixels(known, all, coarse ? kCoarsePixels : kTrainingPixels, task.options.seed,
                      kFirstRoundStream + static_cast<std::uint64_t>(round)),
      model.spec);
  const RefineOptions options{
      .shares = kShares,
      .smooth = kSmooth,
      .format = last ? TableFormat::rgb9e5 : TableFormat::single,
      .max_iterations = last     ? kLastSteps
                        : coarse ? kCoarseSteps
                                 : kFullSteps,
      .progress = [&](double f) { task.progress("fitting lobes", (round + f) / task.rounds); }};
  refine_together(task.options.crew, model, set, options);
  lobes.brdf = last ? to_rounded_brdf(model, set, options) : to_brdf(model, TableFormat::single);
  lobes.rounds = round + 1;
  fit_texels(setting, lobes.brdf, last, texels);
  if (!last && task.notes_progress())
    write_then_rename(task.options.checkpoint,
                      format_checkpoint(LobesCheckpoint{.key = task.key,
                                                        .rounds = lobes.rounds,
                                                        .log_values = model.log_values,
                                                        .fits = texels.fits,
                                                        .normals_of_all = normals_of_all}));
}

/// Runs the rounds whose lobes have few nodes, on every step-th texel. Then fits all texels, starting from the
/// normals that they had before.
void refine_coarsely(const LobeSetting& setting, std::size_t step, std::optional<LobesCheckpoint> begun,
                     LobesInRounds& lobes, FittedTexels& texels) {
  FittedTexels part{.samples = every(texels.samples, step),
                    .fits = {.weights = {}, .normals = every_normal(texels.fits.normals, step)}};
  if (begun)
    resume_texels(setting, lobes.brdf.lobes().size(), std::move(*begun), part, texels.fits.normals);
  else
    fit_texels(setting, lobes.brdf, false, part);
  while (setting.is_coarse(lobes.rounds)) refine_round(setting, texels.fits.normals, lobes, part);
  fit_texels(setting, lobes.brdf, true, texels);
}

/// Returns the lobes after all rounds of the task. `texels` begins with normals and ends with all that is fitted to
/// them.
FactoredBrdf fitted_lobes(const LobeSetting& setting, std::optional<LobesCheckpoint> begun,
                          FittedTexels& texels) {
  LobesInRounds lobes = begun ? resumed_lobes(setting, *begun) : started_lobes(setting, texels);
  // Only a part of the texels is used until a round has seen all of them.
  const std::size_t step = texels.samples.size() / kCoarseTexels;
  const bool seen_all = lobes.rounds > 0 && !setting.is_coarse(lobes.rounds - 1);
  std::vector<float> no_more;  // normals: the texels are not a part
  if (step > 1 && setting.is_coarse(0) && !seen_all)
    refine_coarsely(setting, step, std::move(begun), lobes, texels);
  else if (begun)
    resume_texels(setting, lobes.brdf.lobes().size(), std::move(*begun), texels, no_more);
  while (lobes.rounds < setting.task.rounds) refine_round(setting, {}, lobes, texels);
  return std::move(lobes.brdf);
}

/// Returns the scale of each lobe's weights: a value that nearly all sampled texels stay below, with some room.
std::vector<float> scales_of(const std::vector<float>& weights, std::size_t lobes) {
  std::vector<float> scales;
  for (std::size_t j = 0; j < lobes; ++j) {
    std::vector<float> own;
    for (std::size_t at = j; at < weights.size(); at += lobes) own.push_back(weights[at]);
    const std::size_t at = static_cast<std::size_t>(kNearlyAll * static_cast<double>(own.size() - 1));
    std::ranges::nth_element(own, own.begin() + static_cast<std::ptrdiff_t>(at));
    const auto scale = static_cast<float>(kCodeRoom * static_cast<double>(own[at]));
    scales.push_back(scale > 0 ? scale : 1);
  }
  return scales;
}

}  // namespace

SurfaceLobes find_lobes(Capture& capture, const SurfaceTask& task, std::optional<LobesCheckpoint> begun) {
  // Small steps run at every rank. Reading, starts, channels and texels are shared by the ranks.
  const SurfaceFitOptions& options = task.options;
  SampledTexels sampled = sample_texels(
      capture, kSampleValues, options.tile_bytes, options.seed,
      [&](double f) { task.progress("reading pictures", f); }, options.crew);
  const LobeSetting setting{.task = task,
                            .form = capture.form(),
                            .exposure = exposure_of(sampled.samples, capture.form()),
                            .clipped = sampled.clipped > 0};
  FittedTexels texels{.samples = std::move(sampled.samples), .fits = {}};
  texels.fits.normals = starting_normals(setting, texels.samples);
  SurfaceLobes found{.lobes = {},
                     .scales = {},
                     .exposure = setting.exposure,
                     .missing_pixels = sampled.missing,
                     .clipped_pixels = sampled.clipped};
  if (options.book) {
    found.lobes = *options.book;
    fit_texels(setting, found.lobes, true, texels);
  } else {
    found.lobes = fitted_lobes(setting, std::move(begun), texels);
  }
  found.scales = scales_of(texels.fits.weights, found.lobes.lobes().size());
  return found;
}

}  // namespace burnish
