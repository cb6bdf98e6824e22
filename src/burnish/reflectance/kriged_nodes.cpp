#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/kriged_nodes.h>

namespace burnish {

namespace {

constexpr double kMinNodeCosine = 0.02, kFullCosine = 0.15;
constexpr double kUpright = 1e-12;    // theta_h of rounding
constexpr double kGuessWeight = 0.1;  // of what stands where nothing was measured

constexpr std::size_t kNeighbours = KrigedNodes::kNeighbours;

// Blocks of nodes whose likelihood is looked at.
constexpr std::size_t kNearBlocks = 24, kNearNodes = 64;
constexpr std::size_t kFewNearBlocks = 6, kSpreadNodes = 192;
constexpr TreePoint kNear{3, 1, 0.5, 0}, kNearAnisotropic{1.5, 1.5, 1, 1};

// Cells along theta_h, theta_d and phi_d; nodes leave a gap where they touch none of a cell's corners.
constexpr std::array<std::size_t, 3> kCells{48, 12, 6};

double least_cosine(const DirectionPair& pair) noexcept {
  return std::min(pair.wi.z, pair.wo.z);
}

struct Logarithms {
  LogMeasurements measured;
  std::vector<std::uint32_t> node;
  std::vector<double> mean, largest;  // [channel]
};

Logarithms logarithms_of(const MeasuredNodes& nodes) {
  const std::size_t channels = nodes.samples.channels;
  Logarithms result;
  result.measured.channels = channels;
  result.mean.assign(channels, 0);
  result.largest.assign(channels, 0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const DirectionPair& pair = nodes.samples.pairs[i];
    if (!(least_cosine(pair) > kMinNodeCosine)) continue;
    result.node.push_back(static_cast<std::uint32_t>(i));
    result.measured.places.push_back(place_of(pair.wi, pair.wo, nodes.samples.isotropic));
    result.measured.variances.push_back(1 /
                                        (nodes.weights[i] * std::min(1.0, least_cosine(pair) / kFullCosine)));
    for (std::size_t c = 0; c < channels; ++c) {
      const double f = std::max(0.0, nodes.samples.at(i)[c]);
      result.largest[c] = std::max(result.largest[c], f);
      result.measured.logs.push_back(std::log(f + KrigedNodes::kFloor));
      result.mean[c] += result.measured.logs.back();
    }
  }
  const std::size_t count = result.measured.size();
  if (count == 0) throw Error("nodes: expected some that are not within a degree of the horizon, found none");
  for (double& mean : result.mean) mean /= static_cast<double>(count);
  for (std::size_t i = 0; i < count * channels; ++i) result.measured.logs[i] -= result.mean[i % channels];
  return result;
}

/// Indices of `count` of `size` things in an order as if by chance.
std::vector<std::size_t> drawn(std::size_t count, std::size_t size, std::uint64_t seed) {
  std::vector<std::size_t> order(size);
  std::iota(order.begin(), order.end(), std::size_t{0});
  Pcg32 random(seed);
  count = std::min(count, size);
  for (std::size_t i = 0; i < count; ++i)
    std::swap(order[i],
              order[i + static_cast<std::size_t>(random.uniform() * static_cast<double>(size - i))]);
  order.resize(count);
  return order;
}

/// The corners of cells around a place in the coordinates (sqrt(tan(theta_h/2)), tan(theta_d/2), tan(phi_d/2)).
std::array<std::size_t, 8> corners_of(Vec3 wi, Vec3 wo) noexcept {
  const HalfDiff angles = to_half_diff(wi, wo);
  const double phi_d = angles.theta_h < kUpright ? 0 : std::abs(std::remainder(angles.phi_d, kPi));
  const std::array<double, 3> at{std::sqrt(std::tan(angles.theta_h / 2)), std::tan(angles.theta_d / 2),
                                 std::tan(phi_d / 2)};
  std::array<std::size_t, 8> corners{};
  for (std::size_t corner = 0; corner < 8; ++corner)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto last = static_cast<double>(kCells[k] - 1);
      const auto low = std::min(static_cast<std::size_t>(std::clamp(at[k], 0.0, 1.0) * last), kCells[k] - 2);
      corners[corner] = corners[corner] * kCells[k] + low + (corner >> k & 1);
    }
  return corners;
}

/// The directions of a corner of cells.
DirectionPair directions_of(std::size_t corner) noexcept {
  const auto part = [](std::size_t index, std::size_t axis) {
    return static_cast<double>(index) / static_cast<double>(kCells[axis] - 1);
  };
  const double half = part(corner / (kCells[1] * kCells[2]), 0);
  const auto [wi, wo] = from_half_diff({.theta_h = 2 * std::atan(half * half),
                                        .theta_d = 2 * std::atan(part(corner / kCells[2] % kCells[1], 1)),
                                        .phi_d = 2 * std::atan(part(corner % kCells[2], 2))});
  return {wi, wo};
}

}  // namespace

