// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <burnish/fitting/numerics/dense.h>
#include <burnish/fitting/numerics/node_numbers.h>
#include <burnish/fitting/refinement/refine_system.h>
#include <burnish/fitting/refinement/rounding.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxTogether = 2000;  // unknowns of a system whose errors are made good together
// Damping and ridge keep compensating changes within what a linear model predicts well: shares of a diagonal entry
// and of their mean.
constexpr double kRoundingDamping = 1e-2, kRoundingRidge = 1e-3;
constexpr std::size_t kMaxChannels = 64;

bool holds_few_bits(TableFormat format) {
  return format == TableFormat::rgb9e5 || format == TableFormat::unorm8;
}

/// Rounds a table's texels as storing does.
class Rounding {
 public:
  explicit Rounding(const Table& log_table) : format_(log_table.format), channels_(log_table.channels) {
    Table stored = log_table;
    divided_ = store_log_table(stored);
  }

  /// Sets `stored` to the logarithms of one texel's values as they are once stored, given the exact ones.
  void round(std::span<const double> logs, std::span<double> stored) const {
    // Values are over what storing divides out, clamped to the format's range, rounded, and multiplied back.
    const double least = holds_few_bits(format_) ? 0x1p-126 : kTableFloor;
    const double most = format_ == TableFormat::rgb9e5 ? 65408 : 1;
    std::array<float, kMaxChannels> values;
    for (std::size_t c = 0; c < logs.size(); ++c)
      values[c] = static_cast<float>(std::clamp(std::exp(logs[c] - divided_[c]), least, most));
    const std::vector<float> rounded =
        round_to_format(format_, channels_, std::span(values).first(logs.size()));
    for (std::size_t c = 0; c < logs.size(); ++c)
      stored[c] = std::log(static_cast<double>(rounded[c])) + divided_[c];
  }

  const std::vector<double>& divided() const noexcept { return divided_; }

 private:
  TableFormat format_;
  std::size_t channels_;
  std::vector<double> divided_;  // one a channel
};

/// One system of channels that are solved together, and its unknowns.
struct Channels {
  RefineSystem system;
  Eigen::VectorXd x;
  ErrorTerms means;
  Eigen::MatrixXd upper;         ///< of the tables rounded together; empty: nothing is made good
  std::optional<NodeBand> band;  ///< of models with volumes
  Eigen::VectorXd start = {};    ///< x before the first table was rounded

  /// Sets unknown u to its stored value and moves the unknowns after it to compensate. `first` is the matrix's first
  /// unknown.
  void set_and_compensate(std::size_t u, std::size_t first, double stored) {
    const auto at = static_cast<Eigen::Index>(u), row = static_cast<Eigen::Index>(u - first);
    // With H^-1 = U^T U of the damped matrix H, the change of the later unknowns that minimizes the quadratic model
    // is -(error / U_uu) times the rest of row u of U.
    const Eigen::Index rest = upper.rows() - row - 1;
    if (rest > 0) {
      const double error = (x[at] - stored) / upper(row, row);
      x.segment(at + 1, rest) -= error * upper.row(row).tail(rest).transpose();
    }
    x[at] = stored;
  }
};

/// Rounds the tables of a model one after the other.
class CompensatedRounding {
 public:
  CompensatedRounding(const LogModel& model, const std::vector<Table>& tables, const TrainingSet& set,
                      const Lookups& lookups, const RefineOptions& options)
      : model_(model),
        smooth_(options.smooth),
        roundings_(tables.begin(), tables.end()),
        together_(model.any_shared() ? model.channels : 1),
        numbering_(number_nodes(model.spec, together_)) {
    const PictureLoss loss{.shares = options.shares, .exposure = set.exposure};
    for (std::size_t c = 0; c < model.channels; c += together_) {
      RefineSystem system(model, set, lookups, loss, options.format, c, c + together_);
      Eigen::VectorXd x = system.read(model);
      const ErrorTerms means = system.errors(x);
      parts_.push_back({std::move(system), std::move(x), means, {}, {}});
    }
  }

  const std::vector<Rounding>& roundings() const noexcept { return roundings_; }

