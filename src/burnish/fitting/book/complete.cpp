// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/fitting/book/complete.h>
#include <burnish/fitting/book/three_channels.h>
#include <burnish/fitting/refinement/training_set.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::size_t kColours = MaterialBook::kAxes, kRgb = MaterialBook::kChannels;
constexpr std::size_t kEvidencePairs = 150;  // by which the prior is chosen

// The priors that are tried: near one of the library's materials, or near their mean, where far out is allowed.
constexpr std::array kNearSpreads = {0.1, 0.2, 0.4, 0.7}, kMeanSpreads = {1.0, 2.0, 4.0, 8.0};
constexpr std::array kResiduals = {0.3, 3.0, 30.0, 300.0};
constexpr std::array kNoises = {1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3};

// The result is the mean of all priors that are at least this likely beside the likeliest.
constexpr double kMinShare = 0.01;

// Measurements are less certain where one direction is near the horizon. Variances are 1 + (this / cosine)^2 times as
// large, as those of scans of RGL materials about a smooth reciprocal volume are.
constexpr double kGrazingCosine = 0.3, kMinPairCosine = 1e-3;

// Lengths of the part that is not in the book, along sqrt(theta_h / (pi/2)), theta_d / (pi/2) and |cos theta_i - cos
// theta_o| / 2. Thirds of it have these lengths times different factors.
constexpr std::array kReach = {0.15, 0.25, 0.25};
constexpr std::array kReaches = {0.7, 2.0, 6.0};

std::vector<CompletionPrior> priors() {
  std::vector<CompletionPrior> all;
  for (const double residual : kResiduals)
    for (const double noise : kNoises) {
      for (const double spread : kNearSpreads)
        all.push_back({.near_one = true, .spread = spread, .residual = residual, .noise = noise});
      for (const double spread : kMeanSpreads)
        all.push_back({.near_one = false, .spread = spread, .residual = residual, .noise = noise});
    }
  return all;
}

/// A place among pairs, in units of kReach.
using Place = std::array<double, 3>;

Place scaled(double theta_h, double theta_d, double rise) {
  return {std::sqrt(theta_h / kHalfPi) / kReach[0], theta_d / kHalfPi / kReach[1], rise / kReach[2]};
}

Place place_of(const DirectionPair& pair) {
  return scaled(2 * std::atan(project_tan_half(kProjectHalf, pair.wi, pair.wo)),
                2 * std::atan(project_tan_half(kProjectDifference, pair.wi, pair.wo)),
                std::abs(pair.wi.z - pair.wo.z) / 2);
}

std::vector<Place> places_of_nodes(const TableLayout& layout) {
  const auto angle = [](const Warp& warp, int i, int count) {
    return 2 * std::atan(warp.inverse(static_cast<double>(i) / (count - 1)));
  };
  std::vector<Place> places;
  for (int z = 0; z < layout.depth; ++z)
    for (int y = 0; y < layout.height; ++y)
      for (int x = 0; x < layout.width; ++x) {
        const double theta_h = angle(layout.warp, x, layout.width),
                     theta_d = angle(layout.warp_y, y, layout.height);
        const double phi_d = angle(layout.warp_z, z, layout.depth);
        places.push_back(scaled(theta_h, theta_d, std::sin(theta_h) * std::sin(theta_d) * std::cos(phi_d)));
      }
  return places;
}

double likeness(const Place& a, const Place& b) {
  double distance2 = 0;
  for (std::size_t k = 0; k < a.size(); ++k) distance2 += (a[k] - b[k]) * (a[k] - b[k]);
  double sum = 0;
  for (const double reach : kReaches) sum += std::exp(-0.5 * distance2 / (reach * reach));
  return sum / static_cast<double>(kReaches.size());
}

/// The pairs as one axis of colour sees them.
struct AxisData {
  VectorXd values;      // less the book's mean
  MatrixXd components;  // [pair][component]
  MatrixXd library;     // [pair][material]: what the library's materials are there, less the mean
  VectorXd deviations;
  double residual2 = 0;
};

/// Pairs, by the axes of colour.
struct PairData {
  std::array<AxisData, kColours> axes;
  MatrixXd likenesses;
  std::vector<Place> places;
  VectorXd noises;  // variances of the logarithms, beside those of the most certain pairs
};

// Weights of all materials, [component][material].
MatrixXd library_weights(const MaterialBook& book, std::size_t u) {
  MatrixXd all(book.axes()[u].component_count(), book.materials().size());
  for (Eigen::Index m = 0; m < all.cols(); ++m) {
    const std::vector<double> weights = book.weights(static_cast<std::size_t>(m))[u];
    all.col(m) = Eigen::Map<const VectorXd>(weights.data(), all.rows());
  }
  return all;
}

