#include <algorithm>
#include <cmath>
#include <utility>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/envelope_matrix.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/smoothed_nodes.h>

namespace burnish {

namespace {

// Unknowns: the volume, theta_h slowest, then the line.
constexpr std::array<std::size_t, 3> kCounts{48, 12, 6};
constexpr std::array<std::size_t, 3> kStrides{kCounts[1] * kCounts[2], kCounts[2], 1};
constexpr std::size_t kVolume = kCounts[0] * kStrides[0], kLine = 16, kUnknowns = kVolume + kLine;
constexpr std::size_t kBand = 2 * kStrides[0];  // of second differences along theta_h

constexpr double kLeastCosine = 0.02, kFullCosine = 0.15;
constexpr int kReweightings = 2;
constexpr double kRound = 0.02;       // errors in ln f below this count as squares
constexpr double kScale = 0.1;        // and those of this size weigh the same in both kinds of error
constexpr double kLevel = 1e-7;       // share of squared slopes
constexpr double kSame = 1;           // of slopes that cannot be
constexpr double kGuessWeight = 0.1;  // of what stands where nothing was measured
constexpr double kRidge = 1e-10;      // of unknowns that nothing else holds

/// The unknowns that a pair's ln(f + floor) is the weighted sum of.
struct Row {
  std::array<std::uint32_t, 12> index;
  std::array<double, 12> weight;
};

struct Place {
  std::size_t low;
  double fraction;

  Place(double x, std::size_t count) noexcept {
    const double at = std::clamp(x, 0.0, 1.0) * static_cast<double>(count - 1);
    low = std::min(static_cast<std::size_t>(at), count - 2);
    fraction = at - static_cast<double>(low);
  }
};

Row row_of(Vec3 wi, Vec3 wo) noexcept {
  const HalfDiff a = to_half_diff(wi, wo);
  // phi_d folded by exchange and reflection
  const double turn = std::abs(std::remainder(a.phi_d, kPi));
  const std::array<Place, 3> place{Place(std::sqrt(a.theta_h / kHalfPi), kCounts[0]),
                                   Place(a.theta_d / kHalfPi, kCounts[1]), Place(turn / kHalfPi, kCounts[2])};
  Row row{};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    std::size_t index = 0;
    double weight = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool high = corner >> k & 1;
      index += (place[k].low + high) * kStrides[k];
      weight *= high ? place[k].fraction : 1 - place[k].fraction;
    }
    row.index[corner] = static_cast<std::uint32_t>(index);
    row.weight[corner] = weight;
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const Place at(theta_of(side ? wo : wi) / kHalfPi, kLine);
    for (std::size_t high = 0; high < 2; ++high) {
      row.index[8 + 2 * side + high] = static_cast<std::uint32_t>(kVolume + at.low + high);
      row.weight[8 + 2 * side + high] = high ? at.fraction : 1 - at.fraction;
    }
  }
  return row;
}

// Adds share times the integral of the squared second derivative along unknowns first, first + stride, ...
void add_stiffness(EnvelopeMatrix& matrix, std::size_t first, std::size_t stride, std::size_t count,
                   double share) {
  const double step = static_cast<double>(count - 1);
  const double weight = share * step * step * step * step / static_cast<double>(count - 2);
  constexpr std::array<double, 3> kDifference{1, -2, 1};
  for (std::size_t i = 0; i + 2 < count; ++i)
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b <= a; ++b)
        matrix.at(first + (i + a) * stride, first + (i + b) * stride) +=
            weight * kDifference[a] * kDifference[b];
}

// Adds share times the squared slope between an unknown and the one a stride before it, of `count` a line.
void add_slope(EnvelopeMatrix& matrix, std::size_t unknown, std::size_t stride, std::size_t count,
               double share) {
  const double steps = static_cast<double>(count - 1), lines = static_cast<double>(kVolume / count);
  const double weight = share * steps / lines;
  matrix.at(unknown, unknown) += weight;
  matrix.at(unknown - stride, unknown - stride) += weight;
  matrix.at(unknown, unknown - stride) -= weight;
}

