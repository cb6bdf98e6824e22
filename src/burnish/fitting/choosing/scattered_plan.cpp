#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/byte_count.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/choosing/lobe_plan.h>
#include <burnish/fitting/choosing/scattered_plan.h>
#include <burnish/fitting/one_lobe/cross_validation.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr std::size_t kFolds = 5;

// Smoothness is common to all channels: a few tell it.
constexpr std::size_t kTrialChannels = 3;

// Texels of the models that are tried. Up to about 500 a fit is direct and takes milliseconds; hemispheres
// need more, and are then solved by iterations.
constexpr std::array<std::size_t, 2> kLineSizes{140, 400}, kDiskSizes{160, 1200};
constexpr int kMaxLine = 1024;  // nodes, finer than any measurement
constexpr int kMaxDisk = 256;   // nodes along a side

// Nodes of a line p that is fine enough to tell the angles of a lattice apart, 1.4 degrees each, and the part of the
// texels that it may take: what it takes from a small q it does not give back.
constexpr int kFineP = 64;
constexpr double kMaxFineP = 0.25;

// Factor sets, the fullest first: the others serve budgets that hold few texels.
const std::array<std::string, 5> kFactorSets{"pqmr", "pqm", "pqr", "pq", "q"};

bool is_disk(const PlannedFactor& factor) {
  return factor.shape == TableShape::disk;
}

int least_side(const PlannedFactor& factor) {
  return is_disk(factor) ? 3 : 2;
}

// Nodes along a side of a factor's table of at most so many nodes.
int side_of(const PlannedFactor& factor, double nodes) {
  const int most = is_disk(factor) ? kMaxDisk : kMaxLine;
  return static_cast<int>(std::min<double>(most, is_disk(factor) ? std::sqrt(nodes) : nodes));
}

std::size_t nodes_of(const PlannedFactor& factor, int side) {
  const auto n = static_cast<std::size_t>(side);
  return is_disk(factor) ? n * n : n;
}

// The factors of one set, as budgets plan them.
std::vector<PlannedFactor> factors_of(const std::string& set, std::size_t texels, bool isotropic) {
  std::vector<PlannedFactor> chosen;
  // of so few bytes of one each that no grids are planned
  const std::size_t bytes = isotropic ? 1 : texels;
  for (PlannedFactor& factor : default_plan(bytes, isotropic ? 1 : 2, isotropic, 1).factors)
    if (set.find(factor.name) != set.npos) chosen.push_back(std::move(factor));
  return chosen;
}

// The lobe whose tables have at most `texels` texels together: each its share, but as many as it needs, p at least
// `least_p`, and q what is left. None where they do not suffice.
std::optional<ModelSpec> spec_of(const std::string& set, std::size_t texels, bool isotropic,
                                 int least_p = 0) {
  const std::vector<PlannedFactor> factors = factors_of(set, texels, isotropic);
  // sides by share, q's by what is left
  double shares = 0;
  for (const PlannedFactor& factor : factors) shares += factor.share;
  std::vector<int> sides;
  std::size_t left = texels;
  const auto q = std::ranges::find(factors, "q", &PlannedFactor::name);
  for (const PlannedFactor& factor : factors) {
    const double nodes = factor.share / shares * static_cast<double>(texels);
    const int least = factor.name == "p" ? std::max(least_p, least_side(factor)) : least_side(factor);
    sides.push_back(std::max(least, side_of(factor, nodes)));
    if (factor.name == q->name) continue;
    const std::size_t taken = nodes_of(factor, sides.back());
    if (taken > left) return std::nullopt;
    left -= taken;
  }
  const int side = side_of(*q, static_cast<double>(left));
  if (side < least_side(*q)) return std::nullopt;
  sides[static_cast<std::size_t>(q - factors.begin())] = side;

  // one lobe of all
  ModelSpec spec;
  spec.lobes.emplace_back();
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const PlannedFactor& factor = factors[k];
    spec.tables.push_back({.name = factor.name,
                           .layout = {.shape = factor.shape,
                                      .width = sides[k],
                                      .height = is_disk(factor) ? sides[k] : 1,
                                      .warp = factor.warp}});
    for (const Projection& use : factor.uses)
      spec.lobes.front().push_back({.table = k, .projection = use, .projection_y = {}});
  }
  return spec;
}

// The same within so many bytes, at most `most` texels.
std::optional<ModelSpec> spec_within(const std::string& set, std::size_t bytes, std::size_t most,
                                     const SampleSource& source, TableFormat format, int least_p = 0) {
  const std::size_t texel = texel_bytes(format, source.channels);
  for (std::size_t texels = std::min(most, bytes / texel); texels > 0; --texels) {
    std::optional<ModelSpec> spec = spec_of(set, texels, source.isotropic, least_p);
    if (!spec || model_bytes(*spec, source.channels, format) <= bytes) return spec;
  }
  return std::nullopt;
}

