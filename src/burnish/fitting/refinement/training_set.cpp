// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

#include <burnish/error.h>
#include <burnish/fitting/refinement/training_set.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/metrics/albedo.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/angle_table.h>

namespace burnish {

namespace {

constexpr double kMaxLightAngle = radians(75);
constexpr double kPixelCosine = 0.01, kPairCosine = 0.05;  // the second as in the error figures
constexpr double kRimCosine = 0.005, kRimWeight = 0.1;     // of pairs nearer to the horizon than that
constexpr double kCrowdedPixelCosine = 1e-3;
constexpr double kExposedShare = 0.97;  // as in the error figures
constexpr std::size_t kPairsATask = 4096;
constexpr double kMaxAlbedoTheta = radians(70), kMinAlbedo = 1e-4, kAlbedoPrecision = 2e-3;
constexpr double kRingTurn = 0.6180339887498949;  // the golden ratio's: rings near one another differ
constexpr std::size_t kAlbedoThetas = 15, kAlbedoRings = 64, kAlbedoAzimuths = 32;

// Points of the additive recurrence of the generalized golden ratio in five dimensions, the root of phi^6 = phi + 1
// [Roberts 2018].
class Recurrence {
 public:
  explicit Recurrence(std::uint64_t seed) {
    Pcg32 random(seed);
    for (double& x : point_) x = random.uniform();
  }
  const std::array<double, 5>& next() {
    constexpr double kRatio = 1.1347241384015194;
    double step = 1;
    for (double& x : point_) {
      step /= kRatio;
      x += step;
      x -= std::floor(x);
    }
    return point_;
  }

 private:
  std::array<double, 5> point_{};
};

Vec3 light_of(double u) {
  const double light = kMaxLightAngle * u;
  return {std::sin(light), 0, std::cos(light)};
}

std::optional<DirectionPair> draw_pixel(const std::array<double, 5>& u) {
  // The pixel's point on the sphere gives the normal. The light and the view are turned into its local frame.
  const std::optional<Vec3> n = sphere_normal(2, 2 * u[0], 2 * u[1]);
  if (!n || std::abs(n->y) >= 1) return {};
  const DirectionPair pair{sphere_local(*n, light_of(u[2])), sphere_local(*n, {0, 0, 1})};
  if (!(pair.wi.z > kPixelCosine) || !(pair.wo.z > kPixelCosine)) return {};
  return pair;
}

// A pixel and its weight beside pixels that are even over the disk.
struct WeightedPixel {
  DirectionPair pair;
  double weight;  // the density of pixels even over the disk, over the pixel's own
};

// Draws a pixel: half of them are even over the disk, half crowd where the sphere mirrors the light.
WeightedPixel draw_crowded_pixel(const std::array<double, 5>& u) {
  // The highlight is where the normal is half way between light and view, at theta_h = 0.
  const Vec3 light = light_of(u[2]), half = normalize(light + Vec3{0, 0, 1});
  const double phi = kTwoPi * u[1];
  Vec3 n;
  if (u[3] < 0.5) {
    // Even pixels: the radius is a root, since areas grow with its square.
    const double r = std::sqrt(u[0]);
    n = {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u[0])};
  } else {
    // Crowded pixels: theta_h = pi/2 u^2 about the half vector, which densifies the highlight.
    const double theta_h = kHalfPi * u[0] * u[0], r = std::sin(theta_h);
    const Vec3 across{half.z, 0, -half.x};
    n = r * std::cos(phi) * across + r * std::sin(phi) * Vec3{0, 1, 0} + std::cos(theta_h) * half;
  }
  // The weight takes both densities over the normal's solid angle: cos / pi of the even ones, and of the crowded ones
  // 1 / (2 pi sin(theta_h)) times du / dtheta_h = 1 / (pi sqrt(theta_h / (pi/2))).
  const double theta_h = std::acos(std::clamp(dot(n, half), -1.0, 1 - 1e-12));
  const double even = std::max(n.z, 0.0) / kPi;
  const double crowded =
      theta_h < kHalfPi ? 1 / (kTwoPi * kPi * std::sin(theta_h) * std::sqrt(theta_h / kHalfPi)) : 0;
  return {{sphere_local(n, light), sphere_local(n, {0, 0, 1})}, 2 * even / (even + crowded)};
}

// Returns x = theta_h / (pi/2) of a point and one over its density. Half of the points are uniform in x, half are
// squares, so the density is 1/2 + 1 / (4 sqrt(x)).
std::array<double, 2> draw_theta_h(double u) {
  const double v = 2 * u - std::floor(2 * u), x = u < 0.5 ? v : v * v;
  return {x, 1 / (0.5 + 0.25 / std::sqrt(std::max(x, 1e-9)))};
}

// Turns both directions about the normal.
DirectionPair turned(const DirectionPair& pair, double angle) {
  const double s = std::sin(angle), c = std::cos(angle);
  const auto turn = [&](Vec3 w) { return Vec3{c * w.x - s * w.y, s * w.x + c * w.y, w.z}; };
  return {turn(pair.wi), turn(pair.wo)};
}

// Evaluates the source at the pairs and drops those at which it is unknown.
void fill_values(BrdfRef source, TrainingSet& set) {
  const auto channels = set.channels;
  std::vector<std::uint8_t> known(set.size());
  std::vector<double> values(set.size() * channels);
  for_each_chunk(set.size(), kPairsATask, [&](std::size_t, std::size_t begin, std::size_t end) {
    source.eval(std::span(set.pairs).subspan(begin, end - begin),
                std::span(values).subspan(begin * channels, (end - begin) * channels),
                std::span(known).subspan(begin, end - begin));
  });
  std::size_t kept = 0, pictures = 0;
  set.values.resize(values.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (!known[i]) continue;
    set.pairs[kept] = set.pairs[i];
    set.weights[kept] = set.weights[i];
    for (std::size_t c = 0; c < channels; ++c)
      set.values[kept * channels + c] = static_cast<float>(std::max(values[i * channels + c], 0.0));
    pictures += i < set.picture_count;
    ++kept;
  }
  set.pairs.resize(kept);
  set.weights.resize(kept);
  set.values.resize(kept * channels);
  set.picture_count = pictures;
}

// Returns 1 / (the weighted percentile kExposedShare of the pixels' f cos theta_i), linear between values. `unlit` is
// the weight of black pixels that the set leaves out.
double exposure_of(const TrainingSet& set, double unlit) {
  const auto channels = set.channels;
  struct Shown {
    float value, weight;
  };
  std::vector<Shown> shown;
  double total = 0;
  for (std::size_t i = 0; i < set.picture_count; ++i)
    for (std::size_t c = 0; c < channels; ++c) {
      shown.push_back({set.values[i * channels + c] * static_cast<float>(set.pairs[i].wi.z), set.weights[i]});
      total += shown.back().weight;
    }
  if (shown.empty()) return 1;
  std::ranges::sort(shown, {}, &Shown::value);
  const double mean = total / static_cast<double>(shown.size()),
               black = unlit * static_cast<double>(channels);
  // The percentile counts the mean weight once less, as n values have n - 1 gaps. Black pixels come first.
  double rest = std::max(0.0, kExposedShare * (total + black - mean) - black);
  std::size_t low = 0;
  while (low + 1 < shown.size() && rest >= shown[low].weight) rest -= shown[low++].weight;
  const double next = shown[std::min(low + 1, shown.size() - 1)].value;
  const double white = shown[low].value + rest / shown[low].weight * (next - shown[low].value);
  return white > 0 ? 1 / white : 1;
}

}  // namespace