PairData pair_data(const MaterialBook& book, const TrainingSet& set, std::span<const std::size_t> chosen) {
  const auto count = static_cast<Eigen::Index>(chosen.size());
  PairData data;
  data.likenesses.resize(count, count);
  data.noises.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const DirectionPair& pair = set.pairs[chosen[static_cast<std::size_t>(i)]];
    data.places.push_back(place_of(pair));
    const double relative = kGrazingCosine / std::max(std::min(pair.wi.z, pair.wo.z), kMinPairCosine);
    data.noises(i) = 1 + relative * relative;
  }
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      data.likenesses(i, j) =
          likeness(data.places[static_cast<std::size_t>(i)], data.places[static_cast<std::size_t>(j)]);

  const std::size_t nodes = book.node_count();
  for (std::size_t u = 0; u < kColours; ++u) {
    const BookAxis& axis = book.axes()[u];
    AxisData& of = data.axes[u];
    of.values.resize(count);
    of.components = MatrixXd::Zero(count, static_cast<Eigen::Index>(axis.component_count()));
    for (Eigen::Index i = 0; i < count; ++i) {
      const std::size_t at = chosen[static_cast<std::size_t>(i)];
      double value = 0;
      for (std::size_t c = 0; c < kRgb; ++c)
        value +=
            kBookAxes[u][c] * std::log(static_cast<double>(set.values[at * kRgb + c]) + MaterialBook::kFloor);
      for (const auto& [node, share] : book_nodes(book.layout(), set.pairs[at])) {
        value -= share * static_cast<double>(axis.mean[node]);
        for (std::size_t k = 0; k < axis.component_count(); ++k)
          of.components(i, static_cast<Eigen::Index>(k)) +=
              share * static_cast<double>(axis.scales[k]) * axis.components[k * nodes + node];
      }
      of.values(i) = value;
    }
    of.library = of.components * library_weights(book, u);
    of.deviations = Eigen::Map<const Eigen::VectorXf>(axis.deviations.data(),
                                                      static_cast<Eigen::Index>(axis.component_count()))
                        .cast<double>();
    of.residual2 = static_cast<double>(axis.residual) * static_cast<double>(axis.residual);
  }
  return data;
}

Eigen::LLT<MatrixXd> factored(const PairData& data, std::size_t u, const CompletionPrior& prior) {
  const AxisData& axis = data.axes[u];
  const MatrixXd spread = axis.components * (prior.spread * axis.deviations).asDiagonal();
  MatrixXd covariance = spread * spread.transpose() + prior.residual * axis.residual2 * data.likenesses;
  covariance.diagonal() += prior.noise * data.noises;
  return Eigen::LLT<MatrixXd>(std::move(covariance));
}

/// Returns how likely pairs are under a prior, for each material where it is near one: logarithms less a constant.
VectorXd log_evidences(const PairData& data, std::size_t u, const CompletionPrior& prior) {
  const AxisData& axis = data.axes[u];
  const Eigen::LLT<MatrixXd> llt = factored(data, u, prior);
  MatrixXd left = prior.near_one ? MatrixXd((-axis.library).colwise() + axis.values) : MatrixXd(axis.values);
  llt.matrixL().solveInPlace(left);
  const MatrixXd triangle = llt.matrixL();
  return (-0.5 * left.colwise().squaredNorm().transpose()).array() - triangle.diagonal().array().log().sum();
}

// Logarithm of the mean of what they are the logarithms of.
double log_mean(const VectorXd& logs) {
  const double largest = logs.maxCoeff();
  return largest + std::log((logs.array() - largest).exp().mean());
}

/// The axes that share a prior: brightness, or both of colour.
using AxisGroup = std::span<const std::size_t>;
constexpr std::array<std::size_t, 1> kBrightness = {0};
constexpr std::array<std::size_t, 2> kColour = {1, 2};

VectorXd group_evidences(const PairData& data, AxisGroup group, const CompletionPrior& prior) {
  VectorXd sum = log_evidences(data, group.front(), prior);
  for (const std::size_t u : group.subspan(1)) sum += log_evidences(data, u, prior);
  return sum;
}

/// A prior and how much it counts.
struct Belief {
  CompletionPrior prior;
  double share = 0;
};

// The likeliest first, with the others that are likely; their shares' sum is 1. `part`: what share of the pairs tells,
// of which all would say so much more surely.
std::vector<Belief> beliefs_of(const PairData& data, AxisGroup group, double part) {
  const std::vector<CompletionPrior> all = priors();
  std::vector<double> evidence(all.size());
  for_each_chunk(all.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
    evidence[k] = log_mean(group_evidences(data, group, all[k]));
  });
  const double most = std::ranges::max(evidence);
  std::vector<Belief> beliefs;
  double sum = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double share = std::exp((evidence[k] - most) / part);
    if (share < kMinShare) continue;
    beliefs.push_back({all[k], share});
    sum += share;
  }
  std::ranges::stable_sort(beliefs, std::ranges::greater(), &Belief::share);
  for (Belief& belief : beliefs) belief.share /= sum;
  return beliefs;
}