// A lobe about wi = wo is looked for up to the first theta_d of these where an incidence has enough samples, compared
// with a ring between so many times that, and has to be so much higher.
constexpr std::array kRetroNear{radians(1.5), radians(3), radians(5)};
constexpr double kRetroRingLow = 8.0 / 3, kRetroRingHigh = 16.0 / 3;
constexpr double kMinTilt = radians(10);  // of the half vector: a highlight is there at the normal
constexpr double kMinRatio = 2;

// Of this lobe for many samples, as trials find it for a tape's 7,400. Trials on many would leave it rougher: they
// are at few incidences, all of which every fold has, and nothing tells how wild it is between them.
constexpr double kRetroSmooth = 1e-7;

// Nodes of the factors of a material that backscatters, at most; the sides of k and of hemispheres are equal.
struct RetroSizes {
  int p = 48, q = 64, k = 24, b_h = 16, b_d = 40, a_d = 32, a_phi = 10;
};
constexpr int kRetroDiskP = 16, kRetroDiskQ = 32;  // p and q of anisotropic ones

// Its factors where fetches, one a letter, allow no more; p stands twice. Cross-validated relative errors of a tape:
// .170 of b by itself, .112 with k, .108 with q or .100 with p, .100 with both, .091 of all.
constexpr std::array<std::string_view, 6> kRetroFactors{"ppqkba", "ppqkb", "ppkb", "qkb", "kb", "b"};

// p(wo) p(wi) q(h) k(theta_m,theta_d) b(theta_h,theta_d) a(theta_d,phi_d), their nodes crowded at wi = wo, where b
// follows the angle of both, and a what is not round about it. p and q are hemispheres where it is anisotropic.
// Near wi = wo nodes of b and a are evenly spread in theta_d, as what is smooth over them has to be: over its root, a
// lobe of a flat top is so steep at the samples about it that the smoothest lobe is up to twice as high between them.
// Of these factors alone.
ModelSpec retro_spec(const RetroSizes& sizes, bool isotropic, std::string_view factors) {
  const Warp crowded{WarpKind::power, 0.5}, even_at_zero{WarpKind::rational, 0.08};
  const auto polar = [&](const char* name, int nodes) {
    const TableLayout line{.shape = TableShape::line, .width = nodes, .height = 1},
        disk{.shape = TableShape::disk, .width = nodes, .height = nodes};
    return ModelSpec::TableSpec{.name = name, .layout = isotropic ? line : disk};
  };
  const auto grid = [](const char* name, int width, int height, Warp warp, Warp warp_y) {
    return ModelSpec::TableSpec{
        .name = name,
        .layout = {
            .shape = TableShape::grid, .width = width, .height = height, .warp = warp, .warp_y = warp_y}};
  };
  const Warp highlight = factors.find('q') == factors.npos ? crowded : Warp{};  // b's alone without q
  std::vector<ModelSpec::TableSpec> tables = {polar("p", sizes.p), polar("q", sizes.q),
                                              grid("k", sizes.k, sizes.k, crowded, crowded),
                                              grid("b", sizes.b_h, sizes.b_d, highlight, even_at_zero),
                                              grid("a", sizes.a_d, sizes.a_phi, even_at_zero, Warp{})};
  // about wi = wo, where scans coarser than the lobe have no sample
  tables[2].even_y = tables[3].even_y = tables[4].pole_x = true;
  const std::vector<FactorUse> uses = {
      {.table = 0, .projection = kProjectWo, .projection_y = {}},
      {.table = 0, .projection = kProjectWi, .projection_y = {}},
      {.table = 1, .projection = kProjectHalf, .projection_y = {}},
      {.table = 2, .projection = kProjectDeviation, .projection_y = kProjectDifference},
      {.table = 3, .projection = kProjectHalf, .projection_y = kProjectDifference},
      {.table = 4, .projection = kProjectDifference, .projection_y = kProjectAzimuth}};
  ModelSpec spec;
  std::vector<FactorUse>& lobe = spec.lobes.emplace_back();
  for (std::size_t t = 0; t < tables.size(); ++t) {
    if (factors.find(tables[t].name) == factors.npos) continue;
    for (FactorUse use : uses)
      if (use.table == t) {
        use.table = spec.tables.size();
        lobe.push_back(use);
      }
    spec.tables.push_back(std::move(tables[t]));
  }
  return spec;
}

