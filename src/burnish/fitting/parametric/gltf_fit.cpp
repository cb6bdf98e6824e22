// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <utility>
#include <variant>

#include <burnish/fitting/parametric/gltf_fit.h>
#include <burnish/fitting/parametric/picture_fit.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>

namespace burnish {

namespace {

constexpr FitEffort kTaste{6, 1e-4, 1e-4}, kSift{15, 1e-5, 1e-5}, kFirst{30, 1e-5, 1e-5},
    kAgain{20, 1e-6, 1e-6}, kEnd{60, 1e-8, 1e-6};

/// Inputs that are varied or left out together: the core material, or an extension.
enum Layer : std::uint8_t { kCore, kIor, kSpecular, kGrain, kFilm, kSheen, kCoat, kLayers };
using Layers = std::bitset<kLayers>;

Layers only(std::initializer_list<Layer> layers) {
  Layers set;
  for (const Layer layer : layers) set.set(layer);
  return set;
}

/// Strength squared, which alphas are linear in.
double grain_of(const GltfMaterial& m) {
  return m.anisotropy * m.anisotropy;
}
void set_grain(GltfMaterial& m, double grain) {
  m.anisotropy = std::sqrt(grain);
}

/// A number or a colour of the material; the grain has no member.
struct Input {
  Layer layer;
  double min, max;
  std::variant<std::monostate, double GltfMaterial::*, Rgb GltfMaterial::*> member;
};
constexpr std::array<Input, 14> kInputs = {{
    {kCore, 0, 1, &GltfMaterial::base_color},
    {kCore, 0, 1, &GltfMaterial::metallic},
    {kCore, 0.03, 1, &GltfMaterial::roughness},
    {kIor, 1, 3, &GltfMaterial::ior},
    {kSpecular, 0, 1, &GltfMaterial::specular},
    {kSpecular, 0, 1, &GltfMaterial::specular_color},
    {kGrain, 0, 1, {}},
    {kFilm, 0, 1, &GltfMaterial::iridescence},
    {kFilm, 1.2, 3, &GltfMaterial::iridescence_ior},
    {kFilm, 0, 1500, &GltfMaterial::iridescence_thickness},
    {kSheen, 0, 1, &GltfMaterial::sheen_color},
    {kSheen, 0.1, 1, &GltfMaterial::sheen_roughness},
    {kCoat, 0, 1, &GltfMaterial::clearcoat},
    {kCoat, 0.1, 1, &GltfMaterial::clearcoat_roughness},
}};

/// An input, or a channel of a colour.
struct Unknown {
  const Input* input;
  int channel;  ///< -1: a number, or all channels alike
};

double get(GltfMaterial m, const Unknown& unknown) {
  const auto& member = unknown.input->member;
  if (const auto* number = std::get_if<double GltfMaterial::*>(&member)) return m.*(*number);
  if (const auto* color = std::get_if<Rgb GltfMaterial::*>(&member))
    return channel_of(m.*(*color), std::max(unknown.channel, 0));
  return grain_of(m);
}

void set(GltfMaterial& m, const Unknown& unknown, double value) {
  const auto& member = unknown.input->member;
  if (const auto* number = std::get_if<double GltfMaterial::*>(&member))
    m.*(*number) = value;
  else if (const auto* color = std::get_if<Rgb GltfMaterial::*>(&member))
    unknown.channel < 0 ? void(m.*(*color) = value) : void(channel_of(m.*(*color), unknown.channel) = value);
  else
    set_grain(m, value);
}

/// The same without some layers.
GltfMaterial without(GltfMaterial m, const Layers& layers) {
  const GltfMaterial neutral;
  for (const Input& input : kInputs)
    if (layers[input.layer])
      for (const int channel : {0, 1, 2}) set(m, {&input, channel}, get(neutral, {&input, channel}));
  return m;
}

using Search = FitSearch<GltfMaterial, Layers>;
using Start = Search::Start;
using Trial = Search::Trial;

std::vector<Unknown> unknowns_of(const Layers& held, bool grey) {
  std::vector<Unknown> unknowns;
  for (const Input& input : kInputs) {
    if (held[input.layer]) continue;
    const bool split = std::holds_alternative<Rgb GltfMaterial::*>(input.member) && !grey;
    for (int c = 0; c < (split ? 3 : 1); ++c) unknowns.push_back({&input, split ? c : -1});
  }
  return unknowns;
}

Trial minimize(const PicturePairs& pairs, bool grey, const Start& start, const FitEffort& effort) {
  const std::vector<Unknown> unknowns = unknowns_of(start.held, grey);
  const auto material_at = [&](std::span<const double> x) {
    GltfMaterial m = start.material;
    for (std::size_t k = 0; k < x.size(); ++k) set(m, unknowns[k], x[k]);
    return m;
  };
  FittedMaterial fitted;
  std::vector<double> x;
  for (const Unknown& unknown : unknowns) {
    fitted.numbers.push_back({unknown.input->min, unknown.input->max, get({}, unknown)});
    x.push_back(get(start.material, unknown));
  }
  fitted.together = [](std::size_t) -> std::size_t { return 1; };  // layers see the greatest channel
  fitted.at = [&](const std::vector<std::vector<double>>& points) -> MaterialsEval {
    std::vector<GltfMaterial> materials;
    for (const std::vector<double>& point : points) materials.push_back(material_at(point));
    return [materials = std::move(materials)](Vec3 wi, Vec3 wo, std::span<double> f) {
      for (std::size_t i = 0; i < materials.size(); ++i) materials[i].eval(wi, wo, f.subspan(3 * i, 3));
    };
  };
  const LeastSquaresSolution solution = fit_pictures(pairs, fitted, std::move(x), effort);
  return {material_at(solution.x), start.held,          solution.first_cost,
          solution.cost,           solution.iterations, solution.converged};
}

Search search_on(const PicturePairs& pairs, bool grey) {
  return Search([&pairs, grey](const Start& start, const FitEffort& effort) {
    return minimize(pairs, grey, start, effort);
  });
}

/// Metals and dielectrics, from smooth to rough.
std::vector<Start> core_starts(const PicturePairs& pairs, double rotation, const Layers& held) {
  std::vector<Start> starts;
  for (const double metallic : {0.0, 1.0})
    for (const double roughness : {0.15, 0.35, 0.65})
      starts.push_back({{.base_color = mean_color(pairs),
                         .metallic = metallic,
                         .roughness = roughness,
                         .rotation = rotation},
                        held});
  return starts;
}

/// Coats, sharp and rough, above what was found or as its highlight, and sheen.
std::vector<Start> with_layers(const GltfMaterial& found, const Layers& always) {
  std::vector<Start> starts;
  GltfMaterial m = found;
  m.clearcoat = 0.5;
  for (const double roughness : {0.1, 0.35}) {
    m.clearcoat_roughness = roughness;
    starts.push_back({m, always});
  }
  m.clearcoat = 1;
  m.clearcoat_roughness = found.roughness;
  m.roughness = std::max(found.roughness, 0.5);
  starts.push_back({m, always});
  for (const double roughness : {0.3, 0.7}) {
    m = found;
    m.sheen_color = 0.2;
    m.sheen_roughness = roughness;
    starts.push_back({m, always});
  }
  return starts;
}

/// Films, whose errors have a minimum a fringe: thin to thick ones tasted, the best two handed on.
std::vector<Start> with_films(Search& search, const Trial& found, const Layers& always) {
  if (always[kFilm]) return {};
  constexpr double kStep = 100;  // nanometres
  constexpr int kSteps = 12;
  std::vector<Start> tastes;
  GltfMaterial m = found.material;
  m.iridescence = 1;
  for (int i = 1; i <= kSteps; ++i) {
    m.iridescence_thickness = kStep * i;
    tastes.push_back({m, ~only({kCore, kFilm})});
  }
  std::vector<Start> starts;
  for (const Start& start : best_of(search.run(tastes, kTaste), 2))
    starts.push_back({start.material, always});
  return starts;
}

/// Anywhere in the ranges.
Start random_start(Pcg32& random, const Layers& always, const GltfFitOptions& options) {
  Start start{{.rotation = radians(options.tangent)}, always};
  for (const Unknown& unknown : unknowns_of(always, options.grey)) {
    const auto& [layer, min, max, member] = *unknown.input;
    set(start.material, unknown, min + (max - min) * random.uniform());
  }
  return start;
}

/// The same with layers back at what nobody set, where that shows too little; without a film the others are tried too.
Trial simplified(Search& search, Trial best, const std::vector<Trial>& others) {
  constexpr double kAsGood = 1.01, kExact = 2e-11;
  constexpr double kFilmsWorth = 1.12;  // half a decibel: programs have films of their own, of other colours
  const auto without_layer = [](const Trial& trial, Layer layer) -> Start {
    return {without(trial.material, only({layer})), trial.held | only({layer})};
  };
  if (!best.held[kFilm]) {
    std::vector<Start> starts = {without_layer(best, kFilm)};
    for (const Trial& trial : others) starts.push_back(without_layer(trial, kFilm));
    const Trial trial = search.run(starts, kAgain).front();
    if (trial.cost <= kFilmsWorth * best.cost + kExact) best = trial;
  }
  const double most = kAsGood * best.cost + kExact;
  for (const Layer layer : {kSheen, kCoat, kGrain, kSpecular, kIor}) {
    if (best.held[layer]) continue;
    const Trial trial = search.run({without_layer(best, layer)}, kAgain).front();
    if (trial.cost <= most) best = trial;
  }
  return best;
}

GltfMaterial rounded(GltfMaterial m) {
  for (const Input& input : kInputs)
    if (std::holds_alternative<std::monostate>(input.member)) {
      m.anisotropy = round6(m.anisotropy);
      m.rotation = m.anisotropy > 0 ? round6(m.rotation) : 0;
    } else {
      for (const int channel : {0, 1, 2}) set(m, {&input, channel}, round6(get(m, {&input, channel})));
    }
  return m;
}

/// Without what none of the weights shows.
GltfMaterial tidied(const GltfMaterial& m) {
  Layers nothing;
  nothing[kFilm] = m.iridescence == 0;
  nothing[kSheen] = m.sheen_color == Rgb(0);
  nothing[kCoat] = m.clearcoat == 0;
  return without(m, nothing);
}

GltfFit to_fit(const PicturePairs& pairs, const Trial& trial, double first_cost) {
  GltfFit fit{.material = tidied(rounded(trial.material)), .summary = {}};
  fit.summary = summary_of(pairs, fit.material, first_cost, trial.iterations, trial.converged);
  return fit;
}

}  // namespace

GltfFit fit_gltf(const PicturePairs& pairs, const GltfFitOptions& options) {
  constexpr std::size_t kCoarse = 3, kCoarser = 12;                      // pixels: every third, every twelfth
  constexpr std::size_t kCores = 2, kTasted = 8, kFound = 6, kEnds = 3;  // trials that go on
  constexpr int kRandom = 60;
  const PicturePairs coarse = thinned(pairs, kCoarse), coarser = thinned(pairs, kCoarser);
  Search search = search_on(pairs, options.grey), sift = search_on(coarse, options.grey),
         taste = search_on(coarser, options.grey);
  const auto progress = [&](double fraction) {
    if (options.progress) options.progress(fraction);
  };
  Layers always;
  always[kGrain] = !options.anisotropic;
  always[kFilm] = options.grey;
  const Layers core = always | only({kFilm, kSheen, kCoat});
  std::vector<Trial> found = sift.run(core_starts(pairs, radians(options.tangent), core), kFirst);
  progress(0.2);

  // these under layers, and random ones
  std::vector<Start> starts;
  for (std::size_t i = 0; i < kCores; ++i) add_starts(starts, with_layers(found[i].material, always));
  add_starts(starts, with_films(sift, found.front(), always));
  Pcg32 random(1);
  std::vector<Start> drawn;
  for (int i = 0; i < kRandom; ++i) drawn.push_back(random_start(random, always, options));
  add_starts(starts, best_of(taste.run(drawn, kSift), kTasted));
  for (Trial& trial : sift.run(starts, kFirst)) found.push_back(std::move(trial));
  std::ranges::stable_sort(found, {}, &Trial::cost);
  progress(0.6);

  // the best on all pixels to their ends, the one whose pictures differ least without what it does not need
  const std::vector<Trial> kept = search.run(best_of(found, kFound), kAgain);
  const std::vector<Trial> ends = search.run(best_of(kept, kEnds), kEnd);
  const auto difference = [&](const Trial& trial) { return to_fit(pairs, trial, 0).summary.error_after; };
  const Trial simple = simplified(search, *std::ranges::min_element(ends, {}, difference), ends);
  progress(0.9);
  const Trial best = search.run({{simple.material, simple.held}}, kEnd).front();
  progress(1);

  GltfFit fit = to_fit(pairs, best, kept.front().first_cost);
  search.add(sift);
  search.add(taste);
  fit.summary.iterations = search.iterations;
  fit.starts = search.count;
  return fit;
}

}  // namespace burnish
