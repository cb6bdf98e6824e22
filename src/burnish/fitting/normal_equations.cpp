#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include <burnish/error.h>
#include <burnish/fitting/log_rows.h>
#include <burnish/fitting/smoothness.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// Pins what neither data nor smoothness determine (the share of a constant between the tables).
constexpr double kRidge = 1e-10;

// Memory for the partial sums that run side by side.
constexpr std::size_t kPartialBytes = std::size_t{128} << 20;

/// Sums over samples of one independent system of equations.
struct Sums {
  Matrix upper;  // products of different terms, at (row, column) in either order, once
  Vector diagonal, right;
  double weight = 0, target = 0, target_squared = 0;

  explicit Sums(Eigen::Index n)
      : upper(Matrix::Zero(n, n)), diagonal(Vector::Zero(n)), right(Vector::Zero(n)) {}
};

/// One texel of a row: its place within a system of a channel (without coupling) or of all channels.
struct Term {
  std::size_t index, channels;
  float weight;
};

class Gatherer {
 public:
  Gatherer(const RowMaker& rows, const Unknowns& unknowns)
      : rows_(rows),
        uses_(rows.spec->lobes.front()),
        channels_(static_cast<std::size_t>(rows.source->channels)) {
    for (std::size_t t = 0; t < rows.spec->tables.size(); ++t) {
      coupled_ = coupled_ || (channels_ > 1 && unknowns.channels[t] == 1);
      node_base_.push_back(nodes_);
      nodes_ += rows.spec->tables[t].layout.node_count();
    }
    systems_ = coupled_ ? 1 : channels_;
    size_ = coupled_ ? unknowns.count : nodes_;
    for (std::size_t t = 0; t < rows.spec->tables.size(); ++t) {
      base_.push_back(coupled_ ? unknowns.base[t] : node_base_[t]);
      stride_.push_back(coupled_ ? unknowns.channels[t] : 1);
    }
  }

  std::size_t systems() const { return systems_; }
  std::size_t size() const { return size_; }
  /// Index of a table's node and channel in its system.
  std::size_t index(std::size_t table, std::size_t node, std::size_t channel) const {
    return base_[table] + node * stride_[table] + (stride_[table] > 1 ? channel : 0);
  }

  void add(std::size_t begin, std::size_t end, std::vector<Sums>& sums, std::size_t& samples) const {
    const LogRows rows = rows_.make(begin, end);
    samples += rows.size;
    std::vector<Term> terms(4 * uses_.size());
    for (std::size_t i = 0; i < rows.size; ++i) {
      const std::size_t count = find_terms(rows, i, terms);
      for (std::size_t c = 0; c < channels_; ++c) {
        Sums& s = sums[coupled_ ? 0 : c];
        const double weight = rows.weight[i * channels_ + c], target = rows.target[i * channels_ + c];
        s.weight += weight;
        s.target += weight * target;
        s.target_squared += weight * target * target;
        for (std::size_t a = 0; a < count; ++a) {
          const auto row = static_cast<Eigen::Index>(terms[a].index + (terms[a].channels > 1 ? c : 0));
          const double wa = weight * terms[a].weight;
          s.right[row] += wa * target;
          s.diagonal[row] += wa * terms[a].weight;
          double* column = s.upper.col(row).data();
          for (std::size_t b = a + 1; b < count; ++b)
            column[terms[b].index + (terms[b].channels > 1 ? c : 0)] += wa * terms[b].weight;
        }
      }
    }
  }

 private:
  std::size_t find_terms(const LogRows& rows, std::size_t i, std::vector<Term>& terms) const {
    std::size_t count = 0;
    for (std::size_t k = 0; k < uses_.size(); ++k) {
      const auto t = static_cast<std::size_t>(uses_[k].table);
      const TableLayout& layout = rows_.spec->tables[t].layout;
      const std::size_t at = i * uses_.size() + k, node = rows.node[at];
      const float fx = rows.fx[at], fy = rows.fy[at];
      const auto push = [&](std::size_t n, float weight) {
        terms[count++] = {base_[t] + n * stride_[t], stride_[t], weight};
      };
      push(node, (1 - fx) * (1 - fy));
      push(node + 1, fx * (1 - fy));
      if (layout.shape == TableShape::line) continue;
      push(node + static_cast<std::size_t>(layout.width), (1 - fx) * fy);
      push(node + static_cast<std::size_t>(layout.width) + 1, fx * fy);
    }
    return count;
  }

