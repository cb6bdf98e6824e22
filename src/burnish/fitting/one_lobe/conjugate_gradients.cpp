// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <burnish/error.h>
#include <burnish/fitting/numerics/node_numbers.h>
#include <burnish/fitting/numerics/preconditioned_cg.h>
#include <burnish/fitting/numerics/smoothness.h>
#include <burnish/fitting/one_lobe/conjugate_gradients.h>
#include <burnish/fitting/one_lobe/multilevel.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

constexpr std::size_t kChunk = 16384;
constexpr double kIterativeRidge = 1e-8;

using Floats = std::vector<float>;
using Doubles = std::vector<double>;

double inner_product(const Doubles& a, const Doubles& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// The normal operator A^T W A / sum(W) + smooth S + ridge, without its matrix. Its solution is the least squares fit
/// of log f = sum of log lambda [HomomorphicBrdf, eq. 5].
/// Unknowns of tables with all channels are padded to `Padded` floats a texel (0: no padding, any count), so that a
/// texel is one vector register.
template <std::size_t Padded>
class LogOperator {
 public:
  LogOperator(const RowMaker& maker, const HomomorphicOptions& options)
      : spec_(*maker.spec),
        uses_(spec_.lobes.front()),
        channels_(maker.source->channels),
        numbering_(number_nodes(spec_, step())) {
    for (const ModelSpec::TableSpec& table : spec_.tables) {
      smoothness_.push_back(smoothness_rows(table.layout, {table.even_y, table.pole_x, table.circle_z}));
      smooth_.push_back(options.smooth * table.smooth_share);
    }
    for (const FactorUse& use : uses_) {
      // A lookup's texels stand at fixed strides from its first node.
      const auto t = use.table;
      const TableLayout& layout = spec_.tables[t].layout;
      const auto [base, copies] = numbering_.tables[t];
      const std::size_t row = static_cast<std::size_t>(layout.width) * copies;
      touches_.push_back({.base = base,
                          .step = copies,
                          .next_row = row,
                          .next_layer = row * static_cast<std::size_t>(layout.height),
                          .axes = axis_count(layout.shape)});
    }
    // Rows are made once and kept, chunk by chunk.
    chunks_.resize(chunk_count(maker.source->count, kChunk));
    for_each_chunk(maker.source->count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      chunks_[chunk] = maker.make(begin, end);
      pad(chunks_[chunk]);
    });
    center();
  }

  std::size_t count() const { return numbering_.count; }
  std::size_t samples() const { return samples_; }
  double error_before() const { return error_before_; }
  const Doubles& mean() const { return mean_; }

  Doubles right_side() const {
    // The right side is A^T W t / sum(W) for the targets t.
    return accumulate([&](const LogRows& rows, Floats& y) {
      scatter(rows, y, [&](std::size_t i, float* row) {
        for (std::size_t c = 0; c < step(); ++c) row[c] = weight(rows, i, c) * rows.target[i * step() + c];
      });
    });
  }

  /// Returns y = operator x. Also, x^T A^T W A x / sum(W) is x.y less the smoothness.
  Doubles apply(const Doubles& x) const {
    // Each row gathers A x, weighs it, and scatters it by A^T.
    const Floats xf(x.begin(), x.end());
    Doubles y = accumulate([&](const LogRows& rows, Floats& part) {
      scatter(rows, part, [&](std::size_t i, float* row) {
        gather(rows, i, xf, row);
        for (std::size_t c = 0; c < step(); ++c) row[c] *= weight(rows, i, c);
      });
    });
    add_smoothness(x, y);
    for (std::size_t i = 0; i < count(); ++i) y[i] += kIterativeRidge * x[i];
    return y;
  }

  /// Prepares precondition(r), an approximate inverse of the operator times r. On the tables' own resolution and
  /// every coarser one, it divides the residual by the operator's diagonal there, and adds the results [Bramble
  /// 1990].
  void build_preconditioner() {
    preconditioner_.resize(spec_.tables.size());
    for (std::size_t t = 0; t < spec_.tables.size(); ++t) {
      const TableLayout& layout = spec_.tables[t].layout;
      // A level is a transfer to a coarser grid; the first one is the table's own resolution.
      preconditioner_[t].push_back({GridTransfer(layout, layout.width, layout.height, layout.depth), {}});
      for (GridTransfer& level : coarser_levels(layout)) preconditioner_[t].push_back({std::move(level), {}});
    }
    struct Task {
      std::size_t table;
      Level* level;
    };
    std::vector<Task> tasks;
    for (std::size_t t = 0; t < spec_.tables.size(); ++t)
      for (Level& level : preconditioner_[t]) tasks.push_back({t, &level});
    for_each_chunk(tasks.size(), 1, [&](std::size_t task, std::size_t, std::size_t) {
      tasks[task].level->inverse_diagonal = inverse_diagonal(tasks[task].table, tasks[task].level->transfer);
    });
  }

  Doubles precondition(const Doubles& r) const {
    Doubles z(r.size()), coarse;
    for (std::size_t t = 0; t < spec_.tables.size(); ++t) {
      const auto [base, copies] = numbering_.tables[t];
      // Each level restricts the residual, scales it by the inverse diagonal, and interpolates it back.
      for (const Level& level : preconditioner_[t]) {
        coarse.resize(level.inverse_diagonal.size());
        level.transfer.restrict_to(r.data() + base, coarse.data(), copies);
        for (std::size_t i = 0; i < coarse.size(); ++i) coarse[i] *= level.inverse_diagonal[i];
        level.transfer.add_interpolated(coarse.data(), z.data() + base, copies);
      }
    }
    return z;
  }

  /// Returns the weighted rms of the rows' residual.
  double error(const Doubles& x) const {
    const Floats xf(x.begin(), x.end());
    Doubles sums(chunks_.size());
    for_each_chunk(chunks_.size(), 1, [&](std::size_t chunk, std::size_t, std::size_t) {
      const LogRows& rows = chunks_[chunk];
      Floats row(step());
      for (std::size_t i = 0; i < rows.size; ++i) {
        gather(rows, i, xf, row.data());
        for (std::size_t c = 0; c < step(); ++c) {
          const double residual = row[c] - rows.target[i * step() + c];
          sums[chunk] += weight(rows, i, c) * residual * residual;
        }
      }
    });
    double sum = 0;
    for (const double s : sums) sum += s;
    return std::sqrt(sum / (total_weight_ * static_cast<double>(channels_)));
  }

  /// Returns the unknown of a table's node and channel.
  std::size_t index(std::size_t table, std::size_t node, std::size_t channel) const {
    return numbering_.tables[table](node, channel);
  }

 private:
  struct Touch {
    std::size_t base, step, next_row, next_layer;
    int axes;
  };

  std::size_t step() const {
    if constexpr (Padded > 0) return Padded;
    return channels_;
  }

  float weight(const LogRows& rows, std::size_t i, std::size_t c) const {
    return rows.weight_channels == 1 ? rows.weight[i] : rows.weight[i * step() + c];
  }

  // Widens targets and weights to the padded channel count; the padding stays 0.
  void pad(LogRows& rows) const {
    if (step() == channels_) return;
    const auto widen = [&](Floats& values) {
      Floats wide(rows.size * step());
      for (std::size_t i = 0; i < rows.size; ++i)
        for (std::size_t c = 0; c < channels_; ++c) wide[i * step() + c] = values[i * channels_ + c];
      values = std::move(wide);
    };
    widen(rows.target);
    if (rows.weight_channels > 1) widen(rows.weight);
  }

  // Subtracts each channel's mean from the targets, and finds the weights' sum and the error before the fit.
  void center() {
    Doubles weights(channels_), first(channels_), second(channels_);
    for (const LogRows& rows : chunks_) {
      samples_ += rows.size;
      for (std::size_t i = 0; i < rows.size; ++i)
        for (std::size_t c = 0; c < channels_; ++c) {
          const double w = weight(rows, i, c), t = rows.target[i * step() + c];
          weights[c] += w;
          first[c] += w * t;
          second[c] += w * t * t;
        }
    }
    // total_weight_ is the sum of weights, mean over the channels: it normalizes the operator.
    for (const double w : weights) total_weight_ += w / static_cast<double>(channels_);
    if (!(total_weight_ > 0)) throw Error("fit: expected samples with a weight above 0, found none");
    mean_.assign(step(), 0);
    double spread = 0;
    for (std::size_t c = 0; c < channels_; ++c) {
      if (!(weights[c] > 0)) continue;
      // The variance is the second moment less the mean squared, times the weight.
      mean_[c] = first[c] / weights[c];
      spread += (second[c] - weights[c] * mean_[c] * mean_[c]) / total_weight_;
    }
    error_before_ = std::sqrt(std::max(0.0, spread / static_cast<double>(channels_)));
    for_each_chunk(chunks_.size(), 1, [&](std::size_t chunk, std::size_t, std::size_t) {
      LogRows& rows = chunks_[chunk];
      for (std::size_t i = 0; i < rows.size * step(); ++i)
        rows.target[i] -= static_cast<float>(mean_[i % step()]);
    });
  }

  // Returns the inverse of the operator's diagonal on one level of a table. Every kSampleStride-th sample is enough
  // to estimate it.
  Doubles inverse_diagonal(std::size_t table, const GridTransfer& level) const {
    constexpr std::size_t kSampleStride = 8;
    const std::size_t step_of = numbering_.tables[table].copies;
    // The data add the squared weight of each coarse corner, times the sample's weight.
    Doubles d(level.coarse_count() * step_of);
    for (const LogRows& rows : chunks_)
      for (std::size_t i = 0; i < rows.size; i += kSampleStride)
        for (std::size_t k = 0; k < uses_.size(); ++k) {
          if (uses_[k].table != table) continue;
          const std::size_t use = i * uses_.size() + k;
          const GridTransfer::Corners at = level.corners({.node = static_cast<int>(rows.node[use]),
                                                          .fx = static_cast<double>(rows.fx[use]),
                                                          .fy = static_cast<double>(rows.fy[use]),
                                                          .fz = static_cast<double>(rows.fz[use])});
          for (std::size_t corner = 0; corner < at.count; ++corner)
            for (std::size_t c = 0; c < channels_; ++c)
              d[at.node[corner] * step_of + (step_of > 1 ? c : 0)] +=
                  kSampleStride * at.weight[corner] * at.weight[corner] * weight(rows, i, c);
        }
    // The smoothness adds the squared coefficients of the coarse table's rows.
    TableLayout layout = spec_.tables[table].layout;
    layout.width = level.coarse_width();
    layout.height = level.coarse_height();
    layout.depth = level.coarse_depth();
    const ModelSpec::TableSpec& spec = spec_.tables[table];
    const SmoothnessRows smoothness = smoothness_rows(layout, {spec.even_y, spec.pole_x, spec.circle_z});
    for (double& v : d) v = v / total_weight_ + kIterativeRidge;
    for (std::size_t k = 0; k < smoothness.nodes.size(); ++k)
      for (std::size_t c = 0; c < step_of; ++c)
        d[smoothness.nodes[k] * step_of + c] +=
            smooth_[table] * smoothness.coefficients[k] * smoothness.coefficients[k];
    for (double& v : d) v = 1 / v;
    return d;
  }

  template <class Body>
  // Calls body(place, step, weight) for the 2, 4 or 8 texels of each lookup of row i, with linear weights.
  void for_each_corner(const LogRows& rows, std::size_t i, const Body& body) const {
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      const Touch& touch = touches_[k];
      const std::size_t use = i * touches_.size() + k;
      const std::size_t at = touch.base + rows.node[use] * touch.step;
      const float fx = rows.fx[use], fy = rows.fy[use], fz = rows.fz[use];
      const auto layer = [&](std::size_t node, float share) {
        body(node, touch.step, (1 - fx) * (1 - fy) * share);
        body(node + touch.step, touch.step, fx * (1 - fy) * share);
        if (touch.axes == 1) return;
        body(node + touch.next_row, touch.step, (1 - fx) * fy * share);
        body(node + touch.next_row + touch.step, touch.step, fx * fy * share);
      };
      layer(at, 1 - fz);
      if (touch.axes == 3) layer(at + touch.next_layer, fz);
    }
  }

  // Sets row = sum of log lambda over the uses [HomomorphicBrdf, eq. 5], for each channel.
  void gather(const LogRows& rows, std::size_t i, const Floats& x, float* row) const {
    for (std::size_t c = 0; c < step(); ++c) row[c] = 0;
    for_each_corner(rows, i, [&](std::size_t at, std::size_t step_of, float weight) {
      if (step_of == step())
        for (std::size_t c = 0; c < step(); ++c) row[c] += weight * x[at + c];
      else
        for (std::size_t c = 0; c < channels_; ++c) row[c] += weight * x[at];  // the padding stays 0
    });
  }

  // Adds y += A^T row for every sample, with the row that make_row(i, row) writes.
  template <class MakeRow>
  void scatter(const LogRows& rows, Floats& y, const MakeRow& make_row) const {
    std::array<float, Padded> fixed;
    Floats dynamic(Padded == 0 ? step() : 0);
    float* row = Padded == 0 ? dynamic.data() : fixed.data();
    for (std::size_t i = 0; i < rows.size; ++i) {
      make_row(i, row);
      for_each_corner(rows, i, [&](std::size_t at, std::size_t step_of, float weight) {
        if (step_of == step())
          // All channels of a texel are one vector.
          for (std::size_t c = 0; c < step(); ++c) y[at + c] += weight * row[c];
        else
          // A shared table's texel takes the sum over the channels.
          for (std::size_t c = 0; c < step(); ++c) y[at] += weight * row[c];
      });
    }
  }

  // Returns the sum over chunks of what body adds to a zero vector, divided by the samples' weight. The order of sums
  // does not depend on the number of threads.
  template <class Body>
  Doubles accumulate(const Body& body) const {
    constexpr std::size_t kGroups = 32;
    const std::size_t group = (chunks_.size() + kGroups - 1) / kGroups;
    std::vector<Floats> parts(chunk_count(chunks_.size(), group));
    for_each_chunk(chunks_.size(), group, [&](std::size_t g, std::size_t begin, std::size_t end) {
      // A group sums in floats, groups are joined in doubles.
      parts[g].assign(count(), 0);
      for (std::size_t i = begin; i < end; ++i) body(chunks_[i], parts[g]);
    });
    Doubles sum(count());
    for_each_chunk(count(), 4096, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (const Floats& part : parts)
        for (std::size_t i = begin; i < end; ++i) sum[i] += part[i];
      for (std::size_t i = begin; i < end; ++i) sum[i] /= total_weight_;
    });
    return sum;
  }

  // Adds smooth S x to y: each roughness row is applied to x and scattered back.
  void add_smoothness(const Doubles& x, Doubles& y) const {
    for (std::size_t t = 0; t < spec_.tables.size(); ++t) {
      const SmoothnessRows& rows = smoothness_[t];
      const NodeNumbers& number = numbering_.tables[t];
      for (std::size_t r = 0; r < rows.size(); ++r)
        for (std::size_t c = 0; c < number.copies; ++c) {
          double value = 0;
          for (std::size_t k = rows.starts[r]; k < rows.starts[r + 1]; ++k)
            value += rows.coefficients[k] * x[number(rows.nodes[k], c)];
          for (std::size_t k = rows.starts[r]; k < rows.starts[r + 1]; ++k)
            y[number(rows.nodes[k], c)] += smooth_[t] * rows.coefficients[k] * value;
        }
    }
  }

  const ModelSpec& spec_;
  const std::vector<FactorUse>& uses_;
  std::size_t channels_, samples_ = 0;
  Numbering numbering_;  ///< of padded texels
  double total_weight_ = 0, error_before_ = 0;
  Doubles smooth_;
  std::vector<Touch> touches_;
  std::vector<SmoothnessRows> smoothness_;
  std::vector<LogRows> chunks_;
  struct Level {
    GridTransfer transfer;
    Doubles inverse_diagonal;
  };
  std::vector<std::vector<Level>> preconditioner_;  ///< [table][level]
  Doubles mean_;
};

