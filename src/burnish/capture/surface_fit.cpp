#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <hwy/cache_control.h>
#include <nlohmann/json.hpp>

#include <burnish/capture/ranks/fit_checkpoint.h>
#include <burnish/capture/ranks/sampled_texels.h>
#include <burnish/capture/ranks/shared_work.h>
#include <burnish/capture/surface_fit.h>
#include <burnish/capture/surface_report_json.h>
#include <burnish/capture/texels/texel_starts.h>
#include <burnish/error.h>
#include <burnish/eval/lobe_evaluator.h>
#include <burnish/factors/compact_file.h>
#include <burnish/fitting/fit_report_json.h>
#include <burnish/fitting/refinement/log_model.h>
#include <burnish/fitting/refinement/lookups.h>
#include <burnish/fitting/refinement/refine.h>
#include <burnish/fitting/refinement/rounding.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/surface/widened_lobes.h>

namespace burnish {

namespace {

template <class Task>
double seconds_of(const Task& task) {
  const auto start = std::chrono::steady_clock::now();
  task();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::size_t lights_and_views(const CaptureForm& form) {
  std::vector<std::array<double, 8>> pairs;
  for (const auto& [file, light, view, scale, mask, held_out] : form.pictures)
    if (!held_out)
      pairs.push_back({light.is_direction ? 1.0 : 0.0, light.at.x, light.at.y, light.at.z,
                       view.is_direction ? 1.0 : 0.0, view.at.x, view.at.y, view.at.z});
  std::ranges::sort(pairs);
  return static_cast<std::size_t>(std::ranges::unique(pairs).begin() - pairs.begin());
}

// What of a capture is kept to fit lobes to.
constexpr std::size_t kSampleValues = 6'000'000;
// Pixels that lobes are refined on: half of them count as pixels, half as pairs.
constexpr std::size_t kTrainingPixels = 150'000, kStartPixels = 15'000;
constexpr std::size_t kHalfBins = 32;    // even along the root of theta_h
constexpr double kMinPairCosine = 0.05;  // of what counts as a pair; pixels may be lower
constexpr double kMinPixelCosine = 0.02;
constexpr float kMinTrust = 0.05f;
constexpr float kEarlyError = 0.07f;  // of squared errors beside those of the last rounds
constexpr float kHeld = 0.02f;        // weight of clipped pixels that the model already is above
// As of models with volumes (fitting/fit.cpp).
constexpr ErrorTerms kShares{.pictures = 3, .dimmed = 0.3, .relative = 0.4, .log_cos = 0.4};
// Volumes are smooth, for the directions that no picture has; lines hold what is narrow.
constexpr double kSmooth = 1e-6, kLineSmoothShare = 1e-3;
// The way there is made at few nodes, on few texels and pixels.
constexpr double kCoarseShare = 1.0 / 6;
constexpr std::size_t kCoarsePixels = 24'000;
constexpr std::size_t kCoarseTexels = 1500;
constexpr int kCoarseSteps = 2, kFullSteps = 4, kLastSteps = 6, kFullRounds = 3;
// Normals and what is narrow in lobes sharpen each other, a little a round.
constexpr int kRounds = 9, kRoundsOfNormals = 24;
const HomomorphicOptions kStart{
    .smooth = 1e-5, .floor = PictureLoss::kFloor, .tolerance = 0.03, .progress = {}};
// Nodes of a lobe's tables, relative to each other: theta_h, theta_d, phi_d.
constexpr double kHalfNodes = 30, kDifferenceNodes = 20, kAzimuthNodes = 6;
constexpr double kLineShare = 0.07;
constexpr std::size_t kTexelBytes = 4;  // rgb9e5
constexpr double kCodeRoom = 1.25;      // of weights' scale over what nearly all texels have
constexpr double kNearlyAll = 0.999;

// What rank 0 tells the others first.
// What rank 0 tells the others to begin with; behind the second a checkpoint of lobes, if there is one.
constexpr std::string_view kOfWeights = "weights", kOfLobes = "lobes";

/// K lobes z(theta_h) g(theta_h,theta_d,phi_d) of so many bytes each.
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

Vec3 normal_of(const std::vector<float>& normals, std::size_t t) noexcept {
  if (normals.empty()) return {0, 0, 1};
  const double x = static_cast<double>(normals[2 * t]), y = static_cast<double>(normals[2 * t + 1]);
  return normalize({x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))});
}

/// A pixel that may be fitted: which, and its directions in the texel's frame.
struct Candidate {
  std::uint32_t picture, texel;
  DirectionPair pair;
  std::size_t bin;  // of theta_h
};

/// The fit of one capture.
class SurfaceFitter {
 public:
  SurfaceFitter(Capture capture, const SurfaceFitOptions& options)
      : capture_(std::move(capture)), options_(options), left_out_at_first_(capture_.left_out().size()) {
    const std::size_t lobes = options.book ? options.book->lobes().size() : options.lobes;
    if (lobes < 1 || lobes > kMaxSurfaceLobes)
      throw Error(fmt::format("surface fit: expected 1 to {} lobes, found {}", kMaxSurfaceLobes, lobes));
    if (options.lobe_bytes < kMinLobeBytes || options.lobe_bytes > kMaxLobeBytes)
      throw Error(fmt::format("surface fit: expected lobes of {} to {} bytes, found {}", kMinLobeBytes,
                              kMaxLobeBytes, options.lobe_bytes));
    if (options.rounds && (*options.rounds < 1 || *options.rounds > kMaxSurfaceRounds))
      throw Error(
          fmt::format("surface fit: expected 1 to {} rounds, found {}", kMaxSurfaceRounds, *options.rounds));
    if (options.book && options.book->channels() != kCaptureChannels)
      throw Error(fmt::format("surface fit: expected a book of {} channels, found {}", kCaptureChannels,
                              options.book->channels()));
    const CaptureForm& form = capture_.form();
    normals_from_ = options.normals.value_or(!form.normals.empty() ? NormalsFrom::capture
                                             : form.own_directions ? NormalsFrom::flat
                                                                   : NormalsFrom::estimate);
    if (normals_from_ == NormalsFrom::capture && capture_.form().normals.empty())
      throw Error::in_file(capture_.form_file().string(), "normals", "none");
    rounds_ = options.rounds.value_or(normals_from_ == NormalsFrom::estimate ? kRoundsOfNormals : kRounds);
  }

