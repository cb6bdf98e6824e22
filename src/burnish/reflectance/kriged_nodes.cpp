// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/kriged_nodes.h>

namespace burnish {

namespace {

constexpr double kFullCosine = 0.15;  // cosine from which nodes are not noisier than others
constexpr double kUpright = 1e-12;    // theta_h below this is rounding
constexpr double kGuessWeight = 0.1;  // weight of values where nothing was measured

constexpr std::size_t kNeighbours = KrigedNodes::kNeighbours;
constexpr std::size_t kCentresTogether = 64;  // a thread at a time
constexpr std::size_t kNodesACentre = 4;      // from kEnoughCentres centres on
constexpr std::size_t kEnoughCentres = 1 << 11;
constexpr std::size_t kSolvedNumbers = 1 << 24;  // at most, of all centres: spectra have many channels
constexpr double kCalibrationPrior = 2;          // number of nodes with the expected deviation, as a prior
constexpr double kMostSurprise = 16;             // largest standardized square of one node
constexpr double kLeastNoise = 1e-5;             // of the variance
constexpr double kLeastPivot = 1e-9;             // of the variance

// Blocks of nodes whose likelihood is maximized.
constexpr std::size_t kNearBlocks = 16, kNearNodes = 64;
constexpr std::size_t kFewNearBlocks = 6, kSpreadNodes = 320;
constexpr TreePoint kNear{3, 1, 0.5, 0}, kNearAnisotropic{1.5, 1.5, 1, 1};

// Cells along theta_h, theta_d and phi_d. There is a gap where nodes touch none of a cell's corners.
constexpr std::array<std::size_t, 3> kCells{48, 12, 6};

double least_cosine(const DirectionPair& pair) noexcept {
  return std::min(pair.wi.z, pair.wo.z);
}

/// Returns a node's weight: nodes near the horizon are noisier than others.
double weight_of(const DirectionPair& pair) noexcept {
  return std::min(1.0, least_cosine(pair) / kFullCosine);
}

/// Returns the variance of noise. Covariances are floats, so less noise than their rounding would make the matrix
/// indefinite.
double noise_variance(const LogCovariance& covariance, double units) noexcept {
  return std::max(units * covariance.noise * covariance.noise, kLeastNoise * covariance.variance());
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
    // Nodes within a degree of the horizon are left out. A node's variance of noise is 1 / (weight * weight_of).
    const DirectionPair& pair = nodes.samples.pairs[i];
    if (!(least_cosine(pair) > KrigedNodes::kLeastCosine)) continue;
    result.node.push_back(static_cast<std::uint32_t>(i));
    result.measured.places.push_back(place_of(pair.wi, pair.wo, nodes.samples.isotropic));
    result.measured.grazing.push_back(grazing_measure(pair.wi, pair.wo));
    result.measured.variances.push_back(1 / (nodes.weights[i] * weight_of(pair)));
    for (std::size_t c = 0; c < channels; ++c) {
      const double f = std::max(0.0, nodes.samples.at(i)[c]);
      result.largest[c] = std::max(result.largest[c], f);
      result.measured.logs.push_back(std::log(f + KrigedNodes::kFloor));
      result.mean[c] += result.measured.logs.back();
    }
  }
  const std::size_t count = result.measured.size();
  if (count == 0) throw Error("nodes: expected some that are not within a degree of the horizon, found none");
  // Each channel's mean is subtracted, so that the process has mean 0.
  for (double& mean : result.mean) mean /= static_cast<double>(count);
  for (std::size_t i = 0; i < count * channels; ++i) result.measured.logs[i] -= result.mean[i % channels];
  return result;
}

/// Returns indices of `count` of `size` things in a random order that depends on the seed alone.
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

/// Returns the corners of the cell around a place in the coordinates (sqrt(tan(theta_h/2)), tan(theta_d/2),
/// tan(phi_d/2)).
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

/// Returns the directions of a corner of cells.
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
  // The square root would make rounding at the normal large.
  const bool upright = angles.theta_h < kUpright;
  const double half = upright ? 0 : std::sqrt(std::tan(angles.theta_h / 2));
  const double difference = std::tan(angles.theta_d / 2);
  if (isotropic) {
    // Exchange and reflection fold phi_d to [0, pi/2]. Where h is the normal, phi_d is not defined.
    const double phi_d = upright ? 0 : std::abs(std::remainder(angles.phi_d, kPi));
    return on_grid({half, difference, std::sin(angles.theta_d) * phi_d / kHalfPi, 0});
  }
  // Only the sum of the azimuths is defined if h is the normal. Doubling it makes the coordinates even in the
  // exchange.
  const double turn = 2 * (angles.phi_h + angles.phi_d);
  return on_grid({half * std::cos(angles.phi_h), half * std::sin(angles.phi_h), difference * std::cos(turn),
                  difference * std::sin(turn)});
}