/// The posterior of one axis: weights, and the part that is not in the book, as a sum of covariances with the pairs.
struct AxisMean {
  VectorXd weights;
  VectorXd beyond;
  VectorXd errors, errors_left_out;  // of each pair, by what all say and by what the others say
};

/// The same by one prior; what the others say of each pair apart for each of the library's materials.
struct AxisGiven {
  VectorXd weights, beyond, errors;
  MatrixXd left_out;   // [pair][material], of one column where the prior is near none
  VectorXd certainty;  // of each pair given the others: 1 / variance
};

// `shares`: of the library's materials, where the prior is near one of them.
AxisGiven mean_given(const PairData& data, std::size_t u, const CompletionPrior& prior,
                     const VectorXd& shares, const MatrixXd& weights_of_library) {
  const AxisData& axis = data.axes[u];
  VectorXd centre = VectorXd::Zero(axis.components.cols()), left = axis.values;
  if (prior.near_one) {
    centre = weights_of_library * shares;
    left -= axis.library * shares;
  }
  const Eigen::LLT<MatrixXd> llt = factored(data, u, prior);
  const VectorXd solved = llt.solve(left);
  const VectorXd variances = (prior.spread * axis.deviations).array().square();
  // the pair that is left out: [Rasmussen 2006, eq. 5.12]
  const VectorXd inverse =
      llt.matrixL().solve(MatrixXd::Identity(left.size(), left.size())).colwise().squaredNorm().transpose();
  const MatrixXd solved_of_each =
      prior.near_one ? MatrixXd(llt.solve((-axis.library).colwise() + axis.values)) : MatrixXd(solved);
  return {.weights = centre + variances.cwiseProduct(axis.components.transpose() * solved),
          .beyond = prior.residual * axis.residual2 * solved,
          .errors = prior.noise * data.noises.cwiseProduct(solved),
          .left_out = inverse.cwiseInverse().asDiagonal() * solved_of_each,
          .certainty = inverse};
}

/// Predicts pairs that are left out. A prior or a material that saw the pair counts as it would without it: its share
/// is divided by how likely it made this pair given the others.
class LeftOut {
 public:
  LeftOut(std::size_t axes, Eigen::Index pairs)
      : sums_(axes, VectorXd::Zero(pairs)), weights_(VectorXd::Zero(pairs)) {}

  // `shares`: of the columns of what is given, of one prior for all axes of a group.
  void add(const std::vector<AxisGiven>& given, const VectorXd& shares) {
    for (Eigen::Index m = 0; m < shares.size(); ++m) {
      if (shares(m) <= 0) continue;
      for (Eigen::Index i = 0; i < weights_.size(); ++i) {
        double log_weight = std::log(shares(m));
        for (const AxisGiven& axis : given)
          log_weight += 0.5 * (axis.left_out(i, m) * axis.left_out(i, m) * axis.certainty(i) -
                               std::log(axis.certainty(i)));
        const double weight = std::exp(std::min(log_weight, kMaxLogWeight));
        weights_(i) += weight;
        for (std::size_t j = 0; j < given.size(); ++j) sums_[j](i) += weight * given[j].left_out(i, m);
      }
    }
  }
  VectorXd errors(std::size_t axis) const { return sums_[axis].cwiseQuotient(weights_); }

 private:
  static constexpr double kMaxLogWeight = 600;
  std::vector<VectorXd> sums_;
  VectorXd weights_;
};

/// The axes of a group by all that is believed of them.
struct GroupMean {
  std::vector<AxisMean> axes;
  std::string nearest;  // the likeliest of the library's materials, where the likeliest prior is near one
};