  SurfaceFit run() {
    const auto start = std::chrono::steady_clock::now();
    if (normals_from_ == NormalsFrom::capture) all_normals_ = capture_.normals();
    const bool resumed = resume();
    if (crew_ranks() > 1)
      options_.crew->broadcast(resumed ? std::string(kOfWeights)
                                       : std::string(kOfLobes) + (begun_ ? format_checkpoint(*begun_) : ""));
    if (!resumed) find_lobes();
    if (crew_ranks() > 1) options_.crew->broadcast(format_checkpoint(noted()));
    find_weights();
    SurfaceFit fit{.surface = surface(), .report = std::move(report_)};
    fit.report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fit.surface.notes = to_text(nlohmann::json(json_of(fit.report)), -1);  // as a file's reader orders it
    return fit;
  }

  /// The share of a rank that does not lead.
  void help() {
    if (normals_from_ == NormalsFrom::capture) all_normals_ = capture_.normals();
    if (const std::string told = options_.crew->broadcast({}); told != kOfWeights) {
      if (const std::string begun = told.substr(kOfLobes.size()); !begun.empty())
        begun_ = parse_lobes_checkpoint({"what rank 0 sent", bytes_of_text(begun)});
      find_lobes();
    }
    adopt(parse_checkpoint({"what rank 0 sent", bytes_of_text(options_.crew->broadcast({}))},
                           capture_.form().width));
    find_weights();
  }

 private:
  int crew_ranks() const noexcept { return options_.crew ? options_.crew->ranks() : 1; }
  int crew_rank() const noexcept { return options_.crew ? options_.crew->rank() : 0; }
  static std::vector<std::byte> bytes_of_text(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
  }

  void progress(std::string_view stage, double fraction) const {
    if (options_.progress && crew_rank() == 0) options_.progress(stage, fraction);
  }

  // ---- Lobes

  /// Every rank does what is small, and its share of the rest: reading, starts, channels and texels.
  void find_lobes() {
    SampledTexels sampled = sample_texels(
        capture_, kSampleValues, options_.tile_bytes, options_.seed,
        [&](double f) { progress("reading pictures", f); }, options_.crew);
    samples_ = std::move(sampled.samples);
    report_.missing_pixels = sampled.missing;
    report_.clipped_pixels = sampled.clipped;
    exposure_ = exposure_of(samples_, capture_.form());
    fits_.normals = sampled_normals();
    if (options_.book) {
      lobes_ = *options_.book;
      if (normals_from_ == NormalsFrom::estimate) start_normals();
      fit_samples(true);
    } else {
      start_normals();
      if (begun_)
        take_up_lobes();
      else
        start_lobes();
      refine_rounds();
    }
    find_scales();
    samples_ = {};
  }

  /// The first rounds, which the lobes' few nodes make coarse, on a part of the texels.
  void refine_rounds() {
    int round = rounds_done_;
    const bool of_all = round > 0 && !is_coarse(round - 1);  // of a checkpoint
    if (const std::size_t step = samples_.size() / kCoarseTexels; step > 1 && is_coarse(0) && !of_all) {
      TexelSamples all = std::exchange(samples_, every(samples_, step));
      normals_of_all_ = std::exchange(fits_.normals, every_normal(fits_.normals, step));
      take_up_or_fit_samples();
      while (is_coarse(round)) refine_round(round++);
      samples_ = std::move(all);
      fits_.normals = std::exchange(normals_of_all_, {});
      fit_samples(true);
    } else if (begun_) {
      take_up_or_fit_samples();
    }
    while (round < rounds_) refine_round(round++);
  }