  /// Returns the stored model, where later nodes compensate the rounding errors of earlier ones.
  LogModel compensated() {
    prepare_bands();
    for (std::size_t t = 0; t < roundings_.size();) {
      if (is_banded(t)) {
        ++t;
        continue;
      }
      // A matrix takes as many consecutive tables as kMaxTogether allows.
      const std::size_t first = first_unknown(t);
      std::size_t end = t + 1;
      while (end < roundings_.size() && !is_banded(end) && first_unknown(end + 1) - first <= kMaxTogether)
        ++end;
      for (Channels& part : parts_) prepare(part, first, first_unknown(end));
      for (; t < end; ++t) round_table(t, first);
    }
    if (parts_.front().band) round_band();
    LogModel result = model_;
    for (const Channels& part : parts_) part.system.write(part.x, result);
    return result;
  }

  /// Returns the stored model where each node is rounded to its nearest value.
  LogModel nearest() const {
    LogModel result = model_;
    for (std::size_t t = 0; t < roundings_.size(); ++t) {
      const std::size_t step = model_.step(t);
      for (std::size_t i = 0; i < result.log_values[t].size(); i += step)
        roundings_[t].round(std::span(model_.log_values[t]).subspan(i, step),
                            std::span(result.log_values[t]).subspan(i, step));
    }
    return result;
  }

 private:
  std::size_t first_unknown(std::size_t table) const {
    return table < numbering_.tables.size() ? numbering_.tables[table].base : numbering_.count;
  }

  /// Computes the factor of the damped inverse for the unknowns [first, last).
  void prepare(Channels& part, std::size_t first, std::size_t last) {
    part.upper.resize(0, 0);
    if (last - first > kMaxTogether) return;
    // The matrix is the Gauss-Newton matrix with the roughness, damped so that compensation stays small.
    part.system.gauss_newton_matrix(part.x, part.means, first, last, gauss_newton_);
    part.upper = gauss_newton_.matrix;
    part.system.add_roughness_matrix(2 * smooth_, first, part.upper);
    const Eigen::VectorXd diagonal = part.upper.diagonal();
    part.upper.diagonal() += kRoundingDamping * diagonal;
    part.upper.diagonal().array() += kRoundingRidge * diagonal.mean();
    if (!factorize_inverse(part.upper)) part.upper.resize(0, 0);
  }

  // ---- Tables along one coordinate, which a band holds whole

  bool is_banded(std::size_t t) const {
    const auto& band = parts_.front().band;
    return band && band->is_banded(static_cast<std::uint32_t>(first_unknown(t)));
  }

  void prepare_bands() {
    for (Channels& part : parts_)
      if (!part.system.has_volume() || !prepare_band(part)) {
        for (Channels& other : parts_) other.band.reset();
        return;
      }
  }

  bool prepare_band(Channels& part) {
    // The damped matrix of models with volumes is factorized as a band.
    part.band = part.system.node_band();
    part.start = part.x;
    const RefineSystem::GaussNewtonFactor factor = part.system.gauss_newton_factor(part.x, part.means);
    const Eigen::VectorXd diagonal = factor.diagonal + 2 * smooth_ * part.system.roughness_diagonal();
    part.system.fill(part.x, part.means, 2 * smooth_, *part.band);
    return part.band->factorize(kRoundingDamping * diagonal.array() + kRoundingRidge * diagonal.mean());
  }

  /// Rounds the band's nodes from the last to the first. Each moves where the changes of those after it pull it.
  void round_band() {
    std::vector<Eigen::VectorXd> asked;
    for (Channels& part : parts_) asked.push_back(follow_rest(part));
    const std::span<const std::uint32_t> order = parts_.front().band->banded();
    std::vector<Eigen::VectorXd> changes(parts_.size(),
                                         Eigen::VectorXd::Zero(static_cast<Eigen::Index>(order.size())));
    std::vector<double> logs, stored;
    for (std::size_t i = order.size(); i > 0;) {
      // A texel's channels stand side by side in one system, or at the same place of several systems.
      const std::size_t t = table_of(order[i - 1]), step = model_.step(t);
      const std::size_t here = together_ > 1 ? step : 1, systems = step / here;
      i -= here;
      logs.resize(step);
      stored.resize(step);
      for (std::size_t c = 0; c < step; ++c) {
        const std::size_t s = systems > 1 ? c : 0, at = i + (here > 1 ? c : 0);
        // Given the changes of later unknowns, follow() gives the change of this one that minimizes the quadratic
        // model.
        logs[c] = asked[s][order[at]] + parts_[s].band->band().follow(at, changes[s]);
      }
      roundings_[t].round(logs, stored);
      for (std::size_t c = 0; c < step; ++c) {
        const std::size_t s = systems > 1 ? c : 0, at = i + (here > 1 ? c : 0);
        changes[s][static_cast<Eigen::Index>(at)] = stored[c] - asked[s][order[at]];
        parts_[s].x[order[at]] = stored[c];
      }
    }
  }