KrigedNodes::KrigedNodes(const MeasuredNodes& nodes, const LogCovariance& covariance, bool few_pairs)
    : isotropic_(nodes.samples.isotropic), few_pairs_(few_pairs), covariance_(covariance) {
  Logarithms all = logarithms_of(nodes);
  mean_ = std::move(all.mean);
  largest_ = std::move(all.largest);
  std::vector<TreePoint> places;
  places.reserve(all.measured.size());
  for (const TreePoint& place : all.measured.places) places.push_back(scaled(place));
  tree_ = KdTree(places);

  // All arrays are in the tree's order, so that neighbours are near in memory too.
  const std::size_t channels = all.measured.channels;
  measured_.channels = channels;
  for (const std::size_t i : tree_.order()) {
    node_.push_back(all.node[i]);
    measured_.places.push_back(all.measured.places[i]);
    measured_.grazing.push_back(all.measured.grazing[i]);
    measured_.variances.push_back(noise_variance(covariance, all.measured.variances[i]));
    for (std::size_t c = 0; c < channels; ++c) measured_.logs.push_back(all.measured.logs[i * channels + c]);
  }
  if (!few_pairs) solve_centres();
}

TreePoint KrigedNodes::scaled(TreePoint place) const noexcept {
  for (std::size_t k = 0; k < place.size(); ++k) place[k] *= covariance_.inverse_length.back()[k];
  return place;
}

namespace {

using Floats = Eigen::Array<float, static_cast<int>(kNeighbours), 1>;
using Square = Eigen::MatrixXd;
using Column = Eigen::VectorXd;

}  // namespace

/// Coordinates of the neighbours, axis by axis, and their grazing measures.
struct KrigingPlaces {
  std::array<Floats, LogCovariance::kAxes> at;
  Floats grazing;
};

/// The same of one place.
struct KrigingPlace {
  std::array<float, LogCovariance::kAxes> at;
  float grazing;

  KrigingPlace(const TreePoint& place, double grazing_measure) noexcept
      : grazing(static_cast<float>(grazing_measure)) {
    for (std::size_t k = 0; k < at.size(); ++k) at[k] = static_cast<float>(place[k]);
  }
};