  /// Lobes as a checkpoint has them.
  void take_up_lobes() {
    rounds_done_ = report_.resumed_rounds = begun_->rounds;
    const ModelSpec spec = spec_of_lobes(options_.lobes, bytes_in(rounds_done_ - 1));
    const bool alike = rounds_done_ < rounds_ &&
                       std::ranges::equal(begun_->log_values, spec.tables, {}, &std::vector<double>::size,
                                          [](const ModelSpec::TableSpec& table) {
                                            return table.layout.node_count() * kCaptureChannels;
                                          });
    if (!alike) refuse_checkpoint();
    model_ =
        LogModel{.spec = spec, .channels = kCaptureChannels, .log_values = std::move(begun_->log_values)};
    lobes_ = to_brdf(model_, TableFormat::single);
  }
  /// And the texels that they were fitted to.
  void take_up_or_fit_samples() {
    if (!begun_) return fit_samples(false);
    TexelFits& fits = begun_->fits;
    if (fits.weights.size() != samples_.size() * lobes_->lobes().size() ||
        fits.normals.size() != fits_.normals.size() || fits.trust.size() != samples_.states.size() ||
        begun_->normals_of_all.size() != normals_of_all_.size())
      refuse_checkpoint();
    fits_ = std::move(fits);
    normals_of_all_ = std::move(begun_->normals_of_all);
    begun_.reset();
  }
  [[noreturn]] void refuse_checkpoint() const {
    throw Error::in_file(options_.checkpoint.string(), "lobes and texels of this capture", "others");
  }

  /// Those of every().
  static std::vector<float> every_normal(const std::vector<float>& all, std::size_t step) {
    std::vector<float> some;
    for (std::size_t i = 0; i < all.size(); i += 2 * step) some.insert(some.end(), {all[i], all[i + 1]});
    return some;
  }

  std::vector<float> sampled_normals() const {
    std::vector<float> normals;
    if (all_normals_.empty()) return normals;
    for (const auto& [x, y] : samples_.texels) {
      const std::size_t at =
          2 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(capture_.form().width) +
               static_cast<std::size_t>(x));
      normals.insert(normals.end(), {all_normals_[at], all_normals_[at + 1]});
    }
    return normals;
  }

  /// As if texels were diffuse, then by what general lobes make of them.
  std::vector<float> first_normals(const TexelSamples& samples, FitCrew* crew) const {
    constexpr int kSteps = 4;
    const TexelSolver solver(general_lobes(), capture_.form(), exposure_);
    return solve_together(crew, solver, samples, diffuse_normals(samples, capture_.form()),
                          {.passes = 1, .normals = true, .normal_steps = kSteps})
        .normals;
  }
  void start_normals() {
    if (normals_from_ != NormalsFrom::estimate) return;
    progress("normals", 0);
    fits_.normals = first_normals(samples_, options_.crew);
    progress("normals", 1);
  }

  /// Each the log-linear fit to texels that look like one material.
  void start_lobes() {
    progress("starting lobes", 0);
    const auto sets = pure_texels(samples_, capture_.form(), fits_.normals, exposure_, options_.lobes);
    const std::size_t bytes = bytes_in(0);
    const ModelSpec spec = spec_of_lobes(options_.lobes, bytes), alone = spec_of_lobes(1, bytes);
    model_ = LogModel{.spec = spec, .channels = kCaptureChannels, .log_values = {}};
    const auto started = made_together(options_.crew, sets.size(), [&](std::size_t j) {
      std::vector<bool> chosen(samples_.size());
      for (const std::size_t t : sets[j]) chosen[t] = true;
      const TrainingSet set = training_set(kStartPixels, j, [&](std::size_t t) { return chosen[t]; });
      const LogModel lobe = fit_one_lobe(alone, set, set.values, kStart);
      std::string made;
      for (const auto& table : lobe.log_values) append_values<double>(made, table);
      progress("starting lobes", static_cast<double>(j + 1) / static_cast<double>(sets.size()));
      return made;
    });
    for (const ModelSpec::TableSpec& table : spec.tables)
      model_.log_values.emplace_back(table.layout.node_count() * kCaptureChannels);
    for (std::size_t j = 0, t = 0; j < started.size(); ++j)
      for (std::string_view rest = started[j]; !rest.empty(); ++t)
        take_values<double>(rest, model_.log_values[t]);
    lobes_ = to_brdf(model_, TableFormat::single);
    fit_samples(false);
  }

  void fit_samples(bool last) {
    const TexelSolver solver(*lobes_, capture_.form(), exposure_);
    const bool normals = normals_from_ == NormalsFrom::estimate;
    TexelFits fits =
        solve_together(options_.crew, solver, samples_, std::move(fits_.normals),
                       {.passes = 3, .normals = normals, .normal_steps = last ? 8 : 4, .trust = true});
    fits_ = std::move(fits);
  }

  bool is_coarse(int round) const noexcept { return round + kFullRounds < rounds_; }
  std::size_t bytes_in(int round) const noexcept {
    const auto few = static_cast<std::size_t>(kCoarseShare * static_cast<double>(options_.lobe_bytes));
    return is_coarse(round) ? std::max(few, kMinLobeBytes) : options_.lobe_bytes;
  }

