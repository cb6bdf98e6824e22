// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/Cholesky>

#include <burnish/error.h>
#include <burnish/fitting/numerics/node_numbers.h>
#include <burnish/fitting/numerics/smoothness.h>
#include <burnish/fitting/one_lobe/normal_equations.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

using Matrix = Eigen::MatrixXd;

// A ridge that fixes what neither data nor smoothness determine, such as the share of a constant between the tables.
constexpr double kDirectRidge = 1e-7;

// Memory for the partial sums that run side by side.
constexpr std::size_t kPartialBytes = std::size_t{128} << 20;

// Samples made into rows at a time.
constexpr std::size_t kGatheredSamples = 4096;

/// Sums over samples for one matrix of the normal equations. Where a table is shared between channels, all
/// channels are the unknowns of one system. Where none is, each channel is a system of its own; they have one
/// matrix in common, with a column each on the right, if a sample's weight is the same for all channels.
struct Sums {
  Matrix upper;  ///< products of two terms, each pair once, in either triangle
  Eigen::VectorXd diagonal;
  Matrix right;
  double weight = 0;                      ///< of the samples, mean over the channels
  Eigen::ArrayXd target, target_squared;  ///< one a channel

  Sums(Eigen::Index unknowns, Eigen::Index columns, Eigen::Index channels)
      : upper(Matrix::Zero(unknowns, unknowns)),
        diagonal(Eigen::VectorXd::Zero(unknowns)),
        right(Matrix::Zero(unknowns, columns)),
        target(Eigen::ArrayXd::Zero(channels)),
        target_squared(Eigen::ArrayXd::Zero(channels)) {}

  void add(const Sums& other) {
    upper += other.upper;
    diagonal += other.diagonal;
    right += other.right;
    weight += other.weight;
    target += other.target;
    target_squared += other.target_squared;
  }
};

/// Adds samples to the sums.
class Gatherer {
 public:
  explicit Gatherer(const RowMaker& rows)
      : rows_(rows),
        uses_(rows.spec->lobes.front()),
        channels_(rows.source->channels),
        coupled_(channels_ > 1 && std::ranges::any_of(rows.spec->tables, &ModelSpec::TableSpec::shared)),
        matrices_(!coupled_ && rows.current ? channels_ : 1),
        numbering_(number_nodes(*rows.spec, coupled_ ? channels_ : 1)) {}

  bool coupled() const { return coupled_; }
  std::size_t matrices() const { return matrices_; }
  std::vector<Sums> zero() const {
    const auto channels = static_cast<Eigen::Index>(channels_ / matrices_);
    return std::vector<Sums>(
        matrices_, Sums(static_cast<Eigen::Index>(numbering_.count), coupled_ ? 1 : channels, channels));
  }
  std::size_t bytes() const { return matrices_ * numbering_.count * numbering_.count * sizeof(double); }
  /// Returns how often a table stands in the matrix.
  std::size_t copies(std::size_t table) const { return numbering_.tables[table].copies; }
  Eigen::Index index(std::size_t table, std::size_t node, std::size_t copy) const {
    return static_cast<Eigen::Index>(numbering_.tables[table](node, copy));
  }

  std::size_t add(std::size_t begin, std::size_t end, std::vector<Sums>& sums) const {
    // Each sample adds weight * a a^T to the matrix and weight * a * target to the right side; a are its row's
    // weights [HomomorphicBrdf, eq. 5].
    const LogRows rows = rows_.make(begin, end);
    std::vector<Term> terms(8 * uses_.size());
    const std::size_t step = rows.weight_channels;
    for (std::size_t i = 0; i < rows.size; ++i) {
      const std::span<const Term> row = find_terms(rows, i, terms);
      const float* weight = rows.weight.data() + i * step;
      const float* target = rows.target.data() + i * channels_;
      for (std::size_t c = 0; c < channels_; ++c) {
        Sums& s = sums[matrices_ == 1 ? 0 : c];
        const double w = weight[step == 1 ? 0 : c];
        const auto column = static_cast<Eigen::Index>(matrices_ == 1 ? c : 0);
        s.weight += w * static_cast<double>(matrices_) / static_cast<double>(channels_);
        s.target[column] += w * target[c];
        s.target_squared[column] += w * target[c] * target[c];
      }
      if (!coupled_ && step == 1)
        add_row(row, weight[0], 0, target, sums[0]);
      else
        for (std::size_t c = 0; c < channels_; ++c)
          add_row(row, weight[step == 1 ? 0 : c], c, target + c, sums[matrices_ == 1 ? 0 : c]);
    }
    return rows.size;
  }