template <std::size_t Padded>
LogSolution solve(const RowMaker& rows, const HomomorphicOptions& options) {
  LogOperator<Padded> op(rows, options);
  op.build_preconditioner();
  LogSolution solution{.samples = op.samples(), .summary = {.error_before = op.error_before()}};

  // Conjugate gradients solve the normal equations from x = 0, the targets' means.
  Doubles x(op.count());
  const double least = options.tolerance * options.tolerance;
  const auto after_step = [&](const CgResult& state) {
    // The residual falls about geometrically, so progress is measured on its logarithm.
    if (options.progress)
      options.progress(std::clamp(
          std::log(state.first_residual / std::max(state.residual, 1e-300)) / std::log(1 / least), 0.0, 1.0));
  };
  const CgResult found = preconditioned_cg(
      x, op.right_side(), options.tolerance, options.max_iterations,
      [&](const Doubles& v) { return op.apply(v); }, [&](const Doubles& r) { return op.precondition(r); },
      inner_product, after_step);
  if (!std::isfinite(found.residual))
    throw Error(
        "fit: expected a system of equations that can be solved, found none; more smoothness may help");
  solution.summary.iterations = found.iterations;
  if (found.iterations < options.max_iterations) solution.summary.stop_reason = StopReason::tolerance_reached;
  solution.summary.error_after = op.error(x);

  // The solution is copied without the padding.
  const Numbering numbering = number_nodes(*rows.spec, rows.source->channels);
  solution.log_values.resize(numbering.count);
  for (std::size_t t = 0; t < rows.spec->tables.size(); ++t)
    for (std::size_t node = 0; node < rows.spec->tables[t].layout.node_count(); ++node)
      for (std::size_t c = 0; c < numbering.tables[t].copies; ++c)
        solution.log_values[numbering.tables[t](node, c)] = x[op.index(t, node, c)];
  solution.channel_offset.assign(op.mean().begin(), op.mean().begin() + rows.source->channels);
  return solution;
}

}  // namespace

LogSolution solve_by_conjugate_gradients(const RowMaker& rows, const HomomorphicOptions& options) {
  switch (rows.source->channels) {
    case 1:
      return solve<1>(rows, options);
    case 3:
      return solve<4>(rows, options);
    default:
      return solve<0>(rows, options);
  }
}

}  // namespace burnish
