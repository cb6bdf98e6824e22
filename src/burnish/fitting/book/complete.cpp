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

// What is tried: near one of the library's materials, or near their mean, where far out is allowed.
constexpr std::array kNearSpreads = {0.1, 0.2, 0.4, 0.7}, kMeanSpreads = {1.0, 2.0, 4.0, 8.0};
constexpr std::array kResiduals = {0.1, 1.0, 10.0, 100.0}, kNoises = {1e-4, 1e-3, 1e-2, 1e-1};

// How far what is not in the book reaches: along sqrt(theta_h / (pi/2)), theta_d / (pi/2) and
// |cos theta_i - cos theta_o| / 2.
constexpr std::array kReach = {0.15, 0.25, 0.25};

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
  return std::exp(-0.5 * distance2);
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
  for (const std::size_t i : chosen) data.places.push_back(place_of(set.pairs[i]));
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

Eigen::LLT<MatrixXd> factored(const AxisData& axis, const MatrixXd& likenesses,
                              const CompletionPrior& prior) {
  const MatrixXd spread = axis.components * (prior.spread * axis.deviations).asDiagonal();
  MatrixXd covariance = spread * spread.transpose() + prior.residual * axis.residual2 * likenesses;
  covariance.diagonal().array() += prior.noise;
  return Eigen::LLT<MatrixXd>(std::move(covariance));
}

/// How likely pairs are by a prior, of one material each where it is near one: logarithms less a constant.
VectorXd log_evidences(const AxisData& axis, const MatrixXd& likenesses, const CompletionPrior& prior) {
  const Eigen::LLT<MatrixXd> llt = factored(axis, likenesses, prior);
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
  VectorXd sum = log_evidences(data.axes[group.front()], data.likenesses, prior);
  for (const std::size_t u : group.subspan(1)) sum += log_evidences(data.axes[u], data.likenesses, prior);
  return sum;
}

CompletionPrior likeliest_prior(const PairData& data, AxisGroup group) {
  const std::vector<CompletionPrior> all = priors();
  std::vector<double> evidence(all.size());
  for_each_chunk(all.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
    evidence[k] = log_mean(group_evidences(data, group, all[k]));
  });
  return all[static_cast<std::size_t>(std::ranges::max_element(evidence) - evidence.begin())];
}

/// What the pairs say of one axis: weights, and what is not in the book, as a sum of likenesses to the pairs.
struct AxisMean {
  std::vector<double> weights;
  VectorXd beyond;
  VectorXd errors, errors_left_out;  // of each pair, by what all say and by what the others say
};

AxisMean mean_given(const PairData& data, std::size_t u, const CompletionPrior& prior, const VectorXd& shares,
                    const MatrixXd& weights_of_library) {
  const AxisData& axis = data.axes[u];
  VectorXd centre = VectorXd::Zero(axis.components.cols()), left = axis.values;
  if (prior.near_one) {
    centre = weights_of_library * shares;
    left -= axis.library * shares;
  }
  const Eigen::LLT<MatrixXd> llt = factored(axis, data.likenesses, prior);
  const VectorXd solved = llt.solve(left);
  const VectorXd variances = (prior.spread * axis.deviations).array().square();
  const VectorXd weights = centre + variances.cwiseProduct(axis.components.transpose() * solved);
  // the pair that is left out: [Rasmussen 2006, eq. 5.12]
  const MatrixXd inverse = llt.solve(MatrixXd::Identity(left.size(), left.size()));
  return {.weights = {weights.begin(), weights.end()},
          .beyond = prior.residual * axis.residual2 * solved,
          .errors = prior.noise * solved,
          .errors_left_out = solved.cwiseQuotient(inverse.diagonal())};
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

void check_completed(const MaterialBook& book, const Samples& samples) {
  if (book.materials().empty()) throw Error("book: expected materials in it, found none");
  if (!samples.isotropic || !book_takes(samples.channels))
    throw Error(
        fmt::format("book: expected pairs of an isotropic material in one channel or three, found {} in {}",
                    samples.isotropic ? "an isotropic one" : "an anisotropic one", samples.channels));
}

}  // namespace

Completion complete(const MaterialBook& book, const Samples& samples, TableFormat format) {
  check_completed(book, samples);
  const TrainingSet set = in_three_channels(training_set_of(samples, false));
  const std::vector<std::size_t> used = evenly(set.size(), kMostCompletionPairs);

  // what to believe, from a part of the pairs where they are many
  const PairData part = pair_data(book, set, evenly(set.size(), kEvidencePairs));
  const CompletionPrior brightness = likeliest_prior(part, kBrightness),
                        colour = likeliest_prior(part, kColour);

  // what follows from that and all pairs
  const PairData data = pair_data(book, set, used);
  std::array<AxisMean, kColours> means;
  std::string nearest;
  for (const AxisGroup group : {AxisGroup(kBrightness), AxisGroup(kColour)}) {
    const CompletionPrior& prior = group.size() == 1 ? brightness : colour;
    VectorXd shares;
    if (prior.near_one) {
      const VectorXd evidences = group_evidences(data, group, prior);
      shares = (evidences.array() - evidences.maxCoeff()).exp();
      shares /= shares.sum();
      Eigen::Index likeliest = 0;
      shares.maxCoeff(&likeliest);
      if (group.size() == 1) nearest = book.materials()[static_cast<std::size_t>(likeliest)].name;
    }
    for (const std::size_t u : group) means[u] = mean_given(data, u, prior, shares, library_weights(book, u));
  }

  // at the nodes
  std::vector<double> logs = book.logs({means[0].weights, means[1].weights, means[2].weights});
  const std::vector<Place> places = places_of_nodes(book.layout());
  for_each_chunk(places.size(), 64, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      for (std::size_t i = 0; i < used.size(); ++i) {
        const double like = likeness(places[n], data.places[i]);
        for (std::size_t u = 0; u < kColours; ++u)
          for (std::size_t c = 0; c < kRgb; ++c)
            logs[n * kRgb + c] += kBookAxes[u][c] * like * means[u].beyond(static_cast<Eigen::Index>(i));
      }
  });
  return {.brdf = brdf_of_logs(book.layout(), logs, format),
          .report = {.samples = set.size(),
                     .used = used.size(),
                     .materials = book.materials().size(),
                     .brightness = brightness,
                     .colour = colour,
                     .nearest = std::move(nearest),
                     .relative = relative_of(means, &AxisMean::errors),
                     .relative_left_out = relative_of(means, &AxisMean::errors_left_out)}};
}

}  // namespace burnish
