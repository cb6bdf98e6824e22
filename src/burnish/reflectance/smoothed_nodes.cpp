#include <algorithm>
#include <cmath>
#include <utility>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/bordered_band.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/reflectance/smoothed_nodes.h>

namespace burnish {

namespace {

constexpr std::size_t kLine = 64;
constexpr double kMinNodeCosine = 0.02, kFullCosine = 0.15;
constexpr int kReweightings = 2;
constexpr double kRound = 0.02;            // errors in ln f below this count as squares
constexpr double kScale = 0.1;             // and those of this size weigh the same in both kinds of error
constexpr double kLevel = 1e-7;            // share of squared slopes
constexpr double kSame = 1;                // of slopes that cannot be
constexpr double kGuessWeight = 0.1;       // of what stands where nothing was measured
constexpr NodeVolume kGuessed{48, 12, 6};  // nodes leave gaps where they touch none of its places
constexpr double kUpright = 1e-12;         // theta_h of rounding
constexpr double kRidge = 1e-10;           // of unknowns that nothing else holds

/// The unknowns that a pair's ln(f + floor) is the weighted sum of.
struct Row {
  std::array<std::uint32_t, 10> index;
  std::array<double, 10> weight;
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

/// Where the unknowns are: the volume, theta_h slowest, then the line.
struct Unknowns {
  std::array<std::size_t, 3> counts, strides;
  std::size_t volume;

  explicit Unknowns(const NodeVolume& v) noexcept
      : counts{v.half, v.difference, v.azimuth},
        strides{v.difference * v.azimuth, v.azimuth, 1},
        volume(v.count()) {}

  std::size_t size() const noexcept { return volume + kLine; }
  std::size_t band() const noexcept { return 2 * strides[0]; }  // of second differences along theta_h

  Row row_of(Vec3 wi, Vec3 wo) const noexcept {
    const HalfDiff a = to_half_diff(wi, wo);
    // phi_d folded by exchange and reflection; where h is the normal no direction stands out
    const double phi_d = a.theta_h < kUpright ? 0 : std::abs(std::remainder(a.phi_d, kPi));
    const std::array<double, 3> x{std::sqrt(std::tan(a.theta_h / 2)), std::tan(a.theta_d / 2),
                                  std::tan(phi_d / 2)};
    const std::array<Place, 3> place{Place(x[0], counts[0]), Place(x[1], counts[1]), Place(x[2], counts[2])};
    Row row{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
      std::size_t index = 0;
      double weight = 1;
      for (std::size_t k = 0; k < 3; ++k) {
        const bool high = corner >> k & 1;
        index += (place[k].low + high) * strides[k];
        weight *= high ? place[k].fraction : 1 - place[k].fraction;
      }
      row.index[corner] = static_cast<std::uint32_t>(index);
      row.weight[corner] = weight;
    }
    const Place at(x[0], kLine);
    for (std::size_t high = 0; high < 2; ++high) {
      row.index[8 + high] = static_cast<std::uint32_t>(volume + at.low + high);
      row.weight[8 + high] = high ? at.fraction : 1 - at.fraction;
    }
    return row;
  }