// Of at most so many fetches, any for 0, the most factors whose grids the bytes hold, as fine as they do; none where
// all would be too coarse.
std::optional<ModelSpec> retro_spec_within(std::size_t bytes, const SampleSource& source, TableFormat format,
                                           int fetches) {
  for (const std::string_view factors : kRetroFactors) {
    if (fetches > 0 && factors.size() > static_cast<std::size_t>(fetches)) continue;
    for (const double share : {1.0, 0.7, 0.5, 0.35}) {
      const auto part = [share](int nodes) { return std::max(4, static_cast<int>(share * nodes)); };
      RetroSizes whole;
      if (!source.isotropic) {
        whole.p = kRetroDiskP;
        whole.q = kRetroDiskQ;
      }
      const ModelSpec spec = retro_spec({part(whole.p), part(whole.q), part(whole.k), part(whole.b_h),
                                         part(whole.b_d), part(whole.a_d), part(whole.a_phi)},
                                        source.isotropic, factors);
      if (model_bytes(spec, source.channels, format) <= bytes) return spec;
    }
  }
  return std::nullopt;
}

// The factor sets of at most so many fetches, any for 0; the last one has one.
std::vector<std::string> sets_within(int fetches, bool isotropic) {
  std::vector<std::string> sets(kFactorSets.begin(), kFactorSets.end());
  if (fetches > 0)
    std::erase_if(sets, [&](const std::string& set) {
      std::size_t uses = 0;
      for (const PlannedFactor& factor : factors_of(set, kDiskSizes.front(), isotropic))
        uses += factor.uses.size();
      return uses > static_cast<std::size_t>(fetches);
    });
  return sets;
}

// What is compared: the fullest set from coarse to fine, its p at last so fine that it tells incidences apart; where
// that is no choice, because the bytes hold few texels, or where fetches forbid a fuller one, the other sets too.
std::vector<ModelSpec> candidates(const SampleSource& source, std::size_t bytes, TableFormat format,
                                  const std::vector<std::string>& sets) {
  std::vector<ModelSpec> specs;
  const auto add = [&](const std::string& set, std::size_t most, int least_p = 0) {
    std::optional<ModelSpec> spec = spec_within(set, bytes, most, source, format, least_p);
    if (!spec) return;
    const auto same = [&](const ModelSpec& other) {
      return other.tables.size() == spec->tables.size() &&
             std::ranges::equal(other.tables, spec->tables, {}, &ModelSpec::TableSpec::layout,
                                &ModelSpec::TableSpec::layout);
    };
    if (std::ranges::none_of(specs, same)) specs.push_back(std::move(*spec));
  };
  for (const std::size_t size : source.isotropic ? kLineSizes : kDiskSizes) add(sets.front(), size);
  const std::size_t texels = bytes / texel_bytes(format, source.channels);
  if (source.isotropic && kFineP <= kMaxFineP * static_cast<double>(texels))
    add(sets.front(), kLineSizes.back(), kFineP);
  if (specs.size() <= 1 || sets.size() < kFactorSets.size())
    for (const std::string& set : sets) add(set, kLineSizes.front());
  return specs;
}

std::size_t texels_of(const ModelSpec& spec) {
  std::size_t sum = 0;
  for (const ModelSpec::TableSpec& table : spec.tables) sum += table.layout.node_count();
  return sum;
}

// The source with at most kTrialChannels of its channels, evenly spread.
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

/// Compares models by what they predict.
class Trials {
 public:
  Trials(const SampleSource& source, bool fixed_smooth, const HomomorphicOptions& options)
      : source_(source), fixed_smooth_(fixed_smooth), options_(options) {
    options_.progress = nullptr;
  }

  /// From now on.
  void store_as(TableFormat format) { options_.format = format; }

  /// The first model, with its smoothness if that is given.
  ScatteredPlan start(ModelSpec spec, std::optional<double> smooth,
                      const std::function<void(double)>& progress) {
    if (smooth) return attempt(std::move(spec), *smooth);
    HomomorphicOptions options = options_;
    options.progress = progress;
    const SmoothTrial best = choose_smoothness(source_, spec, options).front();
    for (std::size_t t = 0; t < spec.tables.size(); ++t) spec.tables[t].smooth_share = best.shares[t];
    return {.spec = std::move(spec), .smooth = best.smooth, .error = best.error, .format = options_.format};
  }

  /// Another model, from the smoothness of one that is known, or from this one if that is better, by decades either
  /// way as long as that helps.
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

  // Changes by decades either way as long as that helps.
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
      if (moved > 0) return;  // the other way would undo it
    }
  }

  const SampleSource& source_;
  bool fixed_smooth_;
  HomomorphicOptions options_;
};

// The lobe about wi = wo, where options ask for one and bytes and fetches hold it.
std::optional<ModelSpec> asked_retro_spec(const SampleSource& source, std::size_t bytes,
                                          const HomomorphicOptions& options, int fetches) {
  if (options.backscatter <= 0) return std::nullopt;
  return retro_spec_within(bytes, source, options.format, fetches);
}