  void refine_round(int round) {
    const bool last = round + 1 == rounds_, coarse = is_coarse(round);
    if (round > 0 && bytes_in(round) != bytes_in(round - 1))
      model_ = resampled(model_, spec_of_lobes(options_.lobes, bytes_in(round)));
    const TrainingSet set = ordered_by_cells(
        training_set(coarse ? kCoarsePixels : kTrainingPixels, 100 + static_cast<std::size_t>(round),
                     [](std::size_t) { return true; }),
        model_.spec);
    RefineOptions options{.shares = kShares,
                          .smooth = kSmooth,
                          .format = last ? TableFormat::rgb9e5 : TableFormat::single,
                          .max_iterations = last     ? kLastSteps
                                            : coarse ? kCoarseSteps
                                                     : kFullSteps,
                          .progress = [&](double f) { progress("fitting lobes", (round + f) / rounds_); }};
    refine_channels(set, options);
    lobes_ = last ? to_rounded_brdf(model_, set, options) : to_brdf(model_, TableFormat::single);
    rounds_done_ = round + 1;
    fit_samples(last);
    if (!last) save_lobes();
  }

  /// Channels do not depend on each other: a rank each. Two ranks have one and half the steps of the third each.
  void refine_channels(const TrainingSet& set, const RefineOptions& options) {
    if (crew_ranks() == 1) {
      refine(model_, set, options);
      return;
    }
    const Lookups lookups = lookups_of(model_.spec, set);
    std::array<std::optional<ChannelRefinement>, kCaptureChannels> begun;
    const auto of_channel = [&](std::size_t c) -> ChannelRefinement& {
      RefineOptions own = options;
      own.channel = c;
      return begun[c] ? *begun[c] : begun[c].emplace(model_, set, lookups, own);
    };
    std::vector<std::vector<std::size_t>> channels{{0}, {1}, {2}};  // of each part
    if (crew_ranks() == 2) {
      // rank 0 begins the third channel, rank 1 its own; then rank 1 ends both, rank 0 does its own
      const auto halfway = made_together(options_.crew, 2, [&](std::size_t rank) {
        ChannelRefinement& channel = of_channel(2 - rank);
        channel.run(options.max_iterations / 2);
        std::string bytes;
        append_values<double>(bytes, channel.state());
        return bytes;
      });
      channels = {{0}, {2, 1}};
      if (crew_rank() == 1) {
        std::vector<double> state(halfway[0].size() / sizeof(double));
        std::string_view bytes = halfway[0];
        take_values<double>(bytes, state);
        of_channel(2).go_on_from(state);
      }
    }
    const auto refined = made_together(options_.crew, channels.size(), [&](std::size_t part) {
      std::string bytes;
      for (const std::size_t c : channels[part]) {
        of_channel(c).run(options.max_iterations);
        LogModel own = model_;
        of_channel(c).finish(own);
        for (const std::vector<double>& table : own.log_values) append_values<double>(bytes, table);
      }
      return bytes;
    });
    for (std::size_t part = 0; part < channels.size(); ++part) {
      std::string_view rest = refined[part];
      for (const std::size_t c : channels[part])
        for (std::vector<double>& table : model_.log_values) {
          std::vector<double> all(table.size());
          take_values<double>(rest, all);
          for (std::size_t i = c; i < table.size(); i += kCaptureChannels) table[i] = all[i];
        }
    }
  }

  /// f of the lobes as they are, with the texel's weights.
  std::array<float, kCaptureChannels> modelled_at(const LobeEvaluator& lobes, const Candidate& c) const {
    std::array<float, LobeEvaluator::kWeightStride * kMaxSurfaceLobes> weights{};
    for (std::size_t j = 0; j < lobes.lobes(); ++j)
      for (std::size_t k = 0; k < kCaptureChannels; ++k)
        weights[LobeEvaluator::kWeightStride * j + k] = fits_.weights[c.texel * lobes.lobes() + j];
    std::array<float, kCaptureChannels> f{};
    lobes.eval(c.pair.wi, c.pair.wo, std::span(weights).first(LobeEvaluator::kWeightStride * lobes.lobes()),
               f);
    return f;
  }

  /// Pixels of the sampled texels that `takes` has: as many of each theta_h as there are, up to an even part; weighted
  /// as all of them for pictures, evenly over theta_h for the pairs.
  template <class Takes>
  TrainingSet training_set(std::size_t count, std::size_t stream, const Takes& takes) const {
    const Candidates all = candidates(6 * count, stream, takes);
    const std::size_t part = even_part(all.in_bin, count);
    std::vector<std::size_t> taken(kHalfBins);
    std::vector<const Candidate*> chosen;
    for (const Candidate& c : all.pixels)
      if (taken[c.bin]++ < part) chosen.push_back(&c);

    TrainingSet set{.channels = kCaptureChannels,
                    .isotropic = true,
                    .pairs = {},
                    .values = {},
                    .weights = {},
                    .lobe_weights = {},
                    .exposure = exposure_,
                    .albedo = {}};
    std::optional<LobeEvaluator> known;
    if (lobes_ && !fits_.weights.empty()) known.emplace(*lobes_);
    const auto model = known ? &*known : nullptr;
    for (std::size_t i = 0; i < chosen.size(); i += 2) {
      const std::size_t there = all.in_bin[chosen[i]->bin];
      add(set, *chosen[i], static_cast<double>(there) / static_cast<double>(std::min(there, part)), model);
    }
    set.picture_count = set.size();
    for (std::size_t i = 1; i < chosen.size(); i += 2)
      if (std::min(chosen[i]->pair.wi.z, chosen[i]->pair.wo.z) > kMinPairCosine)
        add(set, *chosen[i], 1, model);
    return set;
  }