namespace {

void put(KrigingPlaces& places, std::size_t i, const KrigingPlace& place) noexcept {
  for (std::size_t k = 0; k < place.at.size(); ++k) places.at[k][static_cast<Eigen::Index>(i)] = place.at[k];
  places.grazing[static_cast<Eigen::Index>(i)] = place.grazing;
}

/// Returns sqrt(3) times the distances of a place from the first n of some places, by inverse lengths along each axis.
Floats distances(const std::array<double, LogCovariance::kAxes>& inverse_length, const KrigingPlaces& places,
                 const KrigingPlace& place, Eigen::Index n) noexcept {
  Floats r;
  r.head(n).setZero();
  for (std::size_t k = 0; k < LogCovariance::kAxes; ++k)
    if (inverse_length[k] > 0)
      r.head(n) += ((places.at[k].head(n) - place.at[k]) * static_cast<float>(inverse_length[k])).square();
  r.head(n) = static_cast<float>(LogCovariance::kRoot3) * r.head(n).sqrt();
  return r;
}

/// Returns the covariances of a place with the first n of some places: level^2 + sum over terms of spread^2 (1 +
/// sqrt(3) r) exp(-sqrt(3) r) [Rasmussen 2006, eq. 4.17], and near the horizon the grazing term.
Floats prior_covariances(const LogCovariance& covariance, const KrigingPlaces& places,
                         const KrigingPlace& place, Eigen::Index n) noexcept {
  Floats sum;
  sum.head(n).setConstant(static_cast<float>(covariance.level * covariance.level));
  for (std::size_t t = 0; t < LogCovariance::kTerms; ++t) {
    const Floats r = distances(covariance.inverse_length[t], places, place, n);
    const auto spread2 = static_cast<float>(covariance.spread[t] * covariance.spread[t]);
    sum.head(n) += spread2 * (1 + r.head(n)) * (-r.head(n)).exp();
  }
  if (place.grazing > 0) {
    const Floats r = distances(covariance.grazing_inverse_length, places, place, n);
    const float by = static_cast<float>(covariance.grazing * covariance.grazing) * place.grazing;
    sum.head(n) += by * places.grazing.head(n) * (1 + r.head(n)) * (-r.head(n)).exp();
  }
  return sum;
}

/// Replaces the lower triangle of K by L, column by column.
void factorize_with_least_pivot(Square& matrix, double least) noexcept {
  const Eigen::Index n = matrix.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    const double pivot = std::sqrt(std::max(matrix(j, j), least));
    matrix(j, j) = pivot;
    const Eigen::Index below = n - j - 1;
    if (below == 0) continue;
    matrix.col(j).tail(below) /= pivot;
    for (Eigen::Index k = j + 1; k < n; ++k)
      matrix.col(k).tail(n - k) -= matrix(k, j) * matrix.col(j).tail(n - k);
  }
}

}  // namespace

/// The nodes nearest to a place, in the tree's order, and the Cholesky factor of their covariances K.
struct KrigedNodes::Neighbourhood {
  std::size_t count = 0;
  std::array<std::uint32_t, kNeighbours> nodes;
  KrigingPlaces places;
  Square factor;

  /// Returns the covariances of a place with these nodes.
  Column towards(const LogCovariance& covariance, const KrigingPlace& place) const noexcept {
    const auto n = static_cast<Eigen::Index>(count);
    return prior_covariances(covariance, places, place, n).head(n).cast<double>().matrix();
  }
  /// Replaces x by K^-1 x.
  void solve(Column& x) const noexcept {
    factor.template triangularView<Eigen::Lower>().solveInPlace(x);
    factor.template triangularView<Eigen::Lower>().adjoint().solveInPlace(x);
  }
};

template <class Takes>
KrigedNodes::Neighbourhood KrigedNodes::neighbourhood(const TreePoint& scaled_place,
                                                      const Takes& takes) const noexcept {
  // The nearest nodes are sorted, so that sums have one order however the tree is walked.
  std::array<KdTree::Neighbour, kNeighbours> found;
  Neighbourhood near;
  const std::size_t most = few_pairs_ ? kFewPairsNeighbours : kNeighbours;
  near.count = tree_.nearest(scaled_place, std::span(found).first(most), takes);
  for (std::size_t i = 0; i < near.count; ++i) near.nodes[i] = static_cast<std::uint32_t>(found[i].place);
  std::sort(near.nodes.begin(), near.nodes.begin() + static_cast<std::ptrdiff_t>(near.count));
  const auto place_of_node = [&](std::uint32_t node) {
    return KrigingPlace(measured_.places[node], measured_.grazing[node]);
  };
  for (std::size_t i = 0; i < near.count; ++i) put(near.places, i, place_of_node(near.nodes[i]));

  // The lower triangle of K holds the covariances of each node with those before it, and on the diagonal its variance
  // with the noise.
  const auto n = static_cast<Eigen::Index>(near.count);
  near.factor.resize(n, n);
  const auto fill = [&] {
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::uint32_t node = near.nodes[static_cast<std::size_t>(i)];
      const Floats row = prior_covariances(covariance_, near.places, place_of_node(node), i);
      near.factor.row(i).head(i) = row.head(i).cast<double>().matrix().transpose();
      near.factor(i, i) = covariance_.variance(measured_.grazing[node]) + measured_.variances[node];
    }
  };
  fill();

  // K = L L^T. Where rounding made K indefinite, a least pivot factorizes it anyway.
  Eigen::LLT<Eigen::Ref<Square>, Eigen::Lower> in_place(near.factor);
  if (in_place.info() == Eigen::Success) return near;
  fill();
  factorize_with_least_pivot(near.factor, kLeastPivot * covariance_.variance());
  return near;
}