// Of many samples: as fine as the bytes hold, or the lobe about wi = wo where that predicts better.
ScatteredPlan plan_many(const SampleSource& source, std::size_t bytes, std::optional<double> smooth,
                        const HomomorphicOptions& options, int fetches) {
  // as choose_smoothness tries many
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
      for (const std::string& set : sets_within(fetches, source.isotropic))
        if (auto fewer = spec_within(set, bytes, bytes, source, options.format)) return planned(*fewer);
    return planned(std::move(spec));
  }
}

}  // namespace

std::size_t least_scattered_bytes(std::size_t channels, bool isotropic, TableFormat format) {
  const std::string& least = kFactorSets.back();
  std::size_t texels = 1;
  while (!spec_of(least, texels, isotropic)) ++texels;
  return model_bytes(*spec_of(least, texels, isotropic), channels, format);
}

bool backscatters(const SampleSource& source) {
  // values near wi = wo and around it, by incidence and by what counts as near
  struct Sums {
    double near = 0, ring = 0;
    std::size_t near_count = 0, ring_count = 0;
  };
  std::map<long, std::array<Sums, kRetroNear.size()>> incidences;
  std::vector<DirectionPair> pairs(source.count);
  std::vector<double> weights(source.count);
  std::vector<double> values(source.count * source.channels);
  source.fill(0, pairs, values, weights);
  for (std::size_t i = 0; i < source.count; ++i) {
    const auto& [wi, wo] = pairs[i];
    if (!(weights[i] > 0) || wi.z <= 0 || wo.z <= 0 || theta_of(half_vector(wi, wo)) < kMinTilt) continue;
    const double theta_d = angle_between(wi, wo) / 2, f = std::max(values[i * source.channels], 0.0);
    auto& of_incidence = incidences[std::lround(theta_of(wi) / kSameIncidence)];
    for (std::size_t k = 0; k < kRetroNear.size(); ++k) {
      Sums& sums = of_incidence[k];
      if (theta_d <= kRetroNear[k]) {
        sums.near += f;
        ++sums.near_count;
      } else if (theta_d >= kRetroRingLow * kRetroNear[k] && theta_d <= kRetroRingHigh * kRetroNear[k]) {
        sums.ring += f;
        ++sums.ring_count;
      }
    }
  }

  // what most of the incidences say that know
  std::size_t higher = 0, known = 0;
  for (const auto& [place, reaches] : incidences) {
    const auto sums = std::ranges::find_if(
        reaches, [](const Sums& s) { return s.near_count >= kMinNearby && s.ring_count >= kMinNearby; });
    if (sums == reaches.end()) continue;
    ++known;
    higher += sums->near / static_cast<double>(sums->near_count) >
              kMinRatio * sums->ring / static_cast<double>(sums->ring_count);
  }
  return 2 * higher > known;
}

ScatteredPlan plan_scattered(const SampleSource& source, std::size_t bytes, std::optional<double> smooth,
                             std::optional<TableFormat> format, const HomomorphicOptions& options,
                             int fetches) {
  // the formats to choose from, the first one first
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

  // from the coarsest to finer ones as long as that helps, or every set of factors
  const SampleSource part = some_channels(source);
  Trials trials(part, smooth.has_value(), chosen);
  const std::vector<std::string> sets = sets_within(fetches, source.isotropic);
  std::vector<ModelSpec> specs = candidates(source, bytes, formats.front(), sets);
  std::vector<ScatteredPlan> found{trials.start(specs.front(), smooth, options.progress)};
  const auto best = [&] { return std::ranges::min_element(found, {}, &ScatteredPlan::error); };
  for (auto spec = specs.begin() + 1; spec != specs.end(); ++spec)
    found.push_back(trials.near(*spec, *best()));
  // what holds no lobe about wi = wo may be best as a constant, whose smoothness says nothing of one that does
  if (const auto spec = asked_retro_spec(source, bytes, chosen, fetches)) {
    found.push_back(trials.near(*spec, *best(), kRetroSmooth));
    specs.push_back(*spec);
  }
  // the smaller format where it resolves more
  for (auto other = formats.begin() + 1; other != formats.end(); ++other) {
    trials.store_as(*other);
    const ModelSpec finest = candidates(source, bytes, *other, sets).back();
    if (texels_of(finest) > texels_of(specs.back())) found.push_back(trials.near(finest, *best()));
  }

  // the errors of all channels
  if (part.channels != source.channels)
    for (ScatteredPlan& plan : found) {
      chosen.smooth = plan.smooth;
      plan.error = held_out_error(source, plan.spec, chosen, kFolds);
    }
  return *best();
}

}  // namespace burnish