  struct Candidates {
    std::vector<Candidate> pixels;
    std::vector<std::size_t> in_bin;  // how many of each theta_h
  };

  /// A pixel, where it is there, can be trusted and does not graze.
  std::optional<Candidate> candidate(std::uint32_t t, std::uint32_t p) const {
    const std::size_t pixel = p * samples_.size() + t;
    if (!is_there(samples_.states[pixel]) || trusts(pixel) < kMinTrust) return std::nullopt;
    const Vec3 point = capture_.form().point(samples_.texels[t][0], samples_.texels[t][1]);
    const ShadingFrame frame = frame_about(normal_of(fits_.normals, t), {1, 0, 0});
    const auto [light, view] = samples_.seen(capture_.form().pictures[p], p, t, point);
    Candidate c{.picture = p, .texel = t, .pair = {frame.local(light), frame.local(view)}, .bin = 0};
    if (c.pair.wi.z < kMinPixelCosine || c.pair.wo.z < kMinPixelCosine) return std::nullopt;
    const Vec3 h = half_vector(c.pair.wi, c.pair.wo);
    const double theta_h = std::acos(std::clamp(h.z, -1.0, 1.0));
    c.bin = std::min(kHalfBins - 1, static_cast<std::size_t>(std::sqrt(theta_h / 1.5707963) * kHalfBins));
    return c;
  }

  /// Pixels at random of the texels that `takes` has.
  template <class Takes>
  Candidates candidates(std::size_t draws, std::size_t stream, const Takes& takes) const {
    const CaptureForm& form = capture_.form();
    std::vector<std::uint32_t> fitted;
    for (std::size_t p = 0; p < form.pictures.size(); ++p)
      if (!form.pictures[p].held_out) fitted.push_back(static_cast<std::uint32_t>(p));
    std::vector<std::uint32_t> texels;
    for (std::size_t t = 0; t < samples_.size(); ++t)
      if (takes(t)) texels.push_back(static_cast<std::uint32_t>(t));

    Candidates found{.pixels = {}, .in_bin = std::vector<std::size_t>(kHalfBins)};
    Pcg32 random(options_.seed, 1000 + stream);
    constexpr std::size_t kAtOnce = 256;  // pixels that memory is asked for before the first is looked at
    std::array<std::pair<std::uint32_t, std::uint32_t>, kAtOnce> drawn;
    for (std::size_t begin = 0; begin < draws; begin += kAtOnce) {
      const auto some = std::span(drawn).first(std::min(kAtOnce, draws - begin));
      for (auto& [t, p] : some) {
        t = texels[random.next() % texels.size()];
        p = fitted[random.next() % fitted.size()];
        const std::size_t pixel = p * samples_.size() + t;
        hwy::Prefetch(&samples_.states[pixel]);
        if (!fits_.trust.empty()) hwy::Prefetch(&fits_.trust[pixel]);
      }
      for (const auto& [t, p] : some)
        if (const std::optional<Candidate> c = candidate(t, p)) {
          ++found.in_bin[c->bin];
          found.pixels.push_back(*c);
        }
    }
    if (found.pixels.empty()) throw Error("surface fit: expected pixels that can be fitted, found none");
    return found;
  }

  /// How many each bin may give, so that together they give `count`: what small ones leave goes to the others.
  static std::size_t even_part(const std::vector<std::size_t>& in_bin, std::size_t count) {
    const std::size_t bins = kHalfBins - static_cast<std::size_t>(std::ranges::count(in_bin, std::size_t{0}));
    std::size_t part = std::max<std::size_t>(1, count / bins);
    for (int pass = 0; pass < 4; ++pass) {
      std::size_t used = 0, open = 0;
      for (const std::size_t n : in_bin) {
        used += std::min(n, part);
        open += n > part;
      }
      if (open == 0 || used >= count) break;
      part += (count - used) / open;
    }
    return part;
  }

