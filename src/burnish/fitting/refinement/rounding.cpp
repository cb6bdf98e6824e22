#include <algorithm>
#include <array>
#include <cmath>

#include <burnish/fitting/numerics/dense.h>
#include <burnish/fitting/refinement/refine_system.h>
#include <burnish/fitting/refinement/rounding.h>

namespace burnish {

namespace {

constexpr std::size_t kMostTogether = 2000;  // unknowns of a system whose errors are made good together
// Keeps what makes good within what a linear model sees: shares of a diagonal entry and of their mean.
constexpr double kDamping = 1e-2, kRidge = 1e-3;
constexpr std::size_t kMostChannels = 64;

bool holds_few_bits(TableFormat format) {
  return format == TableFormat::rgb9e5 || format == TableFormat::unorm8;
}

/// What a table's texels become when they are stored.
class Rounding {
 public:
  explicit Rounding(const Table& log_table) : format_(log_table.format), channels_(log_table.channels) {
    Table stored = log_table;
    divided_ = store_log_table(stored);
  }

  /// Logarithms of lambda of one texel, and what they are once stored.
  void round(std::span<const double> logs, std::span<double> stored) const {
    const double least = holds_few_bits(format_) ? 0x1p-126 : kTableFloor;
    const double most = format_ == TableFormat::rgb9e5 ? 65408 : 1;
    std::array<float, kMostChannels> values;
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
  int channels_;
  std::vector<double> divided_;  // one a channel
};

/// The channels that are solved together, and their unknowns.
struct Channels {
  RefineSystem system;
  Eigen::VectorXd x;
  ErrorTerms means;
  Eigen::MatrixXd upper;  ///< of the tables rounded together; empty: nothing is made good
};

/// Rounds unknown u, `first` being the first of the matrix, and makes it good by those after it.
void store(Channels& part, std::size_t u, std::size_t first, double stored) {
  const auto at = static_cast<Eigen::Index>(u), row = static_cast<Eigen::Index>(u - first);
  const Eigen::Index rest = part.upper.rows() - row - 1;
  if (rest > 0) {
    const double error = (part.x[at] - stored) / part.upper(row, row);
    part.x.segment(at + 1, rest) -= error * part.upper.row(row).tail(rest).transpose();
  }
  part.x[at] = stored;
}

}  // namespace

FactoredBrdf to_rounded_brdf(const LogModel& model, const TrainingSet& set, const RefineOptions& options) {
  const std::vector<Table> tables = log_tables(model, options.format);
  const auto channels = static_cast<std::size_t>(model.channels);
  if (channels > kMostChannels ||
      std::ranges::none_of(tables, [](const Table& table) { return holds_few_bits(table.format); }))
    return to_brdf(model, options.format);

  std::vector<Rounding> roundings(tables.begin(), tables.end());
  const Lookups lookups = find_lookups(model.spec, set);
  const PictureLoss loss{.shares = options.shares, .exposure = set.exposure};
  const std::size_t together = model.any_shared() ? channels : 1;
  std::vector<Channels> parts;
  for (std::size_t c = 0; c < channels; c += together) {
    RefineSystem system(model, set, lookups, loss, options.format, c, c + together);
    Eigen::VectorXd x = system.read(model);
    const ErrorTerms means = system.errors(x);
    parts.push_back({std::move(system), std::move(x), means, {}});
  }

  // Number of a table's unknowns in a system; a table shared by the channels has one a node.
  const auto copies = [&](std::size_t t) { return model.step(t) == 1 ? 1 : together; };
  const auto unknowns = [&](std::size_t t) { return tables[t].layout.node_count() * copies(t); };
  const auto round_table = [&](std::size_t t, std::size_t base, std::size_t first) {
    const std::size_t step = model.step(t);
    std::vector<double> logs(step), stored(step);
    for (std::size_t n = 0; n < tables[t].layout.node_count(); ++n) {
      const auto unknown = [&](std::size_t c) { return base + n * copies(t) + (copies(t) > 1 ? c : 0); };
      const auto part = [&](std::size_t c) -> Channels& { return parts[together > 1 ? 0 : c]; };
      for (std::size_t c = 0; c < step; ++c) logs[c] = part(c).x[static_cast<Eigen::Index>(unknown(c))];
      roundings[t].round(logs, stored);
      for (std::size_t c = 0; c < step; ++c) store(part(c), unknown(c), first, stored[c]);
    }
  };
  RefineSystem::Normal normal;
  for (std::size_t t = 0, first = 0; t < tables.size();) {
    std::size_t end = t, last = first;
    while (end < tables.size() && (end == t || last - first + unknowns(end) <= kMostTogether))
      last += unknowns(end++);
    for (Channels& part : parts) {
      part.upper.resize(0, 0);
      if (last - first > kMostTogether) continue;
      part.system.find_normal(part.x, part.means, first, last, normal);
      part.upper = normal.matrix;
      part.system.add_roughness_matrix(2 * options.smooth, first, part.upper);
      const Eigen::VectorXd diagonal = part.upper.diagonal();
      part.upper.diagonal() += kDamping * diagonal;
      part.upper.diagonal().array() += kRidge * diagonal.mean();
      if (!factorize_inverse(part.upper)) part.upper.resize(0, 0);
    }
    for (std::size_t base = first; t < end; base += unknowns(t++)) round_table(t, base, first);
    first = last;
  }

  LogModel good = model, plain = model;
  for (const Channels& part : parts) part.system.write(part.x, good);
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const std::size_t step = model.step(t);
    for (std::size_t i = 0; i < plain.log_values[t].size(); i += step)
      roundings[t].round(std::span(model.log_values[t]).subspan(i, step),
                         std::span(plain.log_values[t]).subspan(i, step));
  }
  if (!(objective(good, set, lookups, options.shares) < objective(plain, set, lookups, options.shares)))
    return to_brdf(model, options.format);
  std::vector<Table> stored = log_tables(good, options.format);
  std::vector<std::vector<double>> divided;
  for (std::size_t t = 0; t < stored.size(); ++t) {
    divided.push_back(roundings[t].divided());
    const std::size_t step = model.step(t);
    for (std::size_t i = 0; i < stored[t].values.size(); ++i)
      stored[t].values[i] = static_cast<float>(std::exp(good.log_values[t][i] - divided[t][i % step]));
    stored[t].values = round_to_format(stored[t].format, stored[t].channels, stored[t].values);
  }
  return from_stored_tables(model.channels, std::move(stored), divided, log_scaled_lobes(model));
}

}  // namespace burnish