EnvelopeMatrix stiffness(const NodeSmoothness& smoothness) {
  std::vector<std::size_t> first(kUnknowns, 0);  // the line's rows are full
  for (std::size_t i = kBand; i < kVolume; ++i) first[i] = i - kBand;
  EnvelopeMatrix matrix(std::move(first));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double lines = static_cast<double>(kVolume / kCounts[axis]);
    for (std::size_t i = 0; i < kVolume; ++i)
      if (i / kStrides[axis] % kCounts[axis] == 0)
        add_stiffness(matrix, i, kStrides[axis], kCounts[axis], smoothness.shares[axis] / lines);
  }
  add_stiffness(matrix, kVolume, 1, kLine, smoothness.shares[3]);
  // trends die away where no node holds them; where h or d is the normal's or h's own, phi_d means nothing
  for (std::size_t i = 0; i < kVolume; ++i) {
    const std::size_t d = i / kStrides[1] % kCounts[1], p = i % kCounts[2];
    if (d > 0) add_slope(matrix, i, kStrides[1], kCounts[1], kLevel);
    if (p > 0) add_slope(matrix, i, kStrides[2], kCounts[2], i < kStrides[0] || d == 0 ? kSame : kLevel);
  }
  for (std::size_t i = 0; i < kUnknowns; ++i) matrix.at(i, i) += kRidge;
  return matrix;
}

double least_cosine(const DirectionPair& pair) noexcept {
  return std::min(pair.wi.z, pair.wo.z);
}

/// The nodes' rows, logarithms and weights, which sum to 1.
struct Problem {
  std::vector<Row> rows;
  std::vector<double> targets;  // [row][channel]
  std::vector<double> weights;
  std::vector<double> largest;  // [channel]
};

Problem problem_of(const MeasuredNodes& nodes) {
  const auto channels = static_cast<std::size_t>(nodes.samples.channels);
  Problem problem;
  problem.largest.assign(channels, 0);
  double total = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const DirectionPair& pair = nodes.samples.pairs[i];
    if (!(least_cosine(pair) > kLeastCosine)) continue;
    problem.rows.push_back(row_of(pair.wi, pair.wo));
    problem.weights.push_back(nodes.weights[i] * std::min(1.0, least_cosine(pair) / kFullCosine));
    total += problem.weights.back();
    for (std::size_t c = 0; c < channels; ++c) {
      const double f = std::max(0.0, nodes.samples.at(i)[c]);
      problem.targets.push_back(std::log(f + SmoothedNodes::kFloor));
      problem.largest[c] = std::max(problem.largest[c], f);
    }
  }
  if (problem.rows.empty())
    throw Error("nodes: expected some that are not within a degree of the horizon, found none");
  for (double& weight : problem.weights) weight /= total;
  return problem;
}

/// Weighted least squares; the unknowns as [unknown][channel].
std::vector<double> solve(const Problem& problem, const std::vector<double>& weights, EnvelopeMatrix matrix) {
  const std::size_t channels = problem.largest.size();
  std::vector<std::vector<double>> right(channels, std::vector<double>(kUnknowns));
  for (std::size_t i = 0; i < problem.rows.size(); ++i) {
    const Row& row = problem.rows[i];
    for (std::size_t a = 0; a < row.index.size(); ++a) {
      const double weight = weights[i] * row.weight[a];
      if (weight == 0) continue;
      for (std::size_t c = 0; c < channels; ++c)
        right[c][row.index[a]] += weight * problem.targets[i * channels + c];
      // every ordered pair of unknowns once: of the two ways round the one below the diagonal
      for (std::size_t b = 0; b < row.index.size(); ++b)
        if (row.index[b] <= row.index[a]) matrix.at(row.index[a], row.index[b]) += weight * row.weight[b];
    }
  }
  matrix.factor();
  std::vector<double> values(kUnknowns * channels);
  for (std::size_t c = 0; c < channels; ++c) {
    matrix.solve(right[c]);
    for (std::size_t u = 0; u < kUnknowns; ++u) values[u * channels + c] = right[c][u];
  }
  return values;
}