  /// A clipped value is a lower bound: it stands for what the lobes make of it, where that is more. So a step never
  /// raises the one-sided error, and lobes stay where they are where nothing else holds them.
  void add(TrainingSet& set, const Candidate& c, double weight, const LobeEvaluator* known) const {
    const std::size_t pixel = c.picture * samples_.size() + c.texel;
    const PixelState state = samples_.states[pixel];
    std::array<float, kCaptureChannels> modelled{};
    if (known && is_clipped(state)) modelled = modelled_at(*known, c);
    set.pairs.push_back(c.pair);
    bool held = false;
    for (std::size_t k = 0; k < kCaptureChannels; ++k) {
      const float value =
          std::max(0.0f, samples_.values[kCaptureChannels * pixel + k]) / static_cast<float>(c.pair.wi.z);
      const bool above = is_clipped(state, k) && modelled[k] > value;
      held = held || above;
      set.values.push_back(above ? modelled[k] : value);
    }
    set.weights.push_back(static_cast<float>(weight) * trusts(pixel) * (held ? kHeld : 1));
    const std::size_t lobes = fits_.weights.size() / samples_.size();
    for (std::size_t j = 0; j < lobes; ++j) set.lobe_weights.push_back(fits_.weights[c.texel * lobes + j]);
  }

  /// How much lobes are fitted to a pixel. Before they have been refined once, it is they that are wrong. Where
  /// highlights are clipped, the few that are not say how bright lobes are, and look like outliers until lobes are:
  /// while they have few nodes, only large errors count against a pixel.
  float trusts(std::size_t pixel) const noexcept {
    if (rounds_done_ == 0) return 1;
    const float trust = fits_.trust[pixel];
    if (report_.clipped_pixels == 0 || !is_coarse(rounds_done_) || trust == 0) return trust;
    const float share = 1 + kEarlyError * (1 / std::sqrt(trust) - 1);  // as TexelSolver finds trust
    return 1 / (share * share);
  }

  /// Of each lobe's weights, by the sampled texels.
  void find_scales() {
    const std::size_t lobes = lobes_->lobes().size();
    for (std::size_t j = 0; j < lobes; ++j) {
      std::vector<float> weights;
      for (std::size_t t = 0; t < samples_.size(); ++t) weights.push_back(fits_.weights[t * lobes + j]);
      const std::size_t at = static_cast<std::size_t>(kNearlyAll * static_cast<double>(weights.size() - 1));
      std::ranges::nth_element(weights, weights.begin() + static_cast<std::ptrdiff_t>(at));
      const auto scale = static_cast<float>(kCodeRoom * static_cast<double>(weights[at]));
      scales_.push_back(scale > 0 ? scale : 1);
    }
  }

  // ---- Checkpoints

  /// Of the capture as it was opened and of all that changes the result.
  std::uint64_t key() const {
    const std::string text = fmt::format(
        "{} {} {} {} {} {} {}", capture_.fingerprint(), options_.book ? 0 : options_.lobes,
        options_.lobe_bytes, name_of(normals_from_), rounds_, options_.seed,
        options_.book ? format_compact({.brdf = *options_.book, .lambda_nm = {}}) : std::string());
    return hash_of(text) & ~std::uint64_t{1};
  }

  /// True where lobes are found; those that are begun are in begun_.
  bool resume() {
    key_ = key();
    if (options_.checkpoint.empty() || !std::filesystem::exists(options_.checkpoint)) return false;
    const FileBytes file = read_file(options_.checkpoint);
    const auto check = [&](std::uint64_t key) {
      if (key != key_)
        throw Error::in_file(options_.checkpoint.string(), "a checkpoint of this capture and these options",
                             "one of others");
    };
    begun_ = parse_lobes_checkpoint(file);
    if (begun_) {
      check(begun_->key);
      return false;
    }
    FitCheckpoint found = parse_checkpoint(file, capture_.form().width);
    check(found.key);
    adopt(std::move(found));
    report_.resumed_rows = done_.rows;
    return true;
  }

  void adopt(FitCheckpoint found) {
    capture_.leave_out(found.damaged);
    done_ = std::move(found);
    lobes_ = done_.lobes;
    exposure_ = done_.exposure;
    scales_ = done_.scales;
    report_.missing_pixels = done_.missing_pixels;
    report_.clipped_pixels = done_.clipped_pixels;
  }

  const FitCheckpoint& noted() {
    done_.key = key_;
    done_.damaged.assign(capture_.left_out().begin() + static_cast<std::ptrdiff_t>(left_out_at_first_),
                         capture_.left_out().end());
    done_.missing_pixels = report_.missing_pixels;
    done_.clipped_pixels = report_.clipped_pixels;
    done_.exposure = exposure_;
    done_.lobes = *lobes_;
    done_.scales = scales_;
    done_.codes.resize(lobes_->lobes().size());
    return done_;
  }

  void save_lobes() const {
    if (options_.checkpoint.empty() || crew_rank() != 0) return;
    write_then_rename(options_.checkpoint,
                      format_checkpoint(LobesCheckpoint{.key = key_,
                                                        .rounds = rounds_done_,
                                                        .log_values = model_.log_values,
                                                        .fits = fits_,
                                                        .normals_of_all = normals_of_all_}));
  }
  void save() {
    if (options_.checkpoint.empty() || crew_rank() != 0) return;
    noted();
    write_then_rename(options_.checkpoint, format_checkpoint(done_));
  }

  // ---- Weights of all texels

