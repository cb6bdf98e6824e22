// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/render/light/lobe_parts.h>
#include <burnish/render/light/tapped_light.h>

namespace burnish {
namespace {

// A direction of a grid over the hemisphere, which crowds at the normal.
struct LobeCell {
  Vec3 direction;
  double area, value, mass;
};

bool has_half_vectors(const Lobe& lobe) noexcept {
  return std::ranges::any_of(lobe.factors, [](const FactorUse& use) {
    const Projection& p = use.projection;
    return p.kind != Projection::Kind::affine || (p.wi != 0 && p.wo != 0) || p.mirror != 0;
  });
}

std::vector<LobeCell> cells_of(const FactoredBrdf& inside, bool of_half) {
  constexpr int kCellRings = 96, kCellSpokes = 96;
  // mass is a power below 1 of what is reflected: wide parts of a lobe send light too
  constexpr double kPower = 0.85;
  std::vector<LobeCell> cells;
  const auto angle = [](double ring) { return 0.5 * kPi * (ring / kCellRings) * (ring / kCellRings); };
  for (int ring = 0; ring < kCellRings; ++ring)
    for (int spoke = 0; spoke < kCellSpokes; ++spoke) {
      const double theta = angle(ring + 0.5), phi = kTwoPi * (spoke + 0.5 * (ring % 2)) / kCellSpokes;
      const double area = kTwoPi / kCellSpokes * (std::cos(angle(ring)) - std::cos(angle(ring + 1)));
      const Vec3 w{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
      double value = 1;
      if (of_half) {
        const Channels f = eval_channels(inside, w, w);
        value = f[0] + f[1] + f[2];
      }
      cells.push_back({w, area, value, std::pow(value * w.z, kPower) * area});
    }
  return cells;
}

// The part of a lobe that is nearest to one middle.
struct LobePart {
  Vec3 sum;
  double light = 0, spread = 0;   // reflected; times the squared distance
  double closest = 8, value = 0;  // of the cell closest to the middle
};

// Standard deviations of a part that its tap's blur has: less, and the sum of blurs has ripples.
constexpr double kOverlap = 1.5;

double square_distance(Vec3 a, Vec3 b) {
  return dot(a - b, a - b);
}

// Far apart: each drawn by its mass times the squared distance from those before it [Arthur 2007].
std::vector<Vec3> seeds_of(const std::vector<LobeCell>& cells, std::size_t count) {
  Pcg32 random(1);
  std::vector<Vec3> middles;
  std::vector<double> nearest(cells.size(), 4);
  while (middles.size() < count) {
    double sum = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) sum += cells[i].mass * nearest[i];
    double left = random.uniform() * sum;
    std::size_t chosen = 0;
    while (chosen + 1 < cells.size() && (left -= cells[chosen].mass * nearest[chosen]) > 0) ++chosen;
    middles.push_back(cells[chosen].direction);
    for (std::size_t i = 0; i < cells.size(); ++i)
      nearest[i] = std::min(nearest[i], square_distance(cells[i].direction, middles.back()));
  }
  return middles;
}

// Every cell to its nearest middle.
std::vector<LobePart> parts_around(const std::vector<Vec3>& middles, const std::vector<LobeCell>& cells) {
  std::vector<LobePart> parts(middles.size());
  for (const LobeCell& cell : cells) {
    std::size_t best = 0;
    double distance = 8;
    for (std::size_t k = 0; k < middles.size(); ++k)
      if (const double d = square_distance(cell.direction, middles[k]); d < distance) {
        distance = d;
        best = k;
      }
    LobePart& part = parts[best];
    const double light = cell.value * cell.area;
    part.sum = part.sum + cell.mass * cell.direction;
    part.light += light;
    part.spread += light * distance;
    if (distance < part.closest) {
      part.closest = distance;
      part.value = cell.value;
    }
  }
  return parts;
}

// Rounds in which every middle goes to its part's mean. A tap stands for its part's light with the value in its middle.
std::vector<LightTap> clusters(const std::vector<LobeCell>& cells, std::size_t count) {
  constexpr int kRounds = 30;
  std::vector<Vec3> middles = seeds_of(cells, count);
  std::vector<LightTap> taps(count);
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<LobePart> parts = parts_around(middles, cells);
    for (std::size_t k = 0; k < count; ++k) {
      const LobePart& part = parts[k];
      if (!(part.light > 0) || !(part.value > 0)) continue;
      taps[k] = {middles[k], part.light / part.value, kOverlap * std::sqrt(0.5 * part.spread / part.light)};
      middles[k] = normalize(part.sum);
    }
  }
  std::erase_if(taps, [](const LightTap& t) { return !(t.area > 0); });
  return taps;
}

// Areas that make the sum of the taps' blurs the lobe, by least squares: sharper than the parts' own areas,
// which blur the lobe once more. Some are negative.
void sharpen(std::vector<LightTap>& taps, const std::vector<LobeCell>& cells) {
  // normal equations over the grid: how blurs overlap, and what of the lobe each covers
  constexpr double kDark = 0.2;  // of the largest value: where errors begin to weigh less
  const auto count = static_cast<Eigen::Index>(taps.size());
  const double most = std::ranges::max(cells, {}, &LobeCell::value).value;
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(count), blurs(count);
  std::vector<double> closest(taps.size(), 8), values(taps.size());
  for (const LobeCell& cell : cells) {
    const double relative = cell.value / most, weight = cell.area / ((relative + kDark) * (relative + kDark));
    for (Eigen::Index j = 0; j < count; ++j) {
      const auto k = static_cast<std::size_t>(j);
      const double cosine = dot(taps[k].direction, cell.direction);
      blurs[j] = blur_weight(cosine, taps[k].width);
      if (1 - cosine < closest[k]) {
        closest[k] = 1 - cosine;
        values[k] = relative;
      }
    }
    products.selfadjointView<Eigen::Lower>().rankUpdate(blurs, weight);
    sums += weight * relative * blurs;
  }
  products.diagonal() *= 1 + 1e-6;
  const Eigen::VectorXd light = products.selfadjointView<Eigen::Lower>().ldlt().solve(sums);

  // what leaks below the horizon is made up for at its rim: keep the sum over cosines
  double whole = 0, found = 0;
  for (const LobeCell& cell : cells) whole += cell.area * cell.value / most * cell.direction.z;
  for (std::size_t k = 0; k < taps.size(); ++k)
    found += light[static_cast<Eigen::Index>(k)] * taps[k].direction.z;
  for (std::size_t k = 0; k < taps.size(); ++k)
    taps[k].area = values[k] > 0 ? whole / found * light[static_cast<Eigen::Index>(k)] / values[k] : 0;
}

}  // namespace

