// SPDX-License-Identifier: Apache-2.0
#pragma once

// Helpers of the tests of one-lobe solvers: log-linear problems, and the distance of a solution from the minimum.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/fitting/numerics/node_numbers.h>
#include <burnish/fitting/numerics/smoothness.h>
#include <burnish/fitting/one_lobe/log_rows.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish::fixtures {

/// Returns random values and weights; some samples have no weight.
inline SampleSource random_log_source(std::size_t count, std::size_t channels) {
  SampleSource source{.count = count, .distinct = count, .channels = channels, .isotropic = true, .fill = {}};
  source.fill = [all = draw_pairs(count, 3, false), channels](
                    std::size_t begin, std::span<DirectionPair> pairs, std::span<double> values,
                    std::span<double> weights) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      Pcg32 random(begin + i);
      pairs[i] = all[begin + i];
      for (std::size_t c = 0; c < channels; ++c)
        values[i * channels + c] = std::exp(2 * random.uniform() - static_cast<double>(c));
      weights[i] = random.next() % 5 == 0 ? 0 : 0.2 + random.uniform();
    }
  };
  return source;
}

/// The objective that HomomorphicOptions::smooth states: its slopes by the unknowns, at x and at 0, and the weighted
/// rms of the rows' errors at x. Each row has one weight for all channels.
struct LogObjective {
  std::vector<double> slope, slope_at_zero;
  double rms = 0;
};
inline LogObjective log_objective(const RowMaker& maker, const LogSolution& solution, double smooth) {
  const ModelSpec& spec = *maker.spec;
  const std::size_t channels = maker.source->channels;
  const LogRows rows = maker.make(0, maker.source->count);
  const Numbering numbering = number_nodes(spec, channels);
  LogObjective found{std::vector<double>(numbering.count), std::vector<double>(numbering.count), 0};
  double total = 0;
  for (std::size_t i = 0; i < rows.size; ++i) total += static_cast<double>(rows.weight[i]);
  const std::vector<FactorUse>& uses = spec.lobes.front();
  for (std::size_t i = 0; i < rows.size; ++i)
    for (std::size_t c = 0; c < channels; ++c) {
      // A lookup has two nodes in a line and four in a disk, some of weight 0.
      std::vector<std::pair<std::size_t, double>> row;
      for (std::size_t k = 0; k < uses.size(); ++k) {
        const TableLayout& layout = spec.tables[uses[k].table].layout;
        const std::size_t at = i * uses.size() + k;
        const double fx = static_cast<double>(rows.fx[at]), fy = static_cast<double>(rows.fy[at]);
        for (int corner = 0; corner < (layout.height > 1 ? 4 : 2); ++corner)
          row.emplace_back(
              numbering.tables[uses[k].table](
                  rows.node[at] + static_cast<std::size_t>(corner % 2 + corner / 2 * layout.width), c),
              (corner % 2 ? fx : 1 - fx) * (corner / 2 ? fy : 1 - fy));
      }
      const double weight = static_cast<double>(rows.weight[i]) / total,
                   target = static_cast<double>(rows.target[i * channels + c]) - solution.channel_offset[c];
      double error = -target;
      for (const auto& [node, share] : row) error += share * solution.log_values[node];
      for (const auto& [node, share] : row) {
        found.slope[node] += weight * share * error;
        found.slope_at_zero[node] -= weight * share * target;
      }
      found.rms += weight * error * error / static_cast<double>(channels);
    }
  found.rms = std::sqrt(found.rms);
  for (std::size_t t = 0; t < spec.tables.size(); ++t) {
    const SmoothnessRows rough = smoothness_rows(spec.tables[t].layout);
    for (std::size_t r = 0; r < rough.size(); ++r)
      for (std::size_t c = 0; c < numbering.tables[t].copies; ++c) {
        double bend = 0;
        for (std::size_t k = rough.starts[r]; k < rough.starts[r + 1]; ++k)
          bend += rough.coefficients[k] * solution.log_values[numbering.tables[t](rough.nodes[k], c)];
        for (std::size_t k = rough.starts[r]; k < rough.starts[r + 1]; ++k)
          found.slope[numbering.tables[t](rough.nodes[k], c)] +=
              smooth * spec.tables[t].smooth_share * rough.coefficients[k] * bend;
      }
  }
  return found;
}

inline double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

struct LogCase {
  const char* expression;
  std::vector<std::string> tables;
  std::size_t channels;
};
inline const LogCase kLogCases[] = {{"p(wo) q(h) p(wi)", {"p=6", "q=9"}, 1},
                                    {"p(wo) q(h) p(wi)", {"p=6,shared", "q=9"}, 3},
                                    {"p(wo) q(h) p(wi) r(theta_d)", {"p=5x5", "q=9", "r=4,shared"}, 5}};

/// Distance from the minimum at which a solver may end: its slope as a share of the slope at 0, and a share of the rms.
struct LogTolerance {
  double slope, rms;
};

/// Expects that solve(rows) ends at the minimum of the objective in every case of kLogCases, and gives `reason`.
template <class Solve>
void expect_least(std::size_t samples, const Solve& solve, double smooth, LogTolerance tolerance,
                  StopReason reason) {
  for (const auto& [expression, tables, channels] : kLogCases) {
    const ModelSpec spec = parse_model_spec(expression, tables, true);
    const SampleSource source = random_log_source(samples, channels);
    const RowMaker rows(source, spec, 1e-3, 1e-3);
    const LogSolution found = solve(rows);
    EXPECT_EQ(found.samples, rows.make(0, source.count).size);
    EXPECT_EQ(found.summary.stop_reason, reason) << expression;
    const LogObjective at = log_objective(rows, found, smooth);
    EXPECT_LT(largest(at.slope), tolerance.slope * largest(at.slope_at_zero)) << expression;
    EXPECT_NEAR(found.summary.error_after, at.rms, tolerance.rms * at.rms) << expression;
    EXPECT_LT(found.summary.error_after, found.summary.error_before) << expression;
  }
}

}  // namespace burnish::fixtures