double logarithm(const Row& row, const std::vector<double>& values, std::size_t channels,
                 std::size_t channel) noexcept {
  double sum = 0;
  for (std::size_t a = 0; a < row.index.size(); ++a)
    sum += row.weight[a] * values[row.index[a] * channels + channel];
  return sum;
}

}  // namespace

SmoothedNodes::SmoothedNodes(const MeasuredNodes& nodes, const NodeSmoothness& smoothness)
    : channels_(nodes.samples.channels) {
  if (!nodes.samples.isotropic)
    throw Error("smooth function through nodes: expected an isotropic source, found an anisotropic one");
  const auto channels = static_cast<std::size_t>(channels_);
  const Problem problem = problem_of(nodes);
  const EnvelopeMatrix stiff = stiffness(smoothness);
  std::vector<double> weights = problem.weights;
  values_ = solve(problem, weights, stiff);
  // towards the absolute error, the mean over the channels
  for (int pass = 0; pass < kReweightings; ++pass) {
    for (std::size_t i = 0; i < problem.rows.size(); ++i) {
      double error = 0;
      for (std::size_t c = 0; c < channels; ++c)
        error +=
            std::abs(logarithm(problem.rows[i], values_, channels, c) - problem.targets[i * channels + c]);
      weights[i] = problem.weights[i] * kScale / std::max(kRound, error / static_cast<double>(channels));
    }
    values_ = solve(problem, weights, stiff);
  }
  largest_ = problem.largest;
}

bool SmoothedNodes::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  std::ranges::fill(f, 0.0);
  if (!(wi.z > 0 && wo.z > 0)) return true;
  const Row row = row_of(wi, wo);
  for (std::size_t c = 0; c < f.size(); ++c)
    f[c] = std::clamp(std::exp(logarithm(row, values_, f.size(), c)) - kFloor, 0.0, 2 * largest_[c]);
  return true;
}

MeasuredNodes with_gaps_filled(const MeasuredNodes& fitted, const MeasuredNodes& all, BrdfRef function) {
  // the places that nodes touch
  std::vector<std::uint8_t> touched(kVolume);
  for (const DirectionPair& pair : all.samples.pairs) {
    if (!(least_cosine(pair) > kLeastCosine)) continue;
    const Row row = row_of(pair.wi, pair.wo);
    for (std::size_t corner = 0; corner < 8; ++corner) touched[row.index[corner]] = 1;
  }

  MeasuredNodes filled = fitted;
  std::uint32_t group = all.group_count();
  std::vector<double> f(static_cast<std::size_t>(function.channels()));
  for (std::size_t i = 0; i < kVolume; ++i) {
    if (touched[i]) continue;
    const auto part = [&](std::size_t axis) {
      return static_cast<double>(i / kStrides[axis] % kCounts[axis]) / static_cast<double>(kCounts[axis] - 1);
    };
    const auto [wi, wo] = from_half_diff(
        {.theta_h = kHalfPi * part(0) * part(0), .theta_d = kHalfPi * part(1), .phi_d = kHalfPi * part(2)});
    if (!(least_cosine({wi, wo}) > kLeastCosine) || !function.eval(wi, wo, f)) continue;
    filled.samples.pairs.push_back({wi, wo});
    filled.samples.values.insert(filled.samples.values.end(), f.begin(), f.end());
    filled.weights.push_back(kGuessWeight);
    filled.groups.push_back(group++);
    filled.half.push_back(0);
    filled.incidence.push_back(0);
  }
  return filled;
}

}  // namespace burnish