TappedBrdf tap(const FactoredBrdf& brdf, int taps) {
  if (taps < 1 || taps > 256)
    throw Error(fmt::format("tapped light: expected taps in [1, 256], found {}", taps));
  if (brdf.channels() != 1 && brdf.channels() != 3)
    throw Error(fmt::format("tapped light: expected 1 or 3 channels, found {}", brdf.channels()));
  TappedBrdf result;
  for (const Lobe& lobe : brdf.lobes()) {
    auto [outside, inside] = parts_of(brdf, lobe);
    const bool of_half = has_half_vectors(lobe);
    const std::vector<LobeCell> cells = cells_of(inside, of_half);
    std::vector<LightTap> found = clusters(cells, static_cast<std::size_t>(taps));
    sharpen(found, cells);
    result.lobes.push_back({std::move(outside), std::move(inside), of_half, std::move(found)});
  }
  return result;
}

int TappedBrdf::fetches() const noexcept {
  int count = 0;
  for (const TappedLobe& lobe : lobes)
    count += static_cast<int>(lobe.outside.lobes()[0].factors.size() +
                              lobe.taps.size() * (1 + lobe.inside.lobes()[0].factors.size()));
  return count;
}

Rgb TappedBrdf::radiance(const BlurredEnvironment& environment, const LightFrame& frame,
                         Vec3 v) const noexcept {
  const Vec3 wo = frame.local(v);
  Rgb sum;
  if (wo.z <= 0) return sum;
  for (const TappedLobe& lobe : lobes) {
    Rgb light;
    for (const LightTap& tap : lobe.taps) {
      // a tap at a half vector reflects the view there; dwi = 4 dot(wo, h) dh, widths go with the root
      Vec3 wi = tap.direction;
      double area = tap.area, width = tap.width;
      if (lobe.of_half) {
        const double along = dot(wo, wi);
        if (along <= 0) continue;
        wi = 2 * along * wi - wo;
        area *= 4 * along;
        width *= 2 * std::sqrt(along);
      }
      if (wi.z <= 0) continue;
      const Channels f = eval_channels(lobe.inside, wi, wo);
      light = light + Rgb(area * wi.z) * Rgb(f[0], f[1], f[2]) * environment.radiance(frame.world(wi), width);
    }
    const Channels f = eval_channels(lobe.outside, wo, wo);
    sum = sum + Rgb(f[0], f[1], f[2]) * light;
  }
  return sum;
}

}  // namespace burnish