TrainingSet draw_training_set(BrdfRef source, const TrainingOptions& options) {
  TrainingSet set{.channels = source.channels(), .isotropic = source.isotropic()};
  Recurrence points(options.seed);

  // Draws the pixels of lit spheres. A crowded pixel that the light does not reach only adds to the black ones.
  double unlit = 0;
  while (set.pairs.size() < options.pictures) {
    if (!options.crowded) {
      if (const auto pixel = draw_pixel(points.next())) set.pairs.push_back(*pixel);
      continue;
    }
    const auto [pair, weight] = draw_crowded_pixel(points.next());
    if (!(pair.wo.z > kCrowdedPixelCosine)) continue;
    if (pair.wi.z > kCrowdedPixelCosine) {
      set.pairs.push_back(pair);
      set.weights.push_back(static_cast<float>(weight));
    } else {
      unlit += weight;
    }
  }
  set.weights.resize(set.pairs.size(), 1);
  set.picture_count = set.pairs.size();

  // Draws the pairs over all directions. Those near the horizon come beside the number asked for, with little weight.
  for (std::size_t drawn = 0; drawn < options.directions;) {
    const std::array<double, 5>& u = points.next();
    const auto [theta_h, weight] = draw_theta_h(u[0]);
    const HalfDiff angles{.theta_h = kHalfPi * theta_h,
                          .phi_h = source.isotropic() ? 0 : kTwoPi * u[3],
                          .theta_d = kHalfPi * u[1],
                          .phi_d = kTwoPi * u[2]};
    const HalfDiffDirections pair = from_half_diff(angles);
    const double least = std::min(pair.wi.z, pair.wo.z);
    if (!(least > kRimCosine)) continue;
    const bool rim = !(least > kPairCosine);
    set.pairs.push_back({pair.wi, pair.wo});
    set.weights.push_back(static_cast<float>(rim ? kRimWeight * weight : weight));
    drawn += !rim;
  }

  // The source is evaluated at all of them, after a turn about the normal where that is asked for.
  if (options.spread_phi_h && source.isotropic())
    for (DirectionPair& pair : set.pairs) pair = turned(pair, kTwoPi * points.next()[4]);
  fill_values(source, set);
  if (set.size() == 0) throw Error("fit: expected a source with known values, found none");
  set.exposure = exposure_of(set, unlit);
  return set;
}

