// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/node_figures.h>
#include <burnish/reflectance/outliers.h>
#include <burnish/reflectance/scattered_brdf.h>

namespace burnish {

namespace {

constexpr double kCornellCount = 1439;
constexpr double kCornellRadius2 = 0.001;  // [Pharr 2010]
constexpr double kMinRadius2 = 1e-9;       // samples this near are at one place
constexpr double kNearNormal = 1e-12;      // theta_h below this is rounding
constexpr double kSharpness = 100;         // [Pharr 2010]
constexpr std::size_t kEnough = 3;         // [Pharr 2010]
constexpr std::size_t kMaxAveraged = 64;   // largest number averaged where a scan is denser than elsewhere
constexpr double kSamePlace2 =
    2e-6;  // largest squared distance between places of one measurement, as sqrt(theta_h) is steep at 0

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

/// The kriged function, made once by the first call.
struct ScatteredBrdf::Kriging {
  std::once_flag made;
  std::optional<KrigedNodes> function;
};

ScatteredBrdf::ScatteredBrdf(const Samples& samples, std::span<const std::size_t> subset, SampleRule rule)
    : ScatteredBrdf(select(samples, subset), rule) {}

ScatteredBrdf::ScatteredBrdf(Samples samples, SampleRule rule) : rule_(rule), samples_(std::move(samples)) {
  const std::size_t count = samples_.size();
  if (count == 0) throw Error("scattered samples: expected at least one, found none");
  if (samples_.channels < 1 || samples_.values.size() != count * samples_.channels)
    throw Error("scattered samples: expected as many values as pairs times channels");
  if (rule_ == SampleRule::mean_in_angles && !samples_.isotropic)
    throw Error("scattered samples: the space of angles is for isotropic ones");
  const double dimensions = samples_.isotropic ? 3 : 4;
  initial_radius2_ =
      kCornellRadius2 * std::min(1.0, std::pow(kCornellCount / static_cast<double>(count), 2 / dimensions));

  // Points and samples are in the order of the tree.
  std::vector<TreePoint> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = place(samples_.pairs[i].wi, samples_.pairs[i].wo);
  tree_ = KdTree(points);
  samples_ = select(samples_, tree_.order());
  if (rule_ == SampleRule::kriged) kriging_ = std::make_shared<Kriging>();
}

TreePoint ScatteredBrdf::place(Vec3 wi, Vec3 wo) const noexcept {
  if (rule_ == SampleRule::mean_in_angles) {
    // pbrt-v2's coordinates: (sin theta_i sin theta_o, |phi_i - phi_o| / pi, cos theta_i cos theta_o) [Pharr 2010].
    const double turn = std::abs(std::remainder(phi_of(wi) - phi_of(wo), kTwoPi));
    return on_grid({std::hypot(wi.x, wi.y) * std::hypot(wo.x, wo.y), turn / kPi, wi.z * wo.z, 0});
  }
  // The third coordinate is sin theta_h sin theta_d |cos phi_d|, since cos theta_i - cos theta_o = -2 sin theta_h sin
  // theta_d cos phi_d.
  // The square root would make rounding at the normal large.
  const auto root = [](double theta_h) { return theta_h < kNearNormal ? 0 : std::sqrt(theta_h / kHalfPi); };
  if (samples_.isotropic)
    return on_grid(
        {root(theta_of(half_vector(wi, wo))), angle_between(wi, wo) / kPi, 0.5 * std::abs(wi.z - wo.z), 0});
  const HalfDiff angles = to_half_diff(wi, wo);
  const double half = root(angles.theta_h), difference = angles.theta_d / kPi;
  // At theta_h = 0 only the sum of the azimuths is defined.
  const double turn = angles.phi_h + angles.phi_d;
  return on_grid({half * std::cos(angles.phi_h), half * std::sin(angles.phi_h), difference * std::cos(turn),
                  difference * std::sin(turn)});
}

bool ScatteredBrdf::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  const bool known = eval_raw(wi, wo, f);
  cut_negatives(f);
  return known;
}

const KrigedNodes* ScatteredBrdf::kriged() const noexcept {
  if (!kriging_) return nullptr;
  std::call_once(kriging_->made, [&] {
    // Isolated: a thread that waits inside would take up outer work, which may ask for this very function.
    run_isolated([&] {
      const bool any = std::ranges::any_of(samples_.pairs, [](const DirectionPair& pair) {
        return std::min(pair.wi.z, pair.wo.z) > KrigedNodes::kLeastCosine;
      });
      if (!any) return;
      const MeasuredNodes nodes = without_outliers(measured_nodes(samples_));
      kriging_->function.emplace(nodes, choose_covariance(nodes));
    });
  });
  return kriging_->function ? &*kriging_->function : nullptr;
}

bool ScatteredBrdf::eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  std::fill(f.begin(), f.end(), 0.0);
  if (wi.z <= 0 || wo.z <= 0) return true;
  if (rule_ != SampleRule::kriged) return mean_of_neighbours(place(wi, wo), f);
  if (mean_at(wi, wo, f)) return true;
  if (!covers(wi, wo)) return false;
  const KrigedNodes* const function = kriged();
  return function && function->eval(wi, wo, f);
}

/// Sets f to the mean of the samples that were measured at these directions, exchanged or not. Returns false, and f
/// is 0, where there are none.
bool ScatteredBrdf::mean_at(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  std::size_t found = 0;
  const auto add_about = [&](const TreePoint& centre, const auto& takes) {
    tree_.visit_ball(centre, kSamePlace2, [&](std::size_t i, double) noexcept {
      if (!takes(i) || !are_one_measurement({wi, wo}, samples_.pairs[i], samples_.isotropic)) return;
      const auto values = samples_.at(i);
      for (std::size_t c = 0; c < f.size(); ++c) f[c] += values[c];
      ++found;
    });
  };
  const TreePoint centre = place(wi, wo);
  add_about(centre, [](std::size_t) { return true; });
  // Exchanged directions have a place of their own where the source is anisotropic.
  if (!samples_.isotropic)
    add_about(place(wo, wi),
              [&](std::size_t i) { return distance2(tree_.points()[i], centre) > kSamePlace2; });
  for (double& value : f) value /= found > 0 ? static_cast<double>(found) : 1;
  return found > 0;
}

/// Returns true if three samples lie near the pair or, for an anisotropic source, near the exchanged one.
bool ScatteredBrdf::covers(Vec3 wi, Vec3 wo) const noexcept {
  const auto has_near = [&](const TreePoint& centre) {
    std::array<KdTree::Neighbour, kEnough> nearest;
    const std::size_t enough = std::min(kEnough, tree_.size());
    const std::size_t found =
        tree_.nearest(centre, std::span(nearest).first(enough), [](std::size_t) { return true; });
    return std::all_of(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(found),
                       [](const KdTree::Neighbour& near) { return near.distance2 <= kMaxRadius2; });
  };
  return has_near(place(wi, wo)) || (!samples_.isotropic && has_near(place(wo, wi)));
}

bool ScatteredBrdf::mean_of_neighbours(const TreePoint& centre, std::span<double> f) const noexcept {
  // Averages the samples in a ball with weights exp(-100 distance^2), and returns their number.
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
  // The ball grows until it holds enough samples, then shrinks while it holds more than needed.
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