// Computes K^-1 y of each centre's neighbours, with which all pairs near the centre are predicted.
void KrigedNodes::solve_centres() {
  // Every step-th node in the tree's order is a centre: so centres are spread as the nodes are.
  const std::size_t enough = std::clamp(measured_.size() / kNodesACentre, kEnoughCentres, kCentres);
  const std::size_t most = std::min(enough, kSolvedNumbers / (kNeighbours * measured_.channels) + 1);
  const std::size_t step = (measured_.size() - 1) / most + 1;
  std::vector<TreePoint> places;
  for (std::size_t i = 0; i < measured_.size(); i += step) places.push_back(tree_.points()[i]);
  centres_ = KdTree(places);

  const std::size_t channels = measured_.channels, count = std::min(kNeighbours, measured_.size());
  std::vector<double> surprises(centres_.size());
  near_.resize(centres_.size() * count);
  solved_.resize(centres_.size() * count * channels);
  for_each_chunk(centres_.size(), kCentresTogether, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      // Each channel solves K x = y for the neighbours' logarithms y. The centre's own surprise is kept for
      // calibration.
      const Neighbourhood near = neighbourhood(centres_.points()[c], [](std::size_t) { return true; });
      std::copy_n(near.nodes.begin(), count, near_.begin() + static_cast<std::ptrdiff_t>(c * count));
      for (std::size_t channel = 0; channel < channels; ++channel) {
        Column solved(static_cast<Eigen::Index>(count));
        for (std::size_t i = 0; i < count; ++i)
          solved[static_cast<Eigen::Index>(i)] = measured_.logs[near.nodes[i] * channels + channel];
        near.solve(solved);
        for (std::size_t i = 0; i < count; ++i)
          solved_[(c * count + i) * channels + channel] =
              static_cast<float>(solved[static_cast<Eigen::Index>(i)]);
      }
      const auto own = static_cast<std::uint32_t>(centres_.order()[c] * step);
      surprises[c] =
          surprise_of(near, own, std::span(solved_).subspan(c * count * channels, count * channels));
    }
  });
  calibrate(surprises);
}

/// Returns the square of a node's leave-one-out residual over its predicted variance, mean over the channels: ((K^-1
/// y)_i)^2 / (K^-1)_ii [Rasmussen 2006, eq. 5.12]. Returns 1 where the node is not among the neighbours.
double KrigedNodes::surprise_of(const Neighbourhood& near, std::uint32_t node,
                                std::span<const float> solved) {
  const auto found = std::lower_bound(near.nodes.begin(),
                                      near.nodes.begin() + static_cast<std::ptrdiff_t>(near.count), node);
  const auto own = static_cast<std::size_t>(found - near.nodes.begin());
  if (own == near.count || *found != node) return 1;
  // (K^-1)_ii is the squared length of L^-1 e_i.
  Column unit = Column::Zero(static_cast<Eigen::Index>(near.count));
  unit[static_cast<Eigen::Index>(own)] = 1;
  near.factor.template triangularView<Eigen::Lower>().solveInPlace(unit);
  const std::size_t channels = solved.size() / near.count;
  double squares = 0;
  for (std::size_t c = 0; c < channels; ++c) {
    const auto value = static_cast<double>(solved[own * channels + c]);
    squares += value * value;
  }
  return squares / (static_cast<double>(channels) * unit.squaredNorm());
}