  const RowMaker& rows_;
  const std::vector<FactorUse>& uses_;
  std::size_t channels_, nodes_ = 0, systems_ = 1, size_ = 0;
  bool coupled_ = false;
  std::vector<std::size_t> node_base_, base_, stride_;
};

}  // namespace

LogSolution solve_directly(const RowMaker& rows, const Unknowns& unknowns,
                           const HomomorphicOptions& options) {
  const Gatherer gatherer(rows, unknowns);
  const auto n = static_cast<Eigen::Index>(gatherer.size());
  const auto channels = static_cast<std::size_t>(rows.source->channels);

  // One partial sum a group of samples, joined in order.
  constexpr std::size_t kBlock = 4096;
  const std::size_t bytes = gatherer.systems() * gatherer.size() * gatherer.size() * sizeof(double);
  const std::size_t groups = std::clamp<std::size_t>(kPartialBytes / bytes, 2, 32);
  const std::size_t group_size = std::max(kBlock, (rows.source->count + groups - 1) / groups);
  std::vector<std::vector<Sums>> partial(chunk_count(rows.source->count, group_size));
  std::vector<std::size_t> samples(partial.size());
  for_each_chunk(rows.source->count, group_size, [&](std::size_t group, std::size_t begin, std::size_t end) {
    partial[group].assign(gatherer.systems(), Sums(n));
    for (std::size_t at = begin; at < end; at += kBlock)
      gatherer.add(at, std::min(end, at + kBlock), partial[group], samples[group]);
  });

  LogSolution solution{.log_values = std::vector<double>(unknowns.count),
                       .channel_offset = std::vector<double>(channels),
                       .stop_reason = "direct solution"};
  for (const std::size_t s : samples) solution.samples += s;
  double before = 0, after = 0, weight = 0;
  for (std::size_t system = 0; system < gatherer.systems(); ++system) {
    Sums sum = std::move(partial.front()[system]);
    for (std::size_t g = 1; g < partial.size(); ++g) {
      const Sums& part = partial[g][system];
      sum.upper += part.upper;
      sum.diagonal += part.diagonal;
      sum.right += part.right;
      sum.weight += part.weight;
      sum.target += part.target;
      sum.target_squared += part.target_squared;
    }
    if (!(sum.weight > 0)) throw Error("fit: expected samples with weight, found none");
    // the mean weight of a channel is one unit of data
    const double unit = gatherer.systems() == 1 ? sum.weight / static_cast<double>(channels) : sum.weight;
    Matrix data = (sum.upper + sum.upper.transpose()) / unit;
    data.diagonal() += sum.diagonal / unit;
    const Vector right = sum.right / unit;

    Matrix matrix = data;
    for (std::size_t t = 0; t < rows.spec->tables.size(); ++t) {
      const SmoothnessRows smoothness = smoothness_rows(rows.spec->tables[t].layout);
      const std::size_t copies = gatherer.systems() == 1 ? unknowns.channels[t] : 1;
      for (std::size_t c = 0; c < copies; ++c)
        for (std::size_t r = 0; r < smoothness.size(); ++r)
          for (std::size_t a = smoothness.starts[r]; a < smoothness.starts[r + 1]; ++a)
            for (std::size_t b = smoothness.starts[r]; b < smoothness.starts[r + 1]; ++b)
              matrix(static_cast<Eigen::Index>(gatherer.index(t, smoothness.nodes[a], c)),
                     static_cast<Eigen::Index>(gatherer.index(t, smoothness.nodes[b], c))) +=
                  options.smooth * smoothness.coefficients[a] * smoothness.coefficients[b];
    }
    matrix.diagonal().array() += kRidge * matrix.trace() / static_cast<double>(n);

    const Vector x = matrix.ldlt().solve(right);
    const double mean = sum.target / sum.weight, mean_square = sum.target_squared / sum.weight;
    before += sum.weight * (mean_square - mean * mean);
    after += std::max(0.0, unit * (x.dot(data * x) - 2 * x.dot(right)) + sum.weight * mean_square);
    weight += sum.weight;
    for (std::size_t t = 0; t < rows.spec->tables.size(); ++t)
      for (std::size_t node = 0; node < rows.spec->tables[t].layout.node_count(); ++node)
        for (std::size_t c = 0; c < unknowns.channels[t]; ++c)
          if (gatherer.systems() == 1 || c == system)
            solution.log_values[unknowns.base[t] + node * unknowns.channels[t] + c] =
                x[static_cast<Eigen::Index>(gatherer.index(t, node, c))];
  }
  solution.error_before = std::sqrt(std::max(0.0, before / weight));
  solution.error_after = std::sqrt(after / weight);
  return solution;
}

}  // namespace burnish