GroupMean mean_of(const MaterialBook& book, const PairData& data, AxisGroup group,
                  const std::vector<Belief>& beliefs) {
  GroupMean mean;
  std::vector<MatrixXd> library;
  for (const std::size_t u : group) {
    const Eigen::Index pairs = data.noises.size(), components = data.axes[u].components.cols();
    mean.axes.push_back({.weights = VectorXd::Zero(components),
                         .beyond = VectorXd::Zero(pairs),
                         .errors = VectorXd::Zero(pairs),
                         .errors_left_out = {}});
    library.push_back(library_weights(book, u));
  }
  LeftOut left_out(group.size(), data.noises.size());
  for (std::size_t k = 0; k < beliefs.size(); ++k) {
    const auto& [prior, share] = beliefs[k];
    VectorXd shares = VectorXd::Ones(1);
    if (prior.near_one) {
      const VectorXd evidences = group_evidences(data, group, prior);
      shares = (evidences.array() - evidences.maxCoeff()).exp();
      shares /= shares.sum();
      Eigen::Index likeliest = 0;
      shares.maxCoeff(&likeliest);
      if (k == 0) mean.nearest = book.materials()[static_cast<std::size_t>(likeliest)].name;
    }
    std::vector<AxisGiven> given;
    for (std::size_t j = 0; j < group.size(); ++j) {
      given.push_back(mean_given(data, group[j], prior, shares, library[j]));
      mean.axes[j].weights += share * given[j].weights;
      mean.axes[j].beyond += share * given[j].beyond;
      mean.axes[j].errors += share * given[j].errors;
    }
    left_out.add(given, share * shares);
  }
  for (std::size_t j = 0; j < group.size(); ++j) mean.axes[j].errors_left_out = left_out.errors(j);
  return mean;
}

// exp of the mean absolute logarithm over pairs and channels, less 1.
double relative_of(const std::array<AxisMean, kColours>& means, VectorXd AxisMean::*errors) {
  const Eigen::Index count = (means[0].*errors).size();
  double sum = 0;
  for (std::size_t c = 0; c < kRgb; ++c) {
    VectorXd of_channel = VectorXd::Zero(count);
    for (std::size_t u = 0; u < kColours; ++u) of_channel += kBookAxes[u][c] * (means[u].*errors);
    sum += of_channel.cwiseAbs().sum();
  }
  return std::expm1(sum / static_cast<double>(kRgb * static_cast<std::size_t>(count)));
}

// At most so many of all, evenly.
std::vector<std::size_t> evenly(std::size_t count, std::size_t most) {
  const std::size_t chosen = std::min(count, most);
  std::vector<std::size_t> places(chosen);
  for (std::size_t i = 0; i < chosen; ++i) places[i] = i * count / chosen;
  return places;
}

// ln(f + floor), [node][channel], by what is believed of each axis.
std::vector<double> logs_at_nodes(const MaterialBook& book, const std::vector<Place>& pairs,
                                  const std::array<AxisMean, kColours>& means) {
  std::array<std::vector<double>, kColours> weights;
  for (std::size_t u = 0; u < kColours; ++u)
    weights[u].assign(means[u].weights.begin(), means[u].weights.end());
  std::vector<double> logs = book.logs(weights);
  const std::vector<Place> places = places_of_nodes(book.layout());
  for_each_chunk(places.size(), 64, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const double like = likeness(places[n], pairs[i]);
        for (std::size_t u = 0; u < kColours; ++u)
          for (std::size_t c = 0; c < kRgb; ++c)
            logs[n * kRgb + c] += kBookAxes[u][c] * like * means[u].beyond(static_cast<Eigen::Index>(i));
      }
  });
  return logs;
}

void check_completed(const MaterialBook& book, const Samples& samples) {
  if (book.materials().empty()) throw Error("book: expected a book with materials, found none in it");
  if (!samples.isotropic || !book_takes(samples.channels))
    throw Error(
        fmt::format("book: expected pairs of an isotropic material in one channel or three, found {} in {}",
                    samples.isotropic ? "an isotropic one" : "an anisotropic one", samples.channels));
}

}  // namespace

Completion complete(const MaterialBook& book, const Samples& samples, TableFormat format) {
  check_completed(book, samples);
  const TrainingSet set = in_three_channels(training_set_of(samples, false));
  const std::vector<std::size_t> used = evenly(set.size(), kMaxCompletionPairs);

  // what to believe, from a part of the pairs where they are many
  const PairData part = pair_data(book, set, evenly(set.size(), kEvidencePairs));
  const double share = static_cast<double>(part.places.size()) / static_cast<double>(used.size());
  const std::vector<Belief> brightness = beliefs_of(part, kBrightness, share),
                            colour = beliefs_of(part, kColour, share);

  // what follows from that and all pairs
  const PairData data = pair_data(book, set, used);
  GroupMean bright = mean_of(book, data, kBrightness, brightness),
            coloured = mean_of(book, data, kColour, colour);
  const std::array means = {std::move(bright.axes[0]), std::move(coloured.axes[0]),
                            std::move(coloured.axes[1])};

  return {.brdf = brdf_of_logs(book.layout(), logs_at_nodes(book, data.places, means), format),
          .report = {.samples = set.size(),
                     .used = used.size(),
                     .materials = book.materials().size(),
                     .brightness = brightness.front().prior,
                     .colour = colour.front().prior,
                     .nearest = std::move(bright.nearest),
                     .relative = relative_of(means, &AxisMean::errors),
                     .relative_left_out = relative_of(means, &AxisMean::errors_left_out)}};
}

}  // namespace burnish