/// Computes the factor of variances near each centre: the mean of the nearest standardized squares, bounded against
/// outliers, with a prior of 1.
void KrigedNodes::calibrate(std::span<const double> surprises) {
  // Fewer centres than nodes lie farther apart. Half as many reach about as far.
  const std::size_t calibrating = centres_.size() < measured_.size() ? kCalibrating / 2 : kCalibrating;
  calibration_.resize(centres_.size());
  for_each_chunk(centres_.size(), kCentresTogether, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      std::array<KdTree::Neighbour, kCalibrating> found;
      const std::size_t count = centres_.nearest(centres_.points()[c], std::span(found).first(calibrating),
                                                 [](std::size_t) { return true; });
      std::sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
      double sum = kCalibrationPrior;
      for (std::size_t i = 0; i < count; ++i) sum += std::min(surprises[found[i].place], kMostSurprise);
      calibration_[c] = static_cast<float>(sum / (kCalibrationPrior + static_cast<double>(count)));
    }
  });
}

double KrigedNodes::value_of(double log, std::size_t channel) const noexcept {
  return std::clamp(std::exp(mean_[channel] + log) - kFloor, 0.0, 2 * largest_[channel]);
}

bool KrigedNodes::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  std::ranges::fill(f, 0.0);
  if (!(wi.z > 0 && wo.z > 0)) return true;
  // Without shared neighbours, each pair solves its own.
  if (centres_.size() == 0) {
    eval_from(
        wi, wo, [](std::size_t) { return true; }, f);
    return true;
  }
  // The nearest centre's neighbours predict: ln f = k^T (K^-1 y) with the covariances k of the pair with them
  // [Rasmussen 2006, eq. 2.25].
  const TreePoint place = place_of(wi, wo, isotropic_);
  std::array<KdTree::Neighbour, 1> nearest;
  centres_.nearest(scaled(place), nearest, [](std::size_t) { return true; });
  const std::size_t centre = nearest[0].place;
  const std::size_t count = std::min(kNeighbours, measured_.size());
  KrigingPlaces places;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t node = near_[centre * count + i];
    put(places, i, KrigingPlace(measured_.places[node], measured_.grazing[node]));
  }
  const Floats towards = prior_covariances(covariance_, places, KrigingPlace(place, grazing_measure(wi, wo)),
                                           static_cast<Eigen::Index>(count));
  for (std::size_t c = 0; c < f.size(); ++c) {
    double log = 0;
    for (std::size_t i = 0; i < count; ++i)
      log += static_cast<double>(towards[static_cast<Eigen::Index>(i)]) *
             static_cast<double>(solved_[(centre * count + i) * f.size() + c]);
    f[c] = value_of(log, c);
  }
  return true;
}

void KrigedNodes::eval_from(Vec3 wi, Vec3 wo, const std::function<bool(std::size_t node)>& takes,
                            std::span<double> f) const noexcept {
  std::ranges::fill(f, 0.0);
  if (!(wi.z > 0 && wo.z > 0)) return;
  const TreePoint place = place_of(wi, wo, isotropic_);
  const Neighbourhood near = neighbourhood(scaled(place), [&](std::size_t at) { return takes(node_[at]); });
  // The weights K^-1 k do not depend on the channel; each prediction is their product with the logarithms.
  Column weights = near.towards(covariance_, KrigingPlace(place, grazing_measure(wi, wo)));
  near.solve(weights);
  for (std::size_t c = 0; c < f.size(); ++c) {
    double log = 0;
    for (std::size_t i = 0; i < near.count; ++i)
      log += weights[static_cast<Eigen::Index>(i)] * measured_.logs[near.nodes[i] * f.size() + c];
    f[c] = value_of(log, c);
  }
}

LogUncertainty KrigedNodes::uncertainty(Vec3 wi, Vec3 wo) const noexcept {
  if (!(wi.z > 0 && wo.z > 0)) return {};
  const TreePoint place = place_of(wi, wo, isotropic_);
  const Neighbourhood near = neighbourhood(scaled(place), [](std::size_t) { return true; });
  const double grazing = grazing_measure(wi, wo);
  const Column towards = near.towards(covariance_, KrigingPlace(place, grazing));
  Column weights = towards;
  near.solve(weights);
  // The predictive variance is k(x, x) - k^T K^-1 k [Rasmussen 2006, eq. 2.26]; a reading adds its noise.
  const double variance = std::max(0.0, covariance_.variance(grazing) - weights.dot(towards));
  const double noise = noise_variance(covariance_, 1 / weight_of({wi, wo}));
  const double by = calibration({wi, wo});
  return {std::sqrt(by * variance), std::sqrt(by * (variance + noise))};
}

