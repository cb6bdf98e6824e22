#include <algorithm>
#include <cmath>
#include <utility>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/scattered_brdf.h>

namespace burnish {

namespace {

constexpr double kCornellCount = 1439;
constexpr double kCornellRadius2 = 0.001;  // [Pharr 2010]
constexpr double kMinRadius2 = 1e-9;       // samples that are this near are at one place
constexpr double kSharpness = 100;         // [Pharr 2010]
constexpr std::size_t kEnough = 3;         // [Pharr 2010]
constexpr std::size_t kMaxAveraged = 64;   // that are averaged, where a scan is denser than elsewhere

}  // namespace

Samples select(const Samples& samples, std::span<const std::size_t> subset) {
  Samples part{samples.channels, samples.isotropic, {}, {}};
  part.pairs.reserve(subset.size());
  part.values.reserve(subset.size() * samples.channels);
  for (const std::size_t i : subset) {
    part.pairs.push_back(samples.pairs[i]);
    const auto values = samples.at(i);
    part.values.insert(part.values.end(), values.begin(), values.end());
  }
  return part;
}

ScatteredBrdf::ScatteredBrdf(const Samples& samples, std::span<const std::size_t> subset, SampleSpace space)
    : ScatteredBrdf(select(samples, subset), space) {}

ScatteredBrdf::ScatteredBrdf(Samples samples, SampleSpace space)
    : space_(space), samples_(std::move(samples)) {
  const std::size_t count = samples_.size();
  if (count == 0) throw Error("scattered samples: expected at least one, found none");
  if (samples_.channels < 1 || samples_.values.size() != count * samples_.channels)
    throw Error("scattered samples: expected as many values as pairs times channels");
  if (space_ == SampleSpace::angles && !samples_.isotropic)
    throw Error("scattered samples: the space of angles is for isotropic ones");
  const double dimensions = samples_.isotropic ? 3 : 4;
  initial_radius2_ =
      kCornellRadius2 * std::min(1.0, std::pow(kCornellCount / static_cast<double>(count), 2 / dimensions));

  // points and samples in the order of the tree
  std::vector<TreePoint> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = place(samples_.pairs[i].wi, samples_.pairs[i].wo);
  tree_ = KdTree(points);
  samples_ = select(samples_, tree_.order());
}

TreePoint ScatteredBrdf::place(Vec3 wi, Vec3 wo) const noexcept {
  if (space_ == SampleSpace::angles) {
    const double turn = std::abs(std::remainder(phi_of(wi) - phi_of(wo), kTwoPi));
    return {std::hypot(wi.x, wi.y) * std::hypot(wo.x, wo.y), turn / kPi, wi.z * wo.z, 0};
  }
  // cos theta_i - cos theta_o = -2 sin theta_h sin theta_d cos phi_d
  if (samples_.isotropic)
    return {std::sqrt(theta_of(half_vector(wi, wo)) / kHalfPi), angle_between(wi, wo) / kPi,
            0.5 * std::abs(wi.z - wo.z), 0};
  const HalfDiff angles = to_half_diff(wi, wo);
  const double half = std::sqrt(angles.theta_h / kHalfPi), difference = angles.theta_d / kPi;
  // at theta_h = 0 only the sum of the azimuths is defined.
  const double turn = angles.phi_h + angles.phi_d;
  return {half * std::cos(angles.phi_h), half * std::sin(angles.phi_h), difference * std::cos(turn),
          difference * std::sin(turn)};
}

bool ScatteredBrdf::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  const bool known = eval_raw(wi, wo, f);
  cut_negatives(f);
  return known;
}

bool ScatteredBrdf::eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  std::fill(f.begin(), f.end(), 0.0);
  if (wi.z <= 0 || wo.z <= 0) return true;

  const TreePoint centre = place(wi, wo);
  const auto add_ball = [&](double radius2) noexcept {
    std::size_t found = 0;
    double total = 0;
    std::fill(f.begin(), f.end(), 0.0);
    tree_.visit_ball(centre, radius2, [&](std::size_t i, double d2) noexcept {
      const double weight = std::exp(-kSharpness * d2);
      const auto values = samples_.at(i);
      for (std::size_t c = 0; c < f.size(); ++c) f[c] += weight * values[c];
      total += weight;
      ++found;
    });
    for (double& value : f) value /= found > 0 ? total : 1;
    return found;
  };
  // larger balls until one holds enough samples; smaller ones as long as they hold more than serves
  const std::size_t enough = std::min(kEnough, tree_.size());
  for (double radius2 = initial_radius2_; radius2 <= kMaxRadius2; radius2 *= 2) {
    std::size_t found = add_ball(radius2);
    if (found < enough) continue;
    while (found > kMaxAveraged && radius2 > kMinRadius2) {
      radius2 /= 2;
      found = add_ball(radius2);
      if (found == 0) add_ball(2 * radius2);
    }
    return true;
  }
  std::fill(f.begin(), f.end(), 0.0);
  return false;
}

}  // namespace burnish