  /// Returns the band's unknowns after they compensate the rounding of all other tables.
  Eigen::VectorXd follow_rest(Channels& part) const {
    // The change d of the others pulls with -H d, H being the Gauss-Newton matrix. The band's unknowns answer by its
    // inverse.
    const Eigen::VectorXd change = part.x - part.start;
    if (change.isZero(0)) return part.x;
    const RefineSystem::GaussNewtonFactor factor = part.system.gauss_newton_factor(part.start, part.means);
    Eigen::VectorXd pull = -part.system.gauss_newton_times(factor, change);
    for (Eigen::Index u = 0; u < pull.size(); ++u)
      if (!part.band->is_banded(static_cast<std::uint32_t>(u))) pull[u] = 0;
    return part.x + part.band->solve(pull);
  }

  std::size_t table_of(std::size_t unknown) const {
    std::size_t t = 0;
    while (first_unknown(t + 1) <= unknown) ++t;
    return t;
  }

  // ---- The others

  void round_table(std::size_t t, std::size_t first) {
    // Node by node, all channels of a texel are rounded together, then each compensates in its own system.
    const NodeNumbers& number = numbering_.tables[t];
    const std::size_t step = model_.step(t);
    std::vector<double> logs(step), stored(step);
    for (std::size_t n = 0; n < model_.spec.tables[t].layout.node_count(); ++n) {
      const auto part = [&](std::size_t c) -> Channels& { return parts_[together_ > 1 ? 0 : c]; };
      for (std::size_t c = 0; c < step; ++c) logs[c] = part(c).x[static_cast<Eigen::Index>(number(n, c))];
      roundings_[t].round(logs, stored);
      for (std::size_t c = 0; c < step; ++c) part(c).set_and_compensate(number(n, c), first, stored[c]);
    }
  }

  const LogModel& model_;
  double smooth_;
  std::vector<Rounding> roundings_;
  std::size_t together_;  ///< channels of a system
  Numbering numbering_;
  std::vector<Channels> parts_;
  RefineSystem::GaussNewton gauss_newton_;
};

/// Makes the model from the logarithms of its stored values.
FactoredBrdf from_stored(const LogModel& model, const std::vector<Rounding>& roundings, TableFormat format) {
  std::vector<Table> tables = log_tables(model, format);
  std::vector<std::vector<double>> divided;
  for (std::size_t t = 0; t < tables.size(); ++t) {
    divided.push_back(roundings[t].divided());
    const std::size_t step = model.step(t);
    for (std::size_t i = 0; i < tables[t].values.size(); ++i)
      tables[t].values[i] = static_cast<float>(std::exp(model.log_values[t][i] - divided[t][i % step]));
    tables[t].values = round_to_format(tables[t].format, tables[t].channels, tables[t].values);
  }
  return from_stored_tables(model.channels, std::move(tables), divided, log_scaled_lobes(model));
}

}  // namespace

FactoredBrdf to_rounded_brdf(const LogModel& model, const TrainingSet& set, const RefineOptions& options) {
  const std::vector<Table> tables = log_tables(model, options.format);
  if (model.channels > kMaxChannels ||
      std::ranges::none_of(tables, [](const Table& table) { return holds_few_bits(table.format); }))
    return to_brdf(model, options.format);

  // Compensated rounding is kept only if its objective is lower than that of nearest rounding.
  const Lookups lookups = lookups_of(model.spec, set);
  CompensatedRounding rounding(model, tables, set, lookups, options);
  const LogModel compensated = rounding.compensated();
  const auto error = [&](const LogModel& stored) { return objective(stored, set, lookups, options.shares); };
  return error(compensated) < error(rounding.nearest())
             ? from_stored(compensated, rounding.roundings(), options.format)
             : to_brdf(model, options.format);
}

}  // namespace burnish