void KrigedNodes::covariances_with(const DirectionPair& one, std::span<const DirectionPair> others,
                                   std::span<double> covariances) const noexcept {
  // The posterior covariance is the prior one less k_a^T K^-1 k_b, which the nodes determine [Rasmussen 2006, eq.
  // 2.24].
  const TreePoint place = place_of(one.wi, one.wo, isotropic_);
  const Neighbourhood near = neighbourhood(scaled(place), [](std::size_t) { return true; });
  const KrigingPlace here(place, grazing_measure(one.wi, one.wo));
  Column weights = near.towards(covariance_, here);
  near.solve(weights);
  KrigingPlaces at_one;
  put(at_one, 0, here);
  for (std::size_t i = 0; i < others.size(); ++i) {
    const KrigingPlace other(place_of(others[i].wi, others[i].wo, isotropic_),
                             grazing_measure(others[i].wi, others[i].wo));
    const auto prior = static_cast<double>(prior_covariances(covariance_, at_one, other, 1)[0]);
    covariances[i] = prior - weights.dot(near.towards(covariance_, other));
  }
}

double KrigedNodes::calibration(const DirectionPair& pair) const noexcept {
  if (centres_.size() == 0) return 1;
  std::array<KdTree::Neighbour, 1> nearest;
  centres_.nearest(scaled(place_of(pair.wi, pair.wo, isotropic_)), nearest, [](std::size_t) { return true; });
  return static_cast<double>(calibration_[nearest[0].place]);
}

std::vector<LogCovariance> likely_covariances(const MeasuredNodes& nodes) {
  const LogMeasurements measured = logarithms_of(nodes).measured;
  std::vector<TreePoint> places = measured.places;
  const TreePoint& by = nodes.samples.isotropic ? kNear : kNearAnisotropic;
  for (TreePoint& place : places)
    for (std::size_t k = 0; k < place.size(); ++k) place[k] *= by[k];
  const KdTree tree(places);

  // Groups of near nodes around randomly drawn nodes tell how rough the source is.
  std::vector<std::vector<std::size_t>> near;
  for (const std::size_t centre : drawn(kNearBlocks, places.size(), 1)) {
    std::array<KdTree::Neighbour, kNearNodes> found;
    const std::size_t count = tree.nearest(places[centre], found, [](std::size_t) { return true; });
    std::vector<std::size_t>& block = near.emplace_back();
    for (std::size_t i = 0; i < count; ++i) block.push_back(tree.order()[found[i].place]);
    std::ranges::sort(block);
  }
  // A few of these groups and a set of nodes from everywhere tell how the source varies between places.
  std::vector<std::vector<std::size_t>> spread(
      near.begin(), near.begin() + static_cast<std::ptrdiff_t>(std::min(kFewNearBlocks, near.size())));
  spread.push_back(drawn(kSpreadNodes, places.size(), 2));
  return {likeliest_covariance(measured, near, nodes.samples.isotropic),
          likeliest_covariance(measured, spread, nodes.samples.isotropic)};
}

MeasuredNodes with_gaps_filled(const MeasuredNodes& fitted, const MeasuredNodes& all, BrdfRef function) {
  // All corners of cells that hold a node are touched; the others are gaps.
  std::vector<std::uint8_t> touched(kCells[0] * kCells[1] * kCells[2]);
  for (const DirectionPair& pair : all.samples.pairs)
    if (least_cosine(pair) > KrigedNodes::kLeastCosine)
      for (const std::size_t corner : corners_of(pair.wi, pair.wo)) touched[corner] = 1;

  MeasuredNodes filled = fitted;
  std::uint32_t group = all.group_count();
  std::vector<double> f(function.channels());
  for (std::size_t i = 0; i < touched.size(); ++i) {
    if (touched[i]) continue;
    // Each gap above the horizon is filled with the function's value, a group of its own and little weight.
    const DirectionPair pair = directions_of(i);
    if (!(least_cosine(pair) > KrigedNodes::kLeastCosine) || !function.eval(pair.wi, pair.wo, f)) continue;
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