  void find_weights() {
    const CaptureForm& form = capture_.form();
    done_.codes.resize(lobes_->lobes().size());
    done_.errors.resize(form.pictures.size());
    const TexelSolver solver(*lobes_, form, exposure_);
    const int ranks = crew_ranks(), step = tile_rows();
    // A checkpoint holds all rows that are done. It is written after a turn that took so many times as long as the
    // last writing, and after so many parts of the surface.
    constexpr double kWorthOfASave = 20;
    constexpr int kSavedParts = 16;
    using Clock = std::chrono::steady_clock;
    double save_seconds = done_.rows == 0 ? seconds_of([&] { save(); }) : 0;
    int saved = done_.rows;
    Clock::time_point saved_at = Clock::now();
    while (done_.rows < form.height) {
      // a tile a rank, which rank 0 puts together in their order
      const int begin = done_.rows, end = std::min(begin + ranks * step, form.height),
                row = std::min(begin + crew_rank() * step, end), rows = std::min(step, end - row);
      FitCheckpoint tile{.lobes = *lobes_, .scales = scales_, .codes = {}, .normals = {}, .errors = {}};
      tile.codes.resize(done_.codes.size());
      if (rows > 0) tile = fitted_tile(solver, row, rows, std::move(tile));
      if (ranks == 1) {
        append(tile);
      } else {
        for (const std::string& sent : options_.crew->gather(format_checkpoint(tile)))
          append(parse_checkpoint({"what a rank sent", bytes_of_text(sent)}, form.width));
      }
      done_.rows = end;
      const double since = std::chrono::duration<double>(Clock::now() - saved_at).count();
      if (since >= kWorthOfASave * save_seconds ||
          done_.rows - saved >= std::max(form.height / kSavedParts, 1)) {
        save_seconds = seconds_of([&] { save(); });
        saved = done_.rows;
        saved_at = Clock::now();
      }
      progress("fitting weights", static_cast<double>(done_.rows) / form.height);
    }
    report_.texels_without_data = done_.texels_without_data;
    report_.fitted = score(done_.errors, false);
    report_.held_out = score(done_.errors, true);
  }

  /// Of a tile: what memory holds, of several ranks an even part of what is left.
  int tile_rows() const {
    const int most = capture_.rows_within(options_.tile_bytes), ranks = crew_ranks();
    if (ranks == 1) return most;
    constexpr int kMinTurns = 4;  // of each rank, so that a lost one costs little
    const int turns = std::max(kMinTurns, (capture_.form().height + most * ranks - 1) / (most * ranks));
    return std::max(1, (capture_.form().height + turns * ranks - 1) / (turns * ranks));
  }

  FitCheckpoint fitted_tile(const TexelSolver& solver, int row, int rows, FitCheckpoint tile) {
    Capture::Read read = capture_.read(row, rows);
    if (!read.damaged.empty())
      throw Error::in_file(capture_.file(read.damaged.front().file).string(),
                           "a picture that stays as it was when it was read first", read.damaged.front().why);
    const TexelSamples samples = samples_of(std::move(read.rows));
    const auto start = std::chrono::steady_clock::now();
    TexelFits fits = fit_tile(solver, samples, row);
    store(fits, capture_.form().width, tile);
    report_.weight_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    tile.errors = solver.errors(samples, fits);
    tile.texels_without_data = without_data(samples);
    tile.rows = rows;
    return tile;
  }

  /// Texels that no picture shows which is fitted.
  std::size_t without_data(const TexelSamples& samples) const {
    std::vector<char> shown(samples.size());
    for (std::size_t p = 0; p < samples.pictures; ++p) {
      if (capture_.form().pictures[p].held_out) continue;
      const PixelState* const states = &samples.states[p * samples.size()];
      for (std::size_t t = 0; t < samples.size(); ++t) shown[t] |= static_cast<char>(is_there(states[t]));
    }
    return static_cast<std::size_t>(std::ranges::count(shown, 0));
  }

  void append(const FitCheckpoint& tile) {
    done_.texels_without_data += tile.texels_without_data;
    for (std::size_t j = 0; j < done_.codes.size(); ++j)
      done_.codes[j].insert(done_.codes[j].end(), tile.codes[j].begin(), tile.codes[j].end());
    done_.normals.insert(done_.normals.end(), tile.normals.begin(), tile.normals.end());
    for (std::size_t p = 0; p < tile.errors.size(); ++p) done_.errors[p] += tile.errors[p];
  }

  TexelFits fit_tile(const TexelSolver& solver, const TexelSamples& tile, int row) const {
    std::vector<float> normals;
    if (normals_from_ == NormalsFrom::capture) {
      const std::size_t first =
          2 * static_cast<std::size_t>(row) * static_cast<std::size_t>(capture_.form().width);
      normals.assign(all_normals_.begin() + static_cast<std::ptrdiff_t>(first),
                     all_normals_.begin() + static_cast<std::ptrdiff_t>(first + 2 * tile.size()));
    }
    const bool estimate = normals_from_ == NormalsFrom::estimate;
    if (estimate) normals = first_normals(tile, nullptr);
    return solver.solve(tile, std::move(normals), {.passes = 3, .normals = estimate, .normal_steps = 8});
  }

