// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <hwy/cache_control.h>

#include <burnish/capture/training_pixels.h>
#include <burnish/error.h>
#include <burnish/eval/lobe_evaluator.h>
#include <burnish/math/random.h>

namespace burnish {

namespace {

constexpr std::size_t kHalfBins = 32;  // even along the root of theta_h
// pi / 2 with only these digits: more digits would move pixels at the edges of bins, and so change the bits of fits.
constexpr double kBinnedAngle = 1.5707963;
constexpr double kMinPairCosine = 0.05;  // for pairs; pixels may be lower
constexpr double kMinPixelCosine = 0.02;
constexpr float kMinTrust = 0.05f;
constexpr float kEarlyError = 0.07f;          // share of squared errors in mild trust
constexpr float kHeld = 0.02f;                // weight of clipped pixels if the model already is above them
constexpr std::size_t kDrawsPerPixel = 6;     // many draws fall on angles that already have enough pixels
constexpr std::uint64_t kFirstStream = 1000;  // for random numbers; smaller ones are used elsewhere

Vec3 normal_of(const std::vector<float>& normals, std::size_t t) noexcept {
  if (normals.empty()) return {0, 0, 1};
  const double x = static_cast<double>(normals[2 * t]), y = static_cast<double>(normals[2 * t + 1]);
  return normalize({x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))});
}

/// A pixel that may be fitted, and its directions in the texel's frame.
struct Candidate {
  std::uint32_t picture, texel;
  DirectionPair pair;
  std::size_t bin;  // the bin of theta_h
};

struct Candidates {
  std::vector<Candidate> pixels;
  std::vector<std::size_t> in_bin;  // number of pixels of each theta_h
};

/// Returns the weight of a pixel in the fit of lobes.
float trust_in(const KnownTexels& known, std::size_t pixel) noexcept {
  if (known.trust == PixelTrust::alike) return 1;
  const float trust = known.fits.trust[pixel];
  if (known.trust == PixelTrust::as_found || trust == 0) return trust;
  // TexelSolver turned an error e into the trust 1 / (1 + e)^2. The lines below do the same for a share of that
  // error.
  const float share = 1 + kEarlyError * (1 / std::sqrt(trust) - 1);
  return 1 / (share * share);
}

/// Returns a pixel if it is there, can be trusted and is not seen or lit at a grazing angle.
std::optional<Candidate> candidate(const KnownTexels& known, std::uint32_t t, std::uint32_t p) {
  const TexelSamples& samples = known.samples;
  const std::size_t pixel = p * samples.size() + t;
  if (!is_there(samples.states[pixel]) || trust_in(known, pixel) < kMinTrust) return std::nullopt;
  const Vec3 point = known.form.point(samples.texels[t][0], samples.texels[t][1]);
  const ShadingFrame frame = frame_about(normal_of(known.fits.normals, t), {1, 0, 0});
  const auto [light, view] = samples.seen(known.form.pictures[p], p, t, point);
  Candidate c{.picture = p, .texel = t, .pair = {frame.local(light), frame.local(view)}, .bin = 0};
  if (c.pair.wi.z < kMinPixelCosine || c.pair.wo.z < kMinPixelCosine) return std::nullopt;
  const Vec3 h = half_vector(c.pair.wi, c.pair.wo);
  const double theta_h = std::acos(std::clamp(h.z, -1.0, 1.0));
  c.bin = std::min(kHalfBins - 1, static_cast<std::size_t>(std::sqrt(theta_h / kBinnedAngle) * kHalfBins));
  return c;
}

/// Draws pixels of some texels at random, in the fitted pictures.
Candidates candidates(const KnownTexels& known, std::span<const std::size_t> texels, std::size_t draws,
                      Pcg32 random) {
  const TexelSamples& samples = known.samples;
  std::vector<std::uint32_t> fitted;
  for (std::size_t p = 0; p < known.form.pictures.size(); ++p)
    if (!known.form.pictures[p].held_out) fitted.push_back(static_cast<std::uint32_t>(p));

  Candidates found{.pixels = {}, .in_bin = std::vector<std::size_t>(kHalfBins)};
  constexpr std::size_t kAtOnce = 256;  // pixels whose memory is prefetched before the first is used
  std::array<std::pair<std::uint32_t, std::uint32_t>, kAtOnce> drawn;
  for (std::size_t begin = 0; begin < draws; begin += kAtOnce) {
    const auto some = std::span(drawn).first(std::min(kAtOnce, draws - begin));
    for (auto& [t, p] : some) {
      t = static_cast<std::uint32_t>(texels[random.next() % texels.size()]);
      p = fitted[random.next() % fitted.size()];
      const std::size_t pixel = p * samples.size() + t;
      hwy::Prefetch(&samples.states[pixel]);
      if (!known.fits.trust.empty()) hwy::Prefetch(&known.fits.trust[pixel]);
    }
    for (const auto& [t, p] : some)
      if (const std::optional<Candidate> c = candidate(known, t, p)) {
        ++found.in_bin[c->bin];
        found.pixels.push_back(*c);
      }
  }
  if (found.pixels.empty()) throw Error("surface fit: expected pixels that can be fitted, found none");
  return found;
}

