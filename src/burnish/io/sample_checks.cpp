// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include <burnish/io/sample_checks.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/leave_one_out.h>

namespace burnish {

namespace {

constexpr std::size_t kFewSamples = 8;       // incidences of fewer samples say nothing
constexpr double kSideCosine = 0.7;          // of the azimuth from wi, or from its opposite
constexpr double kNear = radians(15);        // of theta_o to theta_i: a peak nearer is a mirror's
constexpr double kLeastTheta = radians(10);  // of wi: below it the two sides are close together
constexpr double kMostTheta = radians(80);

/// Numbers of incidences with the largest value on the light's own side, and on the opposite side.
struct SideVotes {
  std::size_t own = 0, other = 0;
};

double brightness(const Samples& samples, std::size_t i) noexcept {
  const auto f = samples.at(i);
  return std::accumulate(f.begin(), f.end(), 0.0);
}

/// The largest value on one side of an incidence.
struct Side {
  double largest = -std::numeric_limits<double>::infinity();
  double theta = 0;  // theta_o of the largest value
  bool seen = false;
};

/// Counts the incidences that each side wins. A side wins if its largest value lies near theta_i and exceeds
/// `factor` times the other side's.
SideVotes side_votes(const Samples& samples, double factor) {
  // Samples of one incidence are sorted together.
  const auto key = [&](std::size_t i) {
    const Vec3 wi = samples.pairs[i].wi;
    return std::array{std::round(wi.x * 1e6), std::round(wi.y * 1e6)};
  };
  std::vector<std::size_t> order(samples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });

  SideVotes votes;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    const auto same = key(order[begin]);
    while (end < order.size() && key(order[end]) == same) ++end;
    const Vec3 wi = samples.pairs[order[begin]].wi;
    const double theta_i = theta_of(wi);
    if (end - begin < kFewSamples || theta_i < kLeastTheta || theta_i > kMostTheta) continue;
    Side own, other;
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t k = begin; k < end; ++k) {
      const Vec3 wo = samples.pairs[order[k]].wo;
      const double across = std::hypot(wo.x, wo.y), f = brightness(samples, order[k]);
      smallest = std::min(smallest, f);
      if (across < std::sin(radians(5))) continue;
      const double cosine = (wi.x * wo.x + wi.y * wo.y) / (across * std::hypot(wi.x, wi.y));
      Side* const side = cosine > kSideCosine ? &own : cosine < -kSideCosine ? &other : nullptr;
      if (!side) continue;
      side->seen = true;
      if (f > side->largest) side->largest = f, side->theta = theta_of(wo);
    }
    // A side that was not measured counts as the darkest value of the incidence.
    const auto beats = [&](const Side& a, const Side& b) {
      const double least = b.seen ? std::max(b.largest, smallest) : smallest;
      return a.seen && std::abs(a.theta - theta_i) < kNear && a.largest > 0 && a.largest > factor * least;
    };
    votes.own += beats(own, other);
    votes.other += beats(other, own);
  }
  return votes;
}

}  // namespace

void check_azimuths(const Samples& samples, Findings& findings) {
  constexpr double kFactor = 2;
  const SideVotes votes = side_votes(samples, kFactor);
  if (votes.own > 2 * votes.other)
    findings.warnings.push_back(
        "The largest values lie at phi_o = phi_i, where light goes back; the mirror direction is at phi_i + "
        "180 "
        "degrees. Does the file count azimuths otherwise?");
}

std::string settle_isotropy(Samples& samples) {
  const IsotropyErrors errors = isotropy_errors(samples);
  if (!(errors.anisotropic > 0)) {
    samples.isotropic = false;
    return "Taken as anisotropic: phi_i varies, and samples are too few to tell.";
  }
  samples.isotropic = errors.isotropic <= errors.anisotropic;
  return fmt::format(
      "Taken as {}: the other samples predict ln f of a sample to {:.3f} if isotropic, to {:.3f} if "
      "anisotropic.",
      samples.isotropic ? "isotropic" : "anisotropic", errors.isotropic, errors.anisotropic);
}

std::string settle_plane(Samples& samples) {
  constexpr double kFactor = 1.5;
  const SideVotes votes = side_votes(samples, kFactor);
  if (votes.own <= votes.other)
    return "In the plane of incidence; the mirror direction is at theta_o = -theta_i.";
  for (DirectionPair& pair : samples.pairs) pair.wo = {-pair.wo.x, -pair.wo.y, pair.wo.z};
  return "In the plane of incidence; the mirror direction is at theta_o = theta_i, where the largest values "
         "lie.";
}

}  // namespace burnish