 private:
  /// One texel of a row, with its weight in the row.
  struct Term {
    std::size_t index;
    bool per_channel;
    double weight;
  };

  void add_row(std::span<const Term> row, double weight, std::size_t copy, const float* target,
               Sums& sums) const {
    const auto place = [&](const Term& t) {
      return static_cast<Eigen::Index>(t.index + (t.per_channel ? copy : 0));
    };
    for (std::size_t a = 0; a < row.size(); ++a) {
      // Each product of two terms is added once, on either side of the diagonal; solve() adds the transpose.
      const Eigen::Index at = place(row[a]);
      const double wa = weight * row[a].weight;
      for (Eigen::Index c = 0; c < sums.right.cols(); ++c) sums.right(at, c) += wa * target[c];
      sums.diagonal[at] += wa * row[a].weight;
      double* column = sums.upper.col(at).data();
      for (std::size_t b = a + 1; b < row.size(); ++b) column[place(row[b])] += wa * row[b].weight;
    }
  }

  std::span<const Term> find_terms(const LogRows& rows, std::size_t i, std::vector<Term>& terms) const {
    // The terms are the 2, 4 or 8 texels of each lookup with their weights of linear interpolation.
    std::size_t count = 0;
    for (std::size_t k = 0; k < uses_.size(); ++k) {
      const auto t = uses_[k].table;
      const TableLayout& layout = rows_.spec->tables[t].layout;
      const std::size_t at = i * uses_.size() + k, node = rows.node[at];
      const double fx = rows.fx[at], fy = rows.fy[at], fz = rows.fz[at];
      const auto push = [&](std::size_t n, double weight) {
        const NodeNumbers& numbers = numbering_.tables[t];
        terms[count++] = {numbers(n, 0), numbers.copies > 1, weight};
      };
      const auto width = static_cast<std::size_t>(layout.width);
      const int axes = axis_count(layout.shape);
      const auto push_layer = [&](std::size_t n, double share) {
        push(n, (1 - fx) * (1 - fy) * share);
        push(n + 1, fx * (1 - fy) * share);
        if (axes == 1) return;
        push(n + width, (1 - fx) * fy * share);
        push(n + width + 1, fx * fy * share);
      };
      push_layer(node, 1 - fz);
      if (axes == 3) push_layer(node + width * static_cast<std::size_t>(layout.height), fz);
    }
    return {terms.data(), count};
  }

  const RowMaker& rows_;
  const std::vector<FactorUse>& uses_;
  std::size_t channels_;
  bool coupled_;
  std::size_t matrices_;
  Numbering numbering_;  ///< of one matrix
};

// Adds smooth * share * (roughness of every table) to the matrix.
void add_smoothness(const ModelSpec& spec, const Gatherer& gatherer, double smooth, Matrix& matrix) {
  for (std::size_t t = 0; t < spec.tables.size(); ++t) {
    const ModelSpec::TableSpec& table = spec.tables[t];
    const SmoothnessRows rows = smoothness_rows(table.layout, {table.even_y, table.pole_x, table.circle_z});
    for (std::size_t copy = 0; copy < gatherer.copies(t); ++copy)
      for (std::size_t r = 0; r < rows.size(); ++r)
        for (std::size_t a = rows.starts[r]; a < rows.starts[r + 1]; ++a)
          for (std::size_t b = rows.starts[r]; b < rows.starts[r + 1]; ++b)
            matrix(gatherer.index(t, rows.nodes[a], copy), gatherer.index(t, rows.nodes[b], copy)) +=
                smooth * spec.tables[t].smooth_share * rows.coefficients[a] * rows.coefficients[b];
  }
}

/// Solution of one matrix: a column for each on the right, and the weighted squares of its rows' targets about
/// their mean and about the solution, with their weight.
struct Solved {
  Matrix x;
  double before = 0, after = 0, weight = 0;
};

