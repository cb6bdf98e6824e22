#include <algorithm>
#include <cmath>
#include <numeric>
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
constexpr std::size_t kLeaf = 8;           // ranges this short are searched one by one

double distance2(const std::array<double, 4>& a, const std::array<double, 4>& b) noexcept {
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

/// Calls visit(index, distance2) for every point within the ball.
template <class Visit>
void visit_ball(std::span<const std::array<double, 4>> points, std::span<const std::uint8_t> axes,
                std::size_t begin, std::size_t end, const std::array<double, 4>& centre, double radius2,
                const Visit& visit) noexcept {
  while (end - begin > kLeaf) {
    const std::size_t middle = begin + (end - begin) / 2;
    // the pivot itself, then the far side of its plane if the ball reaches it
    const double d2 = distance2(points[middle], centre);
    if (d2 <= radius2) visit(middle, d2);
    const double across = centre[axes[middle]] - points[middle][axes[middle]];
    const bool both = across * across <= radius2;
    if (both)
      visit_ball(points, axes, across < 0 ? middle + 1 : begin, across < 0 ? end : middle, centre, radius2,
                 visit);
    // the centre's side goes on
    if (across < 0)
      end = middle;
    else
      begin = middle + 1;
  }
  for (std::size_t i = begin; i < end; ++i) {
    const double d2 = distance2(points[i], centre);
    if (d2 <= radius2) visit(i, d2);
  }
}

/// Orders the indices [begin, end) as a balanced k-d tree: the middle one splits along the longest axis. The order is
/// the same for every standard library: what is alike stays in the samples' order.
void sort_into_tree(std::span<const std::array<double, 4>> points, std::span<std::size_t> order,
                    std::span<std::uint8_t> axes, std::size_t begin, std::size_t end) {
  const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
  if (end - begin <= kLeaf) {
    std::sort(at(begin), at(end));
    return;
  }
  // the longest axis of the range's box
  std::array<double, 4> low = points[order[begin]], high = low;
  for (std::size_t i = begin; i < end; ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      low[k] = std::min(low[k], points[order[i]][k]);
      high[k] = std::max(high[k], points[order[i]][k]);
    }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 4; ++k)
    if (high[k] - low[k] > high[axis] - low[axis]) axis = k;

  // the pivot in the middle, what is below it in front
  const std::size_t middle = begin + (end - begin) / 2;
  std::nth_element(at(begin), at(middle), at(end), [&](std::size_t a, std::size_t b) {
    return std::pair(points[a][axis], a) < std::pair(points[b][axis], b);
  });
  axes[middle] = static_cast<std::uint8_t>(axis);
  sort_into_tree(points, order, axes, begin, middle);
  sort_into_tree(points, order, axes, middle + 1, end);
}

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
  std::vector<Point> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = place(samples_.pairs[i].wi, samples_.pairs[i].wo);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  axes_.assign(count, 0);
  sort_into_tree(points, order, axes_, 0, count);
  points_.reserve(count);
  for (const std::size_t i : order) points_.push_back(points[i]);
  samples_ = select(samples_, order);
}

ScatteredBrdf::Point ScatteredBrdf::place(Vec3 wi, Vec3 wo) const noexcept {
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

  const Point centre = place(wi, wo);
  const auto add_ball = [&](double radius2) noexcept {
    std::size_t found = 0;
    double total = 0;
    std::fill(f.begin(), f.end(), 0.0);
    visit_ball(points_, axes_, 0, points_.size(), centre, radius2, [&](std::size_t i, double d2) noexcept {
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
  const std::size_t enough = std::min(kEnough, points_.size());
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