TreePoint place_of(Vec3 wi, Vec3 wo, bool isotropic) noexcept {
  const HalfDiff angles = to_half_diff(wi, wo);
  const double half = std::sqrt(std::tan(angles.theta_h / 2)), difference = std::tan(angles.theta_d / 2);
  if (isotropic) {
    // phi_d folded by exchange and reflection; where h is the normal no direction stands out
    const double phi_d = angles.theta_h < kUpright ? 0 : std::abs(std::remainder(angles.phi_d, kPi));
    return {half, difference, std::sin(angles.theta_d) * phi_d / kHalfPi, 0};
  }
  // where h is the normal only the sum of the azimuths is defined
  const double turn = 2 * (angles.phi_h + angles.phi_d);
  return {half * std::cos(angles.phi_h), half * std::sin(angles.phi_h), difference * std::cos(turn),
          difference * std::sin(turn)};
}

KrigedNodes::KrigedNodes(const MeasuredNodes& nodes, const LogCovariance& covariance)
    : isotropic_(nodes.samples.isotropic), covariance_(covariance) {
  Logarithms all = logarithms_of(nodes);
  mean_ = std::move(all.mean);
  largest_ = std::move(all.largest);
  std::vector<TreePoint> places;
  places.reserve(all.measured.size());
  for (const TreePoint& place : all.measured.places) places.push_back(scaled(place));
  tree_ = KdTree(places);

  // everything in the tree's order: neighbours are near in memory too
  const std::size_t channels = all.measured.channels;
  measured_.channels = channels;
  for (const std::size_t i : tree_.order()) {
    node_.push_back(all.node[i]);
    measured_.places.push_back(all.measured.places[i]);
    measured_.variances.push_back(all.measured.variances[i] * covariance.noise * covariance.noise);
    for (std::size_t c = 0; c < channels; ++c) measured_.logs.push_back(all.measured.logs[i * channels + c]);
  }
}

TreePoint KrigedNodes::scaled(TreePoint place) const noexcept {
  for (std::size_t k = 0; k < place.size(); ++k) place[k] *= covariance_.inverse_length.back()[k];
  return place;
}

/// The neighbours of a place, what each weighs, and the variance of what they predict together.
struct KrigedNodes::Prediction {
  std::size_t count = 0;
  std::array<std::size_t, kNeighbours> places;
  std::array<double, kNeighbours> weights;
  double variance = 0;
};

template <class Takes>
KrigedNodes::Prediction KrigedNodes::predict(const TreePoint& place, const Takes& takes) const noexcept {
  // The nearest nodes, in one order whatever the tree's walk.
  std::array<KdTree::Neighbour, kNeighbours> found;
  Prediction result;
  result.count = tree_.nearest(scaled(place), found, takes);
  const std::size_t n = result.count;
  for (std::size_t i = 0; i < n; ++i) result.places[i] = found[i].place;
  std::sort(result.places.begin(), result.places.begin() + static_cast<std::ptrdiff_t>(n));

  // Coordinates by axis, the place itself last: row i of the covariances is of node i with those up to it.
  using Floats = Eigen::Array<float, kNeighbours + 1, 1>;
  std::array<Floats, LogCovariance::kAxes> at;
  for (std::size_t k = 0; k < LogCovariance::kAxes; ++k) {
    for (std::size_t i = 0; i < n; ++i)
      at[k][static_cast<Eigen::Index>(i)] = static_cast<float>(measured_.places[result.places[i]][k]);
    at[k][static_cast<Eigen::Index>(n)] = static_cast<float>(place[k]);
  }
  using Square =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kNeighbours, kNeighbours>;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kNeighbours, 1>;
  const auto size = static_cast<Eigen::Index>(n);
  Square matrix(size, size);
  Column towards(size);
  for (Eigen::Index i = 0; i <= size; ++i) {
    const Eigen::Index m = i == size ? size : i + 1;
    Floats row;
    row.head(m).setConstant(static_cast<float>(covariance_.level * covariance_.level));
    for (std::size_t t = 0; t < LogCovariance::kTerms; ++t) {
      Floats r2;
      r2.head(m).setZero();
      for (std::size_t k = 0; k < LogCovariance::kAxes; ++k)
        if (covariance_.inverse_length[t][k] > 0)
          r2.head(m) +=
              ((at[k].head(m) - at[k][i]) * static_cast<float>(covariance_.inverse_length[t][k])).square();
      Floats r;
      r.head(m) = static_cast<float>(LogCovariance::kRoot3) * r2.head(m).sqrt();
      const auto spread2 = static_cast<float>(covariance_.spread[t] * covariance_.spread[t]);
      row.head(m) += spread2 * (1 + r.head(m)) * (-r.head(m)).exp();
    }
    if (i == size) {
      towards = row.head(m).cast<double>().matrix();
      continue;
    }
    matrix.row(i).head(m) = row.head(m).cast<double>().matrix().transpose();
    matrix(i, i) = covariance_.variance() + measured_.variances[result.places[static_cast<std::size_t>(i)]];
  }

  // The weights of the best linear prediction, K^-1 k, and its variance, k(x, x) - k^T K^-1 k.
  const Eigen::LLT<Eigen::Ref<Square>, Eigen::Lower> factor(matrix);
  Column weights = towards;
  if (factor.info() == Eigen::Success)
    factor.solveInPlace(weights);
  else
    weights.setConstant(n > 0 ? 1 / static_cast<double>(n) : 0);
  for (std::size_t i = 0; i < n; ++i) result.weights[i] = weights[static_cast<Eigen::Index>(i)];
  result.variance = std::max(0.0, covariance_.variance() - weights.dot(towards));
  return result;
}

