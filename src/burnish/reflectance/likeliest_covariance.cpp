// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <burnish/math/parallel.h>
#include <burnish/reflectance/likeliest_covariance.h>

namespace burnish {

namespace {

constexpr std::size_t kTerms = LogCovariance::kTerms, kAxes = LogCovariance::kAxes;

// The search for the likeliest parameters, which are logarithms.
constexpr int kSteps = 40;
constexpr double kPrior = 1;  // weight of the square of a parameter's distance from its start
constexpr double kReach = 4;  // the largest such distance
constexpr double kFirstStep = 0.1, kLargestStep = 0.5, kSmallestStep = 1e-3;
constexpr double kFaster = 1.2, kSlower = 0.5;  // [Riedmiller 1993]

/// The parameters: the level, a spread for each term, a length for each coordinate that a term sees, and the noise.
constexpr std::size_t kMaxParameters = 1 + kTerms + kTerms * kAxes + 1;
using Parameters = std::array<double, kMaxParameters>;

/// The numbers of the parameters. A term has a length for each coordinate that the default gives one.
struct ParameterNumbers {
  bool isotropic;
  std::array<std::array<bool, kAxes>, kTerms> sees{};
  std::array<std::array<std::size_t, kAxes>, kTerms> length{};
  std::size_t noise = 0, count = 0;

  explicit ParameterNumbers(bool of_isotropic) noexcept : isotropic(of_isotropic) {
    const LogCovariance start(isotropic);
    std::size_t next = 1 + kTerms;
    for (std::size_t t = 0; t < kTerms; ++t)
      for (std::size_t k = 0; k < kAxes; ++k)
        if (start.inverse_length[t][k] > 0) {
          sees[t][k] = true;
          length[t][k] = next++;
        }
    noise = next++;
    count = next;
  }

  Parameters logs_of(const LogCovariance& covariance) const noexcept {
    Parameters logs{};
    logs[0] = std::log(covariance.level);
    for (std::size_t t = 0; t < kTerms; ++t) {
      logs[1 + t] = std::log(covariance.spread[t]);
      for (std::size_t k = 0; k < kAxes; ++k)
        if (sees[t][k]) logs[length[t][k]] = -std::log(covariance.inverse_length[t][k]);
    }
    logs[noise] = std::log(covariance.noise);
    return logs;
  }

  LogCovariance covariance_of(const Parameters& logs) const noexcept {
    LogCovariance covariance(isotropic);
    covariance.level = std::exp(logs[0]);
    for (std::size_t t = 0; t < kTerms; ++t) {
      covariance.spread[t] = std::exp(logs[1 + t]);
      for (std::size_t k = 0; k < kAxes; ++k)
        if (sees[t][k]) covariance.inverse_length[t][k] = std::exp(-logs[length[t][k]]);
    }
    covariance.noise = std::exp(logs[noise]);
    return covariance;
  }
};

/// The negative log likelihood, and its derivatives by the parameters.
struct Likelihood {
  double value = 0;
  Parameters gradient{};
};

/// Computes the likelihood of one block. Channels are independent and have the same covariance K:
///   sum_c 1/2 y_c^T K^-1 y_c + channels/2 ln det K,
/// and the derivative by a parameter is 1/2 tr(W dK), W = channels K^-1 - sum_c (K^-1 y_c)(K^-1 y_c)^T [Rasmussen
/// 2006, eq. 5.8 and 5.9].
Likelihood likelihood_of(const LogMeasurements& measured, std::span<const std::size_t> block,
                         const LogCovariance& covariance, const ParameterNumbers& numbering) {
  const auto n = static_cast<Eigen::Index>(block.size());
  const auto channels = static_cast<Eigen::Index>(measured.channels);
  const double level2 = covariance.level * covariance.level, noise2 = covariance.noise * covariance.noise;
  const auto place = [&](Eigen::Index i) -> const TreePoint& {
    return measured.places[block[static_cast<std::size_t>(i)]];
  };
  const auto squares = [&](Eigen::Index i, Eigen::Index j, std::size_t t) {
    TreePoint parts{};
    for (std::size_t k = 0; k < kAxes; ++k) {
      const double d = (place(i)[k] - place(j)[k]) * covariance.inverse_length[t][k];
      parts[k] = d * d;
    }
    return parts;
  };

  // The grazing term has no parameters here.
  const auto grazing = [&](Eigen::Index i) {
    return measured.grazing.empty() ? 0.0 : measured.grazing[block[static_cast<std::size_t>(i)]];
  };

  // K is filled with the covariances. Each term's spread^2 exp(-sqrt(3) r) is kept for the derivatives.
  Eigen::MatrixXd matrix(n, n), right(n, channels);
  std::array<Eigen::MatrixXd, kTerms> decay;
  for (Eigen::MatrixXd& of_term : decay) of_term.resize(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j; i < n; ++i) {
      double sum = level2 + covariance.grazing_between(place(i), grazing(i), place(j), grazing(j));
      for (std::size_t t = 0; t < kTerms; ++t) {
        const TreePoint d2 = squares(i, j, t);
        const double r = LogCovariance::kRoot3 * std::sqrt(d2[0] + d2[1] + d2[2] + d2[3]);
        decay[t](i, j) = covariance.spread[t] * covariance.spread[t] * std::exp(-r);
        sum += (1 + r) * decay[t](i, j);
      }
      matrix(i, j) = sum;
    }
    const std::size_t node = block[static_cast<std::size_t>(j)];
    matrix(j, j) += noise2 * measured.variances[node];
    for (Eigen::Index c = 0; c < channels; ++c)
      right(j, c) = measured.logs[node * measured.channels + static_cast<std::size_t>(c)];
  }
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor(matrix);
  Likelihood result;
  if (factor.info() != Eigen::Success) {
    result.value = std::numeric_limits<double>::infinity();
    return result;
  }
  // With K = L L^T, the value is half of y . K^-1 y, plus the sum of ln L_ii for each channel.
  const Eigen::MatrixXd solved = factor.solve(right);
  result.value = 0.5 * solved.cwiseProduct(right).sum();
  for (Eigen::Index i = 0; i < n; ++i)
    result.value += static_cast<double>(channels) * std::log(factor.matrixLLT()(i, i));