Solved solve(const Sums& sum, const ModelSpec& spec, const Gatherer& gatherer, double smooth) {
  if (!(sum.weight > 0)) throw Error("fit: expected samples with a weight above 0, found none");

  // The matrix is the mean over the samples, plus the smoothness and a ridge.
  Matrix data = (sum.upper + sum.upper.transpose()) / sum.weight;
  data.diagonal() += sum.diagonal / sum.weight;
  const Matrix right = sum.right / sum.weight;
  Matrix matrix = data;
  add_smoothness(spec, gatherer, smooth, matrix);
  matrix.diagonal().array() += kDirectRidge * matrix.trace() / static_cast<double>(matrix.rows());
  Solved solved{.x = matrix.ldlt().solve(right)};

  // The error is found from the sums alone: sum over rows of (A x - t)^2 = x A^T A x - 2 x A^T t + t^2.
  const Matrix& x = solved.x;
  const Eigen::ArrayXd mean = sum.target / sum.weight, mean_square = sum.target_squared / sum.weight;
  solved.before = sum.weight * (mean_square - mean * mean).sum();
  solved.after =
      sum.weight * ((x.cwiseProduct(data * x) - 2 * x.cwiseProduct(right)).sum() + mean_square.sum());
  solved.weight = sum.weight * static_cast<double>(mean.size());
  return solved;
}

}  // namespace

LogSolution solve_normal_equations(const RowMaker& rows, const HomomorphicOptions& options) {
  const Gatherer gatherer(rows);
  const auto channels = rows.source->channels;

  // Each group of samples has a partial sum; these are joined in order, whatever the number of threads.
  const std::size_t groups = std::clamp<std::size_t>(kPartialBytes / gatherer.bytes(), 2, 32);
  const std::size_t group_size = std::max(kGatheredSamples, (rows.source->count + groups - 1) / groups);
  std::vector<std::vector<Sums>> partial(chunk_count(rows.source->count, group_size));
  std::vector<std::size_t> samples(partial.size());
  for_each_chunk(rows.source->count, group_size, [&](std::size_t group, std::size_t begin, std::size_t end) {
    partial[group] = gatherer.zero();
    for (std::size_t at = begin; at < end; at += kGatheredSamples)
      samples[group] += gatherer.add(at, std::min(end, at + kGatheredSamples), partial[group]);
  });

  const Numbering all = number_nodes(*rows.spec, channels);
  LogSolution solution{.log_values = std::vector<double>(all.count),
                       .channel_offset = std::vector<double>(channels),
                       .summary = {.stop_reason = StopReason::direct_solution}};
  for (const std::size_t s : samples) solution.samples += s;
  // Each matrix is summed and solved by itself.
  std::vector<Solved> solved(gatherer.matrices());
  for_each_chunk(gatherer.matrices(), 1, [&](std::size_t m, std::size_t, std::size_t) {
    Sums& sum = partial.front()[m];
    for (std::size_t g = 1; g < partial.size(); ++g) sum.add(partial[g][m]);
    solved[m] = solve(sum, *rows.spec, gatherer, options.smooth);
  });

  double before = 0, after = 0, weight = 0;
  for (std::size_t m = 0; m < gatherer.matrices(); ++m) {
    const Matrix& x = solved[m].x;
    before += solved[m].before;
    after += solved[m].after;
    weight += solved[m].weight;

    // The unknowns are copied to their places among those of all channels.
    for (std::size_t t = 0; t < rows.spec->tables.size(); ++t)
      for (std::size_t node = 0; node < rows.spec->tables[t].layout.node_count(); ++node)
        for (std::size_t c = 0; c < all.tables[t].copies; ++c)
          if (gatherer.matrices() == 1 || c == m)
            solution.log_values[all.tables[t](node, c)] =
                gatherer.coupled() ? x(gatherer.index(t, node, c), 0)
                                   : x(gatherer.index(t, node, 0),
                                       static_cast<Eigen::Index>(gatherer.matrices() == 1 ? c : 0));
  }
  solution.summary.error_before = std::sqrt(std::max(0.0, before / weight));
  solution.summary.error_after = std::sqrt(std::max(0.0, after / weight));
  return solution;
}

}  // namespace burnish