template <class Takes>
void KrigedNodes::eval_of(Vec3 wi, Vec3 wo, const Takes& takes, std::span<double> f) const noexcept {
  std::ranges::fill(f, 0.0);
  if (!(wi.z > 0 && wo.z > 0)) return;
  const Prediction prediction = predict(place_of(wi, wo, isotropic_), takes);
  for (std::size_t c = 0; c < f.size(); ++c) {
    double log = mean_[c];
    for (std::size_t i = 0; i < prediction.count; ++i)
      log += prediction.weights[i] * measured_.logs[prediction.places[i] * f.size() + c];
    f[c] = std::clamp(std::exp(log) - kFloor, 0.0, 2 * largest_[c]);
  }
}

bool KrigedNodes::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  eval_of(
      wi, wo, [](std::size_t) { return true; }, f);
  return true;
}

void KrigedNodes::eval_from(Vec3 wi, Vec3 wo, const std::function<bool(std::size_t node)>& takes,
                            std::span<double> f) const noexcept {
  eval_of(
      wi, wo, [&](std::size_t place) { return takes(node_[place]); }, f);
}

double KrigedNodes::uncertainty(Vec3 wi, Vec3 wo) const noexcept {
  if (!(wi.z > 0 && wo.z > 0)) return 0;
  return std::sqrt(predict(place_of(wi, wo, isotropic_), [](std::size_t) { return true; }).variance);
}

std::vector<LogCovariance> likely_covariances(const MeasuredNodes& nodes) {
  const LogMeasurements measured = logarithms_of(nodes).measured;
  std::vector<TreePoint> places = measured.places;
  const TreePoint& by = nodes.samples.isotropic ? kNear : kNearAnisotropic;
  for (TreePoint& place : places)
    for (std::size_t k = 0; k < place.size(); ++k) place[k] *= by[k];
  const KdTree tree(places);

  // groups of near nodes, about nodes drawn by chance
  std::vector<std::vector<std::size_t>> near;
  for (const std::size_t centre : drawn(kNearBlocks, places.size(), 1)) {
    std::array<KdTree::Neighbour, kNearNodes> found;
    const std::size_t count = tree.nearest(places[centre], found, [](std::size_t) { return true; });
    std::vector<std::size_t>& block = near.emplace_back();
    for (std::size_t i = 0; i < count; ++i) block.push_back(tree.order()[found[i].place]);
    std::ranges::sort(block);
  }
  // some of them, and nodes from everywhere
  std::vector<std::vector<std::size_t>> spread(
      near.begin(), near.begin() + static_cast<std::ptrdiff_t>(std::min(kFewNearBlocks, near.size())));
  spread.push_back(drawn(kSpreadNodes, places.size(), 2));
  return {likeliest_covariance(measured, near, nodes.samples.isotropic),
          likeliest_covariance(measured, spread, nodes.samples.isotropic)};
}

MeasuredNodes with_gaps_filled(const MeasuredNodes& fitted, const MeasuredNodes& all, BrdfRef function) {
  std::vector<std::uint8_t> touched(kCells[0] * kCells[1] * kCells[2]);
  for (const DirectionPair& pair : all.samples.pairs)
    if (least_cosine(pair) > kMinNodeCosine)
      for (const std::size_t corner : corners_of(pair.wi, pair.wo)) touched[corner] = 1;

  MeasuredNodes filled = fitted;
  std::uint32_t group = all.group_count();
  std::vector<double> f(function.channels());
  for (std::size_t i = 0; i < touched.size(); ++i) {
    if (touched[i]) continue;
    const DirectionPair pair = directions_of(i);
    if (!(least_cosine(pair) > kMinNodeCosine) || !function.eval(pair.wi, pair.wo, f)) continue;
    filled.samples.pairs.push_back(pair);
    filled.samples.values.insert(filled.samples.values.end(), f.begin(), f.end());
    filled.weights.push_back(kGuessWeight);
    filled.groups.push_back(group++);
    filled.half.push_back(0);
    filled.incidence.push_back(0);
  }
  return filled;
}

}  // namespace burnish