  // Parameters are logarithms. The derivative of m(r) by that of a length is 3 d^2 exp(-sqrt(3) r), where d is the
  // part of r along it; by that of a spread it doubles the term.
  Eigen::MatrixXd w = factor.solve(Eigen::MatrixXd::Identity(n, n)) * static_cast<double>(channels);
  w.noalias() -= solved * solved.transpose();
  Parameters& gradient = result.gradient;
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j; i < n; ++i) {
      const double by = i == j ? 0.5 * w(i, j) : w(i, j);  // both triangles count
      gradient[0] += by * 2 * level2;
      for (std::size_t t = 0; t < kTerms; ++t) {
        const TreePoint d2 = squares(i, j, t);
        const double r = LogCovariance::kRoot3 * std::sqrt(d2[0] + d2[1] + d2[2] + d2[3]);
        gradient[1 + t] += by * 2 * (1 + r) * decay[t](i, j);
        for (std::size_t k = 0; k < kAxes; ++k)
          if (numbering.sees[t][k]) gradient[numbering.length[t][k]] += by * 3 * d2[k] * decay[t](i, j);
      }
    }
    gradient[numbering.noise] += w(j, j) * noise2 * measured.variances[block[static_cast<std::size_t>(j)]];
  }
  return result;
}

}  // namespace

LogCovariance likeliest_covariance(const LogMeasurements& measured,
                                   std::span<const std::vector<std::size_t>> blocks, bool isotropic) {
  const ParameterNumbers numbering(isotropic);
  const Parameters start = numbering.logs_of(LogCovariance(isotropic));
  Parameters at = start, before{}, steps, best = start;
  steps.fill(kFirstStep);
  double smallest = std::numeric_limits<double>::infinity();
  std::vector<Likelihood> of_blocks(blocks.size());
  for (int step = 0; step < kSteps; ++step) {
    // The likelihoods of the blocks are summed in their order.
    const LogCovariance covariance = numbering.covariance_of(at);
    for_each_chunk(blocks.size(), 1, [&](std::size_t b, std::size_t, std::size_t) {
      of_blocks[b] = likelihood_of(measured, blocks[b], covariance, numbering);
    });
    Likelihood sum;
    for (const Likelihood& of_block : of_blocks) {
      sum.value += of_block.value;
      for (std::size_t k = 0; k < numbering.count; ++k) sum.gradient[k] += of_block.gradient[k];
    }
    for (std::size_t k = 0; k < numbering.count; ++k) {
      // A prior pulls each parameter to its start.
      const double far = at[k] - start[k];
      sum.value += kPrior * far * far;
      sum.gradient[k] += 2 * kPrior * far;
    }
    if (sum.value < smallest) {
      smallest = sum.value;
      best = at;
    }
    // A step grows while the gradient keeps its sign, and shrinks where it changes [Riedmiller 1993].
    for (std::size_t k = 0; k < numbering.count; ++k) {
      double slope = sum.gradient[k];
      if (slope * before[k] > 0) steps[k] = std::min(kFaster * steps[k], kLargestStep);
      if (slope * before[k] < 0) {
        steps[k] = std::max(kSlower * steps[k], kSmallestStep);
        slope = 0;
      }
      at[k] -= slope > 0 ? steps[k] : slope < 0 ? -steps[k] : 0;
      at[k] = std::clamp(at[k], start[k] - kReach, start[k] + kReach);
      before[k] = slope;
    }
  }
  return numbering.covariance_of(best);
}

}  // namespace burnish