/// Returns the number of pixels that each bin may give so that all bins together give `count`. Bins with fewer pixels
/// leave their rest to the other bins.
std::size_t even_part(const std::vector<std::size_t>& in_bin, std::size_t count) {
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

/// f of the present lobes, with the texel's weights.
std::array<float, kCaptureChannels> modelled_at(const LobeEvaluator& lobes, const TexelFits& fits,
                                                const Candidate& c) {
  std::array<float, LobeEvaluator::kWeightStride * kMaxSurfaceLobes> weights{};
  for (std::size_t j = 0; j < lobes.lobes(); ++j)
    for (std::size_t k = 0; k < kCaptureChannels; ++k)
      weights[LobeEvaluator::kWeightStride * j + k] = fits.weights[c.texel * lobes.lobes() + j];
  std::array<float, kCaptureChannels> f{};
  lobes.eval(c.pair.wi, c.pair.wo, std::span(weights).first(LobeEvaluator::kWeightStride * lobes.lobes()), f);
  return f;
}

/// Adds a pixel to the set. A clipped value is a lower bound: it is replaced by the lobes' value if that is larger. A
/// step therefore never raises the one-sided error, and lobes stay where they are if nothing else holds them.
void add_pixel(const KnownTexels& known, const LobeEvaluator* lobes, const Candidate& c, double weight,
               TrainingSet& set) {
  const TexelSamples& samples = known.samples;
  const std::size_t pixel = c.picture * samples.size() + c.texel;
  const PixelState state = samples.states[pixel];
  std::array<float, kCaptureChannels> modelled{};
  if (lobes && is_clipped(state)) modelled = modelled_at(*lobes, known.fits, c);
  set.pairs.push_back(c.pair);
  bool held = false;
  for (std::size_t k = 0; k < kCaptureChannels; ++k) {
    const float value =
        std::max(0.0f, samples.values[kCaptureChannels * pixel + k]) / static_cast<float>(c.pair.wi.z);
    const bool above = is_clipped(state, k) && modelled[k] > value;
    held = held || above;
    set.values.push_back(above ? modelled[k] : value);
  }
  set.weights.push_back(static_cast<float>(weight) * trust_in(known, pixel) * (held ? kHeld : 1));
  const std::size_t weights = known.fits.weights.size() / samples.size();
  for (std::size_t j = 0; j < weights; ++j)
    set.lobe_weights.push_back(known.fits.weights[c.texel * weights + j]);
}

}  // namespace

TrainingSet training_pixels(const KnownTexels& known, std::span<const std::size_t> texels, std::size_t count,
                            std::uint64_t seed, std::uint64_t stream) {
  // Many pixels are drawn, and each bin of theta_h gives at most its even part of them.
  const Candidates all =
      candidates(known, texels, kDrawsPerPixel * count, Pcg32(seed, kFirstStream + stream));
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
                  .exposure = known.exposure,
                  .albedo = {}};
  std::optional<LobeEvaluator> evaluator;
  if (known.lobes) evaluator.emplace(*known.lobes);
  const LobeEvaluator* const lobes = evaluator ? &*evaluator : nullptr;
  // Every second pixel goes to the pictures: its weight stands for all drawn pixels of its bin.
  for (std::size_t i = 0; i < chosen.size(); i += 2) {
    const std::size_t there = all.in_bin[chosen[i]->bin];
    add_pixel(known, lobes, *chosen[i],
              static_cast<double>(there) / static_cast<double>(std::min(there, part)), set);
  }
  set.picture_count = set.size();
  // The other pixels go to the pairs, with equal weights.
  for (std::size_t i = 1; i < chosen.size(); i += 2)
    if (std::min(chosen[i]->pair.wi.z, chosen[i]->pair.wo.z) > kMinPairCosine)
      add_pixel(known, lobes, *chosen[i], 1, set);
  return set;
}

}  // namespace burnish
