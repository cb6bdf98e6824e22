// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <optional>
#include <utility>

#include <burnish/fitting/parametric/openpbr_fit.h>
#include <burnish/fitting/parametric/picture_fit.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>

namespace burnish {

namespace {

constexpr FitEffort kTaste{6, 1e-4, 1e-4}, kFirst{30, 1e-5, 1e-4}, kSift{15, 1e-5, 1e-6},
    kSiftAgain{20, 1e-6, 1e-6}, kAgain{10, 1e-6, 1e-6}, kEnd{40, 1e-6, 1e-6}, kLast{80, 1e-8, 1e-6};

constexpr double kLeastCoatIor = 1.05, kLeastFuzzColor = 0.1;

/// An input, or a channel of a colour.
struct Unknown {
  std::size_t input;
  int channel;  ///< -1: a number, or all channels alike
  FittedNumber range;
};

/// Inputs that keep their values, one bit each.
using Inputs = std::bitset<kOpenPbrInputs.size()>;

/// Returns the inputs whose names begin so.
Inputs inputs_named(std::string_view beginning) {
  Inputs named;
  for (std::size_t i = 0; i < kOpenPbrInputs.size(); ++i)
    named[i] = kOpenPbrInputs[i].name.starts_with(beginning);
  return named;
}

const Inputs kCoat = inputs_named("coat"), kFuzz = inputs_named("fuzz"), kFilm = inputs_named("thin_film");

/// Returns the inputs that a fit never varies.
Inputs always_held(const OpenPbrFitOptions& options) {
  Inputs held = inputs_named("base_weight") | inputs_named("geometry_tangent");
  if (!options.anisotropic)
    held |= inputs_named("specular_roughness_anisotropy") | inputs_named("coat_roughness_anisotropy");
  if (options.grey) held |= kFilm;
  if (options.simple) held |= kCoat | kFuzz | kFilm;
  return held;
}

bool is_color(const OpenPbrInput& input) {
  return std::holds_alternative<Rgb OpenPbrParameters::*>(input.member);
}

double get(OpenPbrParameters p, const Unknown& unknown) {
  const auto& member = kOpenPbrInputs[unknown.input].member;
  if (const auto* number = std::get_if<double OpenPbrParameters::*>(&member)) return p.*(*number);
  return channel_of(p.*std::get<Rgb OpenPbrParameters::*>(member), std::max(unknown.channel, 0));
}

void set(OpenPbrParameters& p, const Unknown& unknown, double value) {
  const auto& member = kOpenPbrInputs[unknown.input].member;
  if (const auto* number = std::get_if<double OpenPbrParameters::*>(&member)) {
    p.*(*number) = value;
    return;
  }
  Rgb& color = p.*std::get<Rgb OpenPbrParameters::*>(member);
  if (unknown.channel < 0)
    color = value;
  else
    channel_of(color, unknown.channel) = value;
}

std::vector<Unknown> unknowns_of(const Inputs& held, const OpenPbrFitOptions& options) {
  std::vector<Unknown> unknowns;
  for (std::size_t i = 0; i < kOpenPbrInputs.size(); ++i) {
    if (held[i]) continue;
    const OpenPbrInput& input = kOpenPbrInputs[i];
    Unknown unknown{i, -1, {input.min, input.max, 0}};
    unknown.range.normal = get({}, unknown);
    // sharper highlights are not seen; indices and films are those of known materials
    if (input.name == "specular_roughness" || input.name == "coat_roughness") unknown.range.min = 0.02;
    if (input.name.ends_with("ior")) unknown.range.max = 3;
    if (input.name == "thin_film_thickness") unknown.range.max = 1.5;
    // a coat that bends no light is none, and black fuzz only darkens what the base's colour says
    if (input.name == "coat_ior") unknown.range.min = kLeastCoatIor;
    if (input.name == "fuzz_color") unknown.range.min = kLeastFuzzColor;
    const bool split = is_color(input) && !options.grey;
    for (int c = 0; c < (split ? 3 : 1); ++c) {
      unknown.channel = split ? c : -1;
      unknowns.push_back(unknown);
    }
  }
  return unknowns;
}

// The colours whose channels a film lets see each other.
bool under_film(const Unknown& unknown) {
  const std::string_view name = kOpenPbrInputs[unknown.input].name;
  return name == "base_color" || name == "specular_color";
}

using Search = FitSearch<OpenPbrParameters, Inputs>;
using Trial = Search::Trial;

Trial minimize(const PicturePairs& pairs, const OpenPbrFitOptions& options, const OpenPbrParameters& start,
               const Inputs& held, const FitEffort& effort) {
  const std::vector<Unknown> unknowns = unknowns_of(held, options);
  const bool film = (held & kFilm) != kFilm;
  const auto parameters = [&](std::span<const double> x) {
    OpenPbrParameters p = start;
    for (std::size_t k = 0; k < x.size(); ++k) set(p, unknowns[k], x[k]);
    return p;
  };
  FittedMaterial material;
  std::vector<double> x;
  for (const Unknown& unknown : unknowns) {
    material.numbers.push_back(unknown.range);
    x.push_back(get(start, unknown));
  }
  material.together = [&](std::size_t k) -> std::size_t {
    return unknowns[k].channel < 0 || (film && under_film(unknowns[k])) ? 1 : 3;
  };
  material.at = [&](const std::vector<std::vector<double>>& points) -> MaterialsEval {
    std::vector<OpenPbr> others;
    for (std::size_t i = 1; i < points.size(); ++i) others.emplace_back(parameters(points[i]));
    return [variants = OpenPbrVariants(OpenPbr(parameters(points[0])), std::move(others))](
               Vec3 wi, Vec3 wo, std::span<double> f) { variants.eval(wi, wo, f); };
  };
  const LeastSquaresSolution solution = fit_pictures(pairs, material, std::move(x), effort);
  return {parameters(solution.x), held, solution.first_cost, solution.cost, solution.iterations,
          solution.converged};
}

Search search_on(const PicturePairs& pairs, const OpenPbrFitOptions& options) {
  return Search([&](const Search::Start& start, const FitEffort& effort) {
    return minimize(pairs, options, start.material, start.held, effort);
  });
}

OpenPbrParameters rounded(OpenPbrParameters p) {
  for (const OpenPbrInput& input : kOpenPbrInputs)
    if (const auto* number = std::get_if<double OpenPbrParameters::*>(&input.member)) {
      p.*(*number) = round6(p.*(*number));
    } else {
      Rgb& color = p.*std::get<Rgb OpenPbrParameters::*>(input.member);
      color = {round6(color.r), round6(color.g), round6(color.b)};
    }
  return p;
}

/// Without what none of the weights shows.
OpenPbrParameters tidied(OpenPbrParameters p) {
  constexpr double kNothing = 1e-5;
  const OpenPbrParameters defaults;
  const auto reset = [&](std::string_view layer, double weight) {
    if (weight > kNothing) return;
    for (const OpenPbrInput& input : kOpenPbrInputs)
      if (input.name.starts_with(layer))
        std::visit([&](auto member) { p.*member = defaults.*member; }, input.member);
  };
  reset("coat", p.coat_weight);
  reset("fuzz", p.fuzz_weight);
  reset("thin_film", p.thin_film_weight);
  if (OpenPbr(p).isotropic()) p.geometry_tangent = 0;
  // under a whole coat an index shows as does the coat's square over it: the one that is more like glass
  const double twin = p.coat_ior * p.coat_ior / p.specular_ior;
  const auto unlike = [&](double ior) { return std::abs(ior - defaults.specular_ior); };
  if (p.coat_weight == 1 && twin >= 1 && unlike(twin) < unlike(p.specular_ior)) p.specular_ior = twin;
  return p;
}

OpenPbrFit to_fit(const PicturePairs& pairs, const Trial& trial, double first_cost) {
  OpenPbrFit fit{.parameters = rounded(tidied(rounded(trial.material))), .summary = {}};
  fit.summary = summary_of(pairs, OpenPbr(fit.parameters), first_cost, trial.iterations, trial.converged);
  return fit;
}

/// All layers at once on what was found without them: coats as sharp or rough highlights above the base's, or as its
/// highlight with a rough base below.
std::vector<Search::Start> with_coats(const Trial& trial, const Inputs& always) {
  std::vector<Search::Start> starts;
  OpenPbrParameters p = trial.material;
  p.fuzz_weight = 0.2;
  p.coat_weight = 0.5;
  for (const double roughness : {0.1, 0.35}) {
    p.coat_roughness = roughness;
    starts.push_back({p, always});
  }
  p.coat_weight = 1;
  p.coat_roughness = p.specular_roughness;
  p.coat_roughness_anisotropy = p.specular_roughness_anisotropy;
  p.specular_roughness = std::max(p.specular_roughness, 0.5);
  starts.push_back({p, always});
  return starts;
}

/// Films: errors have a minimum a fringe, so that thin to thick ones are tasted on a grey base and the best two handed
/// on, and the better one on the colours as they are.
std::vector<Search::Start> with_films(Search& search, const Trial& trial, const Inputs& always) {
  if ((always & kFilm) == kFilm) return {};
  constexpr double kStep = 0.1;
  constexpr int kSteps = 12;
  const Inputs tasted = inputs_named("base_color") | inputs_named("specular_roughness") | kFilm;
  std::vector<Search::Start> tastes;
  OpenPbrParameters p = trial.material;
  p.base_color = (p.base_color.r + p.base_color.g + p.base_color.b) / 3;
  p.specular_color = 1;
  p.thin_film_weight = 1;
  for (int i = 1; i <= kSteps; ++i) {
    p.thin_film_thickness = kStep * i;
    tastes.push_back({p, ~tasted | always});
  }
  const std::vector<Trial> best = search.run(tastes, kTaste);
  p = trial.material;
  p.thin_film_weight = 0.5;
  p.thin_film_thickness = best[0].material.thin_film_thickness;
  std::vector<Search::Start> starts;
  for (OpenPbrParameters filmed : {best[0].material, best[1].material, p}) {
    starts.push_back({filmed, (trial.held & ~kFilm) | always});
    filmed.coat_weight = 0.3;
    filmed.coat_roughness = 0.2;
    filmed.fuzz_weight = 0.2;
    starts.push_back({filmed, always});
  }
  return starts;
}

constexpr std::size_t kCoarse = 3, kCoarser = 12;

/// All inputs anywhere in their ranges.
Search::Start random_start(Pcg32& random, const Inputs& always, const OpenPbrFitOptions& options) {
  Search::Start start{{.geometry_tangent = options.tangent}, always};
  for (const Unknown& unknown : unknowns_of(always, options))
    set(start.material, unknown,
        unknown.range.min + (unknown.range.max - unknown.range.min) * random.uniform());
  return start;
}

/// Random starts, of which the better quarter goes on; best first.
std::vector<Trial> search_at_random(Search& search, int count, std::uint64_t seed,
                                    const OpenPbrFitOptions& options) {
  Pcg32 random(seed);
  std::vector<Search::Start> starts;
  for (int i = 0; i < count; ++i) starts.push_back(random_start(random, always_held(options), options));
  const std::vector<Trial> sifted = search.run(starts, kSift);
  return search.run(best_of(sifted, (sifted.size() + 3) / 4), kSiftAgain);
}

constexpr std::size_t kKept = 2;  // trials that are built upon
constexpr std::size_t kEnds = 4;  // and that go to their ends

/// Returns the starts from which the search continues: the best of the base alone and below coats, of films, and of
/// random starts. Random starts are compared on a twelfth and then a third of the pixels, so their costs cannot be
/// compared with the others.
std::vector<Search::Start> search_layers(Search& search, Search& sift, const PicturePairs& pairs,
                                         const OpenPbrFitOptions& options,
                                         const std::function<void(double)>& progress) {
  constexpr int kRandom = 240;
  constexpr std::size_t kCoated = 3, kFilmed = 3, kTasted = 16, kDrawn = 5;
  const Inputs always = always_held(options);
  std::vector<Search::Start> starts;
  for (const double metalness : {0.0, 1.0})
    for (const double roughness : {0.15, 0.35, 0.65})
      starts.push_back({{.base_color = mean_color(pairs),
                         .base_metalness = metalness,
                         .specular_roughness = roughness,
                         .geometry_tangent = options.tangent},
                        always | kCoat | kFuzz | kFilm});
  std::vector<Trial> coated = search.run(starts, kFirst);
  progress(0.2);
  std::vector<Search::Start> coats;
  for (std::size_t i = 0; i < kKept && !options.simple; ++i) add_starts(coats, with_coats(coated[i], always));
  const std::vector<Search::Start> films = with_films(search, coated.front(), always);
  for (const Trial& trial : search.run(coats, kFirst)) coated.push_back(trial);
  std::ranges::stable_sort(coated, {}, &Trial::cost);

  std::vector<Search::Start> best = best_of(coated, kCoated);
  for (const Search::Start& start : best_of(search.run(films, kFirst), kFilmed)) best.push_back(start);
  const PicturePairs coarser = thinned(pairs, kCoarser);
  Search taste = search_on(coarser, options);
  const std::vector<Trial> tasted = search_at_random(taste, kRandom, 1, options);
  for (const Search::Start& start : best_of(sift.run(best_of(tasted, kTasted), kSiftAgain), kDrawn))
    best.push_back(start);
  sift.add(taste);
  progress(0.7);
  return best;
}

/// A base under a coat and nothing else: colours of both and darkening say the same of the base's colour, each a little
/// otherwise, so that none of them alone goes back to its default once another has what is its.
Trial plainly_coated(Search& search, Search& sift, const PicturePairs& pairs,
                     const OpenPbrFitOptions& options) {
  Inputs varied;
  for (const std::string_view name :
       {"base_color", "specular_roughness", "specular_ior", "coat_weight", "coat_roughness", "coat_ior"})
    varied |= inputs_named(name);
  const Inputs held = ~varied | always_held(options);
  std::vector<Search::Start> starts;
  for (const double metalness : {0.0, 1.0})
    for (const double roughness : {0.2, 0.5})
      for (const double coat : {0.0, 0.03, 0.2})  // a mirror that no light is seen in stays one
        starts.push_back({{.base_color = mean_color(pairs),
                           .base_metalness = metalness,
                           .specular_roughness = roughness,
                           .coat_weight = 0.8,
                           .coat_roughness = coat,
                           .geometry_tangent = options.tangent},
                          coat > 0 ? held : held | inputs_named("coat_roughness")});
  return search.run(best_of(sift.run(starts, kFirst), kKept), kEnd).front();
}

/// The same with what shows too little at its default: layers first, then what others say as well.
Trial simplified(Search& search, Search& sift, const PicturePairs& pairs, const OpenPbrFitOptions& options,
                 Trial best) {
  // a layer is worth half a decibel of the pictures, any other input a percent of the squared error
  constexpr double kLayersWorth = 1.12, kAsGood = 1.01, kExact = 2e-11;
  const double most = kAsGood * best.cost + kExact;
  if ((best.held & kCoat) != kCoat)
    if (const Trial plain = plainly_coated(search, sift, pairs, options); plain.cost <= most) best = plain;
  const OpenPbrParameters defaults;
  for (const std::string_view name :
       {"thin_film", "fuzz", "coat", "specular_color", "coat_color", "coat_darkening", "specular_weight",
        "fuzz_color", "base_diffuse_roughness", "specular_roughness_anisotropy",
        "coat_roughness_anisotropy"}) {
    const Inputs group = inputs_named(name);
    if ((best.held & group) == group) continue;
    OpenPbrParameters without = best.material;
    for (std::size_t i = 0; i < kOpenPbrInputs.size(); ++i)
      if (group[i])
        std::visit([&](auto member) { without.*member = defaults.*member; }, kOpenPbrInputs[i].member);
    const Trial trial = search.run({{without, best.held | group}}, kAgain).front();
    const bool is_layer = group == kFilm || group == kFuzz || group == kCoat;
    if (trial.cost <= (is_layer ? std::max(most, kLayersWorth * best.cost + kExact) : most)) best = trial;
  }
  return best;
}

}  // namespace

OpenPbrFit refine_openpbr(const PicturePairs& pairs, const OpenPbrParameters& start,
                          const OpenPbrFitOptions& options) {
  const Trial trial = minimize(pairs, options, start, always_held(options), kLast);
  OpenPbrFit fit = to_fit(pairs, trial, trial.first_cost);
  fit.starts = 1;
  return fit;
}

OpenPbrFit fit_openpbr_at_random(const PicturePairs& pairs, int count, std::uint64_t seed,
                                 const OpenPbrFitOptions& options) {
  const PicturePairs coarse = thinned(pairs, kCoarse);
  Search sift = search_on(coarse, options), search = search_on(pairs, options);
  const std::vector<Trial> trials = search_at_random(sift, count, seed, options);
  const std::vector<Trial> ends =
      search.run(best_of(trials, (static_cast<std::size_t>(count) + 19) / 20), kLast);

  const double first_cost = std::ranges::min(ends, {}, &Trial::first_cost).first_cost;
  std::vector<OpenPbrFit> fits;
  for (const Trial& trial : ends) fits.push_back(to_fit(pairs, trial, first_cost));
  OpenPbrFit best =
      *std::ranges::min_element(fits, {}, [](const OpenPbrFit& fit) { return fit.summary.error_after; });
  best.summary.iterations = sift.iterations + search.iterations;
  best.starts = count;
  return best;
}

OpenPbrFit fit_openpbr(const PicturePairs& pairs, const OpenPbrFitOptions& options) {
  const PicturePairs coarse = thinned(pairs, kCoarse);
  Search sift = search_on(coarse, options), search = search_on(pairs, options);
  const auto progress = [&](double fraction) {
    if (options.progress) options.progress(fraction);
  };
  const std::vector<Search::Start> found = search_layers(search, sift, pairs, options, progress);

  // these on all pixels, and films on the best of them
  std::vector<Trial> kept = search.run(found, kSiftAgain);
  const std::vector<Search::Start> films = with_films(sift, kept.front(), always_held(options));
  for (const Trial& trial : search.run(best_of(sift.run(films, kFirst), kKept), kSiftAgain))
    kept.push_back(trial);
  std::ranges::stable_sort(kept, {}, &Trial::cost);
  progress(0.8);

  // the better ones to their ends, the one whose pictures differ least without what it does not need, and that to its
  // end
  const std::vector<Trial> ends = search.run(best_of(kept, kEnds), kEnd);
  const auto difference = [&](const Trial& trial) { return to_fit(pairs, trial, 0).summary.error_after; };
  const Trial simple =
      simplified(search, sift, pairs, options, *std::ranges::min_element(ends, {}, difference));
  progress(0.9);
  const Trial best = search.run({{simple.material, simple.held}}, kLast).front();
  progress(1);
  OpenPbrFit fit = to_fit(pairs, best, kept.front().first_cost);
  fit.summary.iterations = sift.iterations + search.iterations;
  fit.starts = sift.count + search.count;
  return fit;
}

}  // namespace burnish