  /// Rounds what was found to what is stored, and keeps it in the tile.
  void store(TexelFits& fits, int width, FitCheckpoint& tile) const {
    const std::size_t lobes = scales_.size(), count = fits.weights.size() / lobes;
    const int rows = static_cast<int>(count) / width;
    for (std::size_t j = 0; j < lobes; ++j) {
      std::vector<float> weights(count);
      for (std::size_t t = 0; t < count; ++t) weights[t] = std::min(fits.weights[t * lobes + j], scales_[j]);
      const SurfaceMap map(width, rows, 1, TableFormat::unorm8, scales_[j], weights);
      tile.codes[j].assign(map.stored_bytes().begin(), map.stored_bytes().end());
      for (std::size_t t = 0; t < count; ++t)
        fits.weights[t * lobes + j] = map.texel(static_cast<int>(t) % width, static_cast<int>(t) / width)[0];
    }
    if (fits.normals.empty()) return;
    fits.normals = round_normals(fits.normals, width);
    tile.normals = fits.normals;
  }
  static std::vector<float> round_normals(const std::vector<float>& normals, int width) {
    const int rows = static_cast<int>(normals.size() / 2) / width;
    const SurfaceMap map(width, rows, 2, TableFormat::half, 1, normals);
    std::vector<float> rounded;
    rounded.reserve(normals.size());
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < width; ++x) {
        const SurfaceMap::Value n = map.texel(x, y);
        rounded.insert(rounded.end(), {n[0], n[1]});
      }
    return rounded;
  }

  PictureScore score(const std::vector<TexelSolver::PictureError>& errors, bool held_out) const {
    PictureScore score;
    double seen = 0, all = 0;
    std::size_t seen_pictures = 0, all_pictures = 0;
    for (std::size_t p = 0; p < errors.size(); ++p) {
      if (capture_.form().pictures[p].held_out != held_out) continue;
      ++score.pictures;
      if (const auto mean = errors[p].seen_mean()) {
        seen += *mean;
        ++seen_pictures;
      }
      if (const auto mean = errors[p].all_mean()) {
        all += *mean;
        ++all_pictures;
      }
    }
    const auto psnr = [](double sum, std::size_t count) -> std::optional<double> {
      if (count == 0) return std::nullopt;
      return -10 * std::log10(sum / static_cast<double>(count));
    };
    score.psnr = psnr(seen, seen_pictures);
    score.psnr_of_all = psnr(all, all_pictures);
    return score;
  }

  SurfaceModel surface() {
    const CaptureForm& form = capture_.form();
    SurfaceMaps maps;
    for (std::size_t j = 0; j < scales_.size(); ++j)
      maps.weights.emplace_back(form.width, form.height, std::size_t{1}, TableFormat::unorm8, scales_[j],
                                std::span<const std::byte>(done_.codes[j]));
    if (!done_.normals.empty())
      maps.normals.emplace(form.width, form.height, std::size_t{2}, TableFormat::half, 1.0f,
                           std::span<const float>(done_.normals));
    SpatialBrdf brdf(*lobes_, std::move(maps));
    SurfaceModel surface{.brdf = options_.widened ? with_widened_lobes(brdf) : std::move(brdf),
                         .notes = "{}"};
    report_.width = static_cast<std::size_t>(form.width);
    report_.height = static_cast<std::size_t>(form.height);
    report_.pictures = form.pictures.size();
    report_.of_samples = form.own_directions;
    report_.lights_and_views = form.own_directions ? 0 : lights_and_views(form);
    report_.lobes = scales_.size();
    report_.left_out = capture_.left_out();
    report_.normals = normals_from_;
    report_.exposure = exposure_;
    report_.weight_bytes = surface.brdf.weight_bytes();
    report_.frame_bytes = surface.brdf.frame_bytes();
    report_.lobe_bytes = surface.brdf.lobes().bytes();
    report_.bytes_a_texel =
        static_cast<double>(report_.weight_bytes) +
        static_cast<double>(report_.lobe_bytes) / (static_cast<double>(form.width) * form.height);
    return surface;
  }

  Capture capture_;
  const SurfaceFitOptions& options_;
  NormalsFrom normals_from_ = NormalsFrom::flat;
  int rounds_ = 0;
  std::vector<float> normals_of_all_;     ///< while rounds see a part of the texels: of the others too
  std::optional<LobesCheckpoint> begun_;  ///< what a checkpoint has, until it is taken up
  std::vector<float> all_normals_;
  TexelSamples samples_;
  TexelFits fits_;
  double exposure_ = 1;
  int rounds_done_ = 0;
  LogModel model_;
  std::optional<FactoredBrdf> lobes_;
  std::vector<float> scales_;
  FitCheckpoint done_;
  std::uint64_t key_ = 0;
  std::size_t left_out_at_first_ = 0;
  SurfaceReport report_;
};

}  // namespace

SurfaceFit fit_surface(Capture capture, const SurfaceFitOptions& options) {
  return SurfaceFitter(std::move(capture), options).run();
}

void help_fit_surface(Capture capture, const SurfaceFitOptions& options) {
  SurfaceFitter(std::move(capture), options).help();
}

}  // namespace burnish