  /// The directions of a place of the volume.
  DirectionPair directions(std::size_t place) const noexcept {
    const auto part = [&](std::size_t axis) {
      return static_cast<double>(place / strides[axis] % counts[axis]) /
             static_cast<double>(counts[axis] - 1);
    };
    const auto [wi, wo] = from_half_diff({.theta_h = 2 * std::atan(part(0) * part(0)),
                                          .theta_d = 2 * std::atan(part(1)),
                                          .phi_d = 2 * std::atan(part(2))});
    return {wi, wo};
  }
};

// Adds share times the integral of the squared second derivative along unknowns first, first + stride, ...
void add_stiffness(BorderedBand& matrix, std::size_t first, std::size_t stride, std::size_t count,
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
void add_slope(BorderedBand& matrix, std::size_t unknown, std::size_t stride, std::size_t count, double lines,
               double share) {
  const double weight = share * static_cast<double>(count - 1) / lines;
  matrix.at(unknown, unknown) += weight;
  matrix.at(unknown - stride, unknown - stride) += weight;
  matrix.at(unknown, unknown - stride) -= weight;
}

BorderedBand stiffness(const Unknowns& unknowns, const NodeSmoothness& smoothness) {
  BorderedBand matrix(unknowns.volume, unknowns.band(), kLine);
  std::array<double, 3> lines{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t stride = unknowns.strides[axis], count = unknowns.counts[axis];
    lines[axis] = static_cast<double>(unknowns.volume / count);
    for (std::size_t i = 0; i < unknowns.volume; ++i)
      if (i / stride % count == 0)
        add_stiffness(matrix, i, stride, count, smoothness.shares[axis] / lines[axis]);
  }
  add_stiffness(matrix, unknowns.volume, 1, kLine, smoothness.shares[3]);
  // trends die away where no node holds them; where h or d is the normal's or h's own, phi_d means nothing
  for (std::size_t i = 0; i < unknowns.volume; ++i) {
    const std::size_t h = i / unknowns.strides[0], d = i / unknowns.strides[1] % unknowns.counts[1],
                      p = i % unknowns.counts[2];
    if (d > 0) add_slope(matrix, i, unknowns.strides[1], unknowns.counts[1], lines[1], kLevel);
    if (p > 0)
      add_slope(matrix, i, unknowns.strides[2], unknowns.counts[2], lines[2],
                h == 0 || d == 0 ? kSame : kLevel);
  }
  for (std::size_t i = 0; i < unknowns.size(); ++i) matrix.at(i, i) += kRidge;
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

Problem problem_of(const MeasuredNodes& nodes, const Unknowns& unknowns) {
  const auto channels = nodes.samples.channels;
  Problem problem;
  problem.largest.assign(channels, 0);
  double total = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const DirectionPair& pair = nodes.samples.pairs[i];
    if (!(least_cosine(pair) > kMinNodeCosine)) continue;
    problem.rows.push_back(unknowns.row_of(pair.wi, pair.wo));
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
std::vector<double> solve(const Problem& problem, const std::vector<double>& weights, BorderedBand matrix) {
  const std::size_t channels = problem.largest.size(), unknowns = matrix.size();
  std::vector<std::vector<double>> right(channels, std::vector<double>(unknowns));
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
  std::vector<double> values(unknowns * channels);
  for (std::size_t c = 0; c < channels; ++c) {
    matrix.solve(right[c]);
    for (std::size_t u = 0; u < unknowns; ++u) values[u * channels + c] = right[c][u];
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

SmoothedNodes::SmoothedNodes(const MeasuredNodes& nodes, const NodeSmoothness& smoothness,
                             const NodeVolume& volume)
    : channels_(nodes.samples.channels), volume_(volume) {
  if (!nodes.samples.isotropic)
    throw Error("smooth function through nodes: expected an isotropic source, found an anisotropic one");
  const auto channels = channels_;
  const Unknowns unknowns(volume);
  const Problem problem = problem_of(nodes, unknowns);
  const BorderedBand stiff = stiffness(unknowns, smoothness);
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
  const Row row = Unknowns(volume_).row_of(wi, wo);
  for (std::size_t c = 0; c < f.size(); ++c)
    f[c] = std::clamp(std::exp(logarithm(row, values_, f.size(), c)) - kFloor, 0.0, 2 * largest_[c]);
  return true;
}

MeasuredNodes with_gaps_filled(const MeasuredNodes& fitted, const MeasuredNodes& all, BrdfRef function) {
  // the places that nodes touch
  const Unknowns unknowns(kGuessed);
  std::vector<std::uint8_t> touched(unknowns.volume);
  for (const DirectionPair& pair : all.samples.pairs) {
    if (!(least_cosine(pair) > kMinNodeCosine)) continue;
    const Row row = unknowns.row_of(pair.wi, pair.wo);
    for (std::size_t corner = 0; corner < 8; ++corner) touched[row.index[corner]] = 1;
  }

  MeasuredNodes filled = fitted;
  std::uint32_t group = all.group_count();
  std::vector<double> f(function.channels());
  for (std::size_t i = 0; i < unknowns.volume; ++i) {
    if (touched[i]) continue;
    const DirectionPair pair = unknowns.directions(i);
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