AlbedoSet albedo_set(BrdfRef source) {
  const std::size_t sides = source.isotropic() ? 1 : 4;
  AlbedoSet set{.directions = kAlbedoThetas * sides};
  std::vector<double> f(source.channels());
  for (std::size_t k = 0; k < set.directions; ++k) {
    const double theta = kMaxAlbedoTheta * static_cast<double>(k / sides) / (kAlbedoThetas - 1);
    const double phi = kTwoPi * (static_cast<double>(k % sides) + 0.3) / 4;
    const Vec3 wi = spherical_direction(theta, phi);

    // Rings crowd around the mirror direction: radius = most u^2, so dr = 2 most u du. They are cut at the horizon,
    // where cos(theta_o) = level + slope cos(azimuth) is 0.
    for (std::size_t ring = 0; ring < kAlbedoRings; ++ring)
      for (std::size_t j = 0; j < kAlbedoAzimuths; ++j) {
        const double most = kHalfPi + theta, u = (static_cast<double>(ring) + 0.5) / kAlbedoRings;
        const double radius = most * u * u, level = std::cos(radius) * std::cos(theta),
                     slope = std::sin(radius) * std::sin(theta);
        const double half = slope > 0   ? std::acos(std::clamp(-level / slope, -1.0, 1.0))
                            : level > 0 ? kPi
                                        : 0;
        // Points of one ring stand between those of the next, since a fine model would fit itself to a pattern.
        const double shift = std::fmod((static_cast<double>(ring) + 0.5) * kRingTurn, 1.0);
        const double azimuth = half * (2 * (static_cast<double>(j) + shift) / kAlbedoAzimuths - 1);
        const Vec3 wo = around_specular(theta, phi, azimuth, radius);
        // The solid angle of a point is sin(radius) dr times its share of the visible azimuths.
        const double area = std::sin(radius) * 2 * most * u / kAlbedoRings * 2 * half / kAlbedoAzimuths;
        const bool counts = wo.z > 0 && source.eval(wi, wo, f);
        set.pairs.push_back({wi, counts ? wo : Vec3{0, 0, 1}});
        set.weights.push_back(static_cast<float>(counts ? area * wo.z : 0));
      }

    // The target is integrated with more points than the model's sums, because measurements are noisy.
    const std::vector<double> albedo = directional_albedo(source, wi, kAlbedoPrecision).albedo;
    const double mean =
        std::accumulate(albedo.begin(), albedo.end(), 0.0) / static_cast<double>(albedo.size());
    for (const double a : albedo) {
      set.targets.push_back(static_cast<float>(std::max(a, 0.0)));
      set.scales.push_back(static_cast<float>(std::max({a, mean, kMinAlbedo})));
    }
  }
  return set;
}

TrainingSet training_set_of(const Samples& samples, bool symmetrize) {
  TrainingSet set{.channels = samples.channels, .isotropic = samples.isotropic};
  for (int turn = 0; turn < (symmetrize ? 2 : 1); ++turn)
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto [wi, wo] = samples.pairs[i];
      if (wi.z <= 0 || wo.z <= 0) continue;
      set.pairs.push_back(turn == 0 ? DirectionPair{wi, wo} : DirectionPair{wo, wi});
      for (const double f : samples.at(i)) set.values.push_back(static_cast<float>(std::max(f, 0.0)));
    }
  set.weights.assign(set.pairs.size(), 1);
  if (set.size() == 0) throw Error("fit: expected samples above the horizon, found none");
  return set;
}

TrainingSet taken(const TrainingSet& set, std::span<const std::size_t> order) {
  TrainingSet part{
      .channels = set.channels, .isotropic = set.isotropic, .exposure = set.exposure, .albedo = set.albedo};
  const std::size_t channels = set.channels,
                    lobes = set.lobe_weights.size() / std::max<std::size_t>(set.size(), 1);
  for (const std::size_t i : order) {
    part.picture_count += i < set.picture_count;
    part.pairs.push_back(set.pairs[i]);
    part.weights.push_back(set.weights[i]);
    for (std::size_t c = 0; c < channels; ++c) part.values.push_back(set.values[i * channels + c]);
    for (std::size_t j = 0; j < lobes; ++j) part.lobe_weights.push_back(set.lobe_weights[i * lobes + j]);
  }
  return part;
}

TrainingSet thinned(const TrainingSet& set, std::size_t step) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < set.picture_count; i += step) kept.push_back(i);
  for (std::size_t i = set.picture_count; i < set.size(); i += step) kept.push_back(i);
  return taken(set, kept);
}

SampleSource as_source(const TrainingSet& set, const std::vector<float>& values) {
  return {
      .count = set.size(),
      .distinct = set.size(),
      .channels = set.channels,
      .isotropic = set.isotropic,
      .fill = [&set, &values](std::size_t begin, std::span<DirectionPair> pairs, std::span<double> f,
                              std::span<double> weights) {
        std::copy_n(set.pairs.begin() + static_cast<std::ptrdiff_t>(begin), pairs.size(), pairs.begin());
        std::copy_n(set.weights.begin() + static_cast<std::ptrdiff_t>(begin), pairs.size(), weights.begin());
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(begin * set.channels), f.size(), f.begin());
      }};
}

}  // namespace burnish
