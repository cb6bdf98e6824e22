#include <algorithm>
#include <cmath>
#include <numbers>

#include <burnish/fitting/refinement/refine_system.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

constexpr std::size_t kChunk = 64;  // blocks
constexpr std::size_t kMostGroups = 16;
// Of many pairs an even part makes a matrix good enough for a step; the slope is that of all.
constexpr std::size_t kMatrixPairsPerUnknown = 40;

// ln of a table's largest value over the smallest that its format, or the general floor, leaves.
double log_range(TableFormat format) {
  return format == TableFormat::unorm8 ? std::log(255.0) : -std::log(kTableFloor);
}

// rgb9e5 holds a channel down to one unit of a mantissa of at least 256.
const double kLogMantissa = std::log(256.0);
constexpr double kHeadroom = std::numbers::ln2;  // the least that a texel's largest channel may rise

// Where the channels of an rgb9e5 texel stay, whichever way the others move: within what one exponent holds.
// Logarithms over the channels' means, which are divided out before the texels are stored.
std::vector<LogRange> shared_exponent_ranges(const std::vector<double>& logs, std::size_t channels) {
  std::vector<double> mean(channels);
  const double nodes = static_cast<double>(logs.size()) / static_cast<double>(channels);
  for (std::size_t i = 0; i < logs.size(); ++i) mean[i % channels] += logs[i] / nodes;
  std::vector<LogRange> ranges;
  for (std::size_t i = 0; i < logs.size(); i += channels) {
    double most = -INFINITY, least = INFINITY;
    for (std::size_t c = 0; c < channels; ++c) {
      most = std::max(most, logs[i + c] - mean[c]);
      least = std::min(least, logs[i + c] - mean[c]);
    }
    const double top = most + std::max(kHeadroom, (kLogMantissa - (most - least)) / 2);
    ranges.push_back({.least = top - kLogMantissa, .most = top});
  }
  return ranges;
}

// The unknowns of a system of `channels` channels of a model, table by table.
std::vector<LobeLanes::Unknowns> unknowns_of(const LogModel& model, std::size_t channels) {
  std::vector<LobeLanes::Unknowns> unknowns;
  std::size_t base = 0;
  for (std::size_t t = 0; t < model.spec.tables.size(); ++t) {
    const TableLayout& layout = model.spec.tables[t].layout;
    const std::size_t copies = model.step(t) == 1 ? 1 : channels;
    unknowns.push_back({.base = base, .stride = copies, .copies = copies, .layout = layout});
    base += layout.node_count() * copies;
  }
  return unknowns;
}

}  // namespace

RefineSystem::RefineSystem(const LogModel& model, const TrainingSet& set, const Lookups& lookups,
                           const PictureLoss& loss, TableFormat format, std::size_t first_channel,
                           std::size_t last_channel)
    : set_(set),
      loss_(loss),
      first_channel_(first_channel),
      last_channel_(last_channel),
      lanes_(unknowns_of(model, last_channel - first_channel), lookups, last_channel - first_channel) {
  const std::size_t channels = last_channel - first_channel;
  for (const auto& [base, stride, copies, layout] : unknowns_of(model, channels)) {
    const std::size_t t = tables_.size();
    const auto& table = model.spec.tables[t];
    tables_.push_back({.base = base,
                       .stride = stride,
                       .copies = copies,
                       .nodes = layout.node_count(),
                       .step = model.step(t),
                       .share = table.smooth_share,
                       .log_range = log_range(format_of(table, format)),
                       .rows = smoothness_rows(layout)});
    size_ += tables_.back().nodes * copies;
    ranges_.resize(size_, {-INFINITY, INFINITY});
    if (model.step(t) == 1 || format_of(table, format) != TableFormat::rgb9e5) continue;
    const std::vector<LogRange> ranges = shared_exponent_ranges(model.log_values[t], model.step(t));
    for (std::size_t n = 0; n < tables_.back().nodes; ++n)
      for (std::size_t c = 0; c < copies; ++c) ranges_[tables_.back().base + n * copies + c] = ranges[n];
  }
  for (std::size_t i = 0; i < set.size(); ++i)
    (i < set.picture_count ? picture_weight_ : pair_weight_) +=
        set.weights[i] * static_cast<double>(channels);
  constexpr std::size_t kBlock = LobeLanes::kBlock;
  const std::size_t padded = lanes_.blocks() * kBlock;
  losses_.targets.resize(2 * padded * channels);
  losses_.cos_theta_i.resize(padded);
  losses_.picture_weight.resize(padded);
  losses_.pair_weight.resize(padded);
  for_each_chunk(set.size(), kChunk * kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const bool picture = i < set.picture_count;
      losses_.cos_theta_i[i] = static_cast<float>(set.pairs[i].wi.z);
      (picture ? losses_.picture_weight : losses_.pair_weight)[i] = set.weights[i];
      for (std::size_t c = 0; c < channels; ++c) {
        const double f = set.values[i * static_cast<std::size_t>(set.channels) + first_channel + c];
        const PictureLoss::Target target = loss.target(f, set.pairs[i].wi.z, picture);
        float* targets = losses_.targets.data() + 2 * (i / kBlock * channels + c) * kBlock + i % kBlock;
        targets[0] = target.first;
        targets[kBlock] = target.second;
      }
    }
  });
}

Eigen::VectorXd RefineSystem::read(const LogModel& model) const {
  Eigen::VectorXd x(static_cast<Eigen::Index>(size_));
  for (std::size_t t = 0; t < tables_.size(); ++t)
    for (std::size_t n = 0; n < tables_[t].nodes; ++n)
      for (std::size_t c = 0; c < tables_[t].copies; ++c)
        x[static_cast<Eigen::Index>(tables_[t].base + n * tables_[t].stride + c)] =
            model.log_values[t][n * tables_[t].step + (tables_[t].step == 1 ? 0 : first_channel_ + c)];
  return x;
}

void RefineSystem::write(const Eigen::VectorXd& x, LogModel& model) const {
  for (std::size_t t = 0; t < tables_.size(); ++t)
    for (std::size_t n = 0; n < tables_[t].nodes; ++n)
      for (std::size_t c = 0; c < tables_[t].copies; ++c)
        model.log_values[t][n * tables_[t].step + (tables_[t].step == 1 ? 0 : first_channel_ + c)] =
            x[static_cast<Eigen::Index>(tables_[t].base + n * tables_[t].stride + c)];
}

void RefineSystem::clamp(Eigen::VectorXd& x) const {
  for (const TableUnknowns& table : tables_)
    for (std::size_t c = 0; c < table.copies; ++c) {
      double* first = x.data() + table.base + c;
      double largest = *first, mean = 0;
      for (std::size_t n = 0; n < table.nodes; ++n) {
        largest = std::max(largest, first[n * table.stride]);
        mean += first[n * table.stride] / static_cast<double>(table.nodes);
      }
      for (std::size_t n = 0; n < table.nodes; ++n) {
        const LogRange& range = ranges_[table.base + c + n * table.stride];
        double& value = first[n * table.stride];
        value = std::clamp(std::max(value, largest - table.log_range), mean + range.least, mean + range.most);
      }
    }
}

LossInputs RefineSystem::loss_inputs(std::size_t block, std::size_t channel,
                                     const float* model) const noexcept {
  constexpr std::size_t kBlock = LobeLanes::kBlock;
  const std::size_t channels = last_channel_ - first_channel_, first = block * kBlock;
  const float* targets = losses_.targets.data() + 2 * (block * channels + channel) * kBlock;
  return {.first = targets,
          .second = targets + kBlock,
          .model = model,
          .cos_theta_i = losses_.cos_theta_i.data() + first,
          .picture_weight = losses_.picture_weight.data() + first,
          .pair_weight = losses_.pair_weight.data() + first};
}

ErrorTerms RefineSystem::errors(const Eigen::VectorXd& x) const {
  const LobeLanes::Values values = lanes_.values(x);
  const std::size_t channels = last_channel_ - first_channel_;
  std::vector<ErrorTerms> partial(chunk_count(lanes_.blocks(), kChunk));
  for_each_chunk(lanes_.blocks(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    LobeLanes::Block at = lanes_.block();
    float gradient[LobeLanes::kBlock], curvature[LobeLanes::kBlock];
    for (std::size_t b = begin; b < end; ++b)
      for (std::size_t c = 0; c < channels; ++c) {
        lanes_.evaluate(values, b, c, at);
        add_losses(loss_, loss_inputs(b, c, at.total.data()), LobeLanes::kBlock, {}, partial[chunk], gradient,
                   curvature);
      }
  });
  ErrorTerms means{};
  for (const ErrorTerms& p : partial)
    for (std::size_t k = 0; k < kErrorTerms; ++k) means[k] += p[k];
  for (std::size_t k = 0; k < kErrorTerms; ++k) {
    const double weight = k < 2 ? picture_weight_ : pair_weight_;
    means[k] = weight > 0 ? means[k] / weight : 0;
  }
  return means;
}

template <class Visit>
void RefineSystem::for_each_slope(const LobeLanes::Values& values, const ErrorTerms& derivatives,
                                  std::size_t begin, std::size_t end, Visit visit) const {
  LobeLanes::Block at = lanes_.block();
  ErrorTerms sums{};
  float gradient[LobeLanes::kBlock], curvature[LobeLanes::kBlock];
  for (std::size_t b = begin; b < end; ++b)
    for (std::size_t c = 0; c < last_channel_ - first_channel_; ++c) {
      lanes_.evaluate(values, b, c, at);
      add_losses(loss_, loss_inputs(b, c, at.total.data()), LobeLanes::kBlock, derivatives, sums, gradient,
                 curvature);
      lanes_.differentiate(at);
      visit(b, c, at, gradient, curvature);
    }
}

void RefineSystem::find_normal(const Eigen::VectorXd& x, const ErrorTerms& means, std::size_t first_unknown,
                               std::size_t last_unknown, Normal& normal) const {
  const LobeLanes::Values values = lanes_.values(x);
  const std::size_t unknowns = last_unknown - first_unknown, channels = last_channel_ - first_channel_;
  const ErrorTerms derivatives = loss_.derivatives(means, picture_weight_, pair_weight_);
  const std::size_t every =
      std::max<std::size_t>(1, set_.size() * channels / (kMatrixPairsPerUnknown * unknowns));
  LaneRows& factor = normal.factor;
  factor.layout(lanes_, first_unknown, last_unknown, (set_.size() + every - 1) / every * channels);

  constexpr std::size_t kBlock = LobeLanes::kBlock;
  const std::size_t group_size = (lanes_.blocks() + kMostGroups - 1) / kMostGroups;
  std::vector<AlignedVector<float>> gradient(chunk_count(lanes_.blocks(), group_size));
  for_each_chunk(lanes_.blocks(), group_size, [&](std::size_t group, std::size_t begin, std::size_t end) {
    gradient[group].resize(values.lambdas.size());
    for_each_slope(values, derivatives, begin, end,
                   [&](std::size_t b, std::size_t c, const LobeLanes::Block& at, const float* slopes,
                       const float* curvatures) {
                     lanes_.add_transposed(at, slopes, b, c, gradient[group]);
                     const std::size_t last = std::min((b + 1) * kBlock, set_.size());
                     for (std::size_t i = (b * kBlock + every - 1) / every * every; i < last; i += every)
                       factor.set(lanes_, i, c, i / every * channels + c, at,
                                  std::sqrt(curvatures[i % kBlock] * static_cast<float>(every)));
                   });
  });
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(size_));
  for (const AlignedVector<float>& part : gradient) lanes_.gather(part, sum);
  const auto segment = [&](const Eigen::VectorXd& v) {
    return v.segment(static_cast<Eigen::Index>(first_unknown), static_cast<Eigen::Index>(unknowns));
  };
  normal.gradient = segment(sum).cwiseProduct(segment(values.lambda));
  find_gram(factor, segment(values.lambda), normal.matrix);
}

RefineSystem::Rows RefineSystem::rows(const Eigen::VectorXd& x, const ErrorTerms& means) const {
  const ErrorTerms derivatives = loss_.derivatives(means, picture_weight_, pair_weight_);
  const std::size_t channels = last_channel_ - first_channel_, block_size = lanes_.shares_of_block();
  Rows result;
  result.values = lanes_.values(x);
  result.gradient = result.diagonal = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(size_));
  result.shares.resize(lanes_.blocks() * channels * block_size);
  const std::size_t group_size = (lanes_.blocks() + kMostGroups - 1) / kMostGroups;
  std::vector<AlignedVector<float>> gradient(chunk_count(lanes_.blocks(), group_size)),
      diagonal(gradient.size());
  for_each_chunk(lanes_.blocks(), group_size, [&](std::size_t group, std::size_t begin, std::size_t end) {
    gradient[group].resize(result.values.lambdas.size());
    diagonal[group].resize(result.values.lambdas.size());
    for_each_slope(result.values, derivatives, begin, end,
                   [&](std::size_t b, std::size_t c, const LobeLanes::Block& at, const float* slopes,
                       const float* curvatures) {
                     lanes_.add_transposed(at, slopes, b, c, gradient[group]);
                     lanes_.add_squares(at, curvatures, b, c, diagonal[group]);
                     float* shares = result.shares.data() + (b * channels + c) * block_size;
                     for (std::size_t k = 0; k < block_size; ++k)
                       shares[k] =
                           at.product[k] * std::sqrt(curvatures[k / LobeLanes::kLanes % LobeLanes::kBlock]);
                   });
  });
  for (std::size_t g = 0; g < gradient.size(); ++g) {
    lanes_.gather(gradient[g], result.gradient);
    lanes_.gather(diagonal[g], result.diagonal);
  }
  const Eigen::VectorXd& lambda = result.values.lambda;
  result.gradient = result.gradient.cwiseProduct(lambda);
  result.diagonal = result.diagonal.cwiseProduct(lambda.cwiseProduct(lambda));
  return result;
}

template <class Visit>
void RefineSystem::for_each_roughness_row(Visit visit) const {
  for (const TableUnknowns& table : tables_)
    for (std::size_t c = 0; c < table.copies; ++c)
      for (std::size_t r = 0; r < table.rows.size(); ++r)
        visit(table, c, table.rows.starts[r], table.rows.starts[r + 1]);
}

double RefineSystem::roughness(const Eigen::VectorXd& x) const {
  double sum = 0;
  for_each_roughness_row([&](const TableUnknowns& t, std::size_t c, std::uint32_t begin, std::uint32_t end) {
    double row = 0;
    for (std::uint32_t a = begin; a < end; ++a)
      row += t.rows.coefficients[a] * x[static_cast<Eigen::Index>(t.base + t.rows.nodes[a] * t.stride + c)];
    sum += t.share * row * row;
  });
  return sum;
}

Eigen::VectorXd RefineSystem::roughness_matrix_times(const Eigen::VectorXd& v) const {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(v.size());
  for_each_roughness_row([&](const TableUnknowns& t, std::size_t c, std::uint32_t begin, std::uint32_t end) {
    const auto place = [&](std::uint32_t a) {
      return static_cast<Eigen::Index>(t.base + t.rows.nodes[a] * t.stride + c);
    };
    double row = 0;
    for (std::uint32_t a = begin; a < end; ++a) row += t.rows.coefficients[a] * v[place(a)];
    for (std::uint32_t a = begin; a < end; ++a) y[place(a)] += t.share * row * t.rows.coefficients[a];
  });
  return y;
}

Eigen::VectorXd RefineSystem::roughness_diagonal() const {
  Eigen::VectorXd d = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(size_));
  for_each_roughness_row([&](const TableUnknowns& t, std::size_t c, std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t a = begin; a < end; ++a)
      d[static_cast<Eigen::Index>(t.base + t.rows.nodes[a] * t.stride + c)] +=
          t.share * t.rows.coefficients[a] * t.rows.coefficients[a];
  });
  return d;
}

void RefineSystem::add_roughness_matrix(double scale, std::size_t first, Eigen::MatrixXd& matrix) const {
  const std::size_t last = first + static_cast<std::size_t>(matrix.rows());
  for_each_roughness_row([&](const TableUnknowns& t, std::size_t c, std::uint32_t begin, std::uint32_t end) {
    if (t.base < first || t.base >= last) return;
    const auto place = [&](std::uint32_t a) {
      return static_cast<Eigen::Index>(t.base + t.rows.nodes[a] * t.stride + c - first);
    };
    for (std::uint32_t a = begin; a < end; ++a)
      for (std::uint32_t b = begin; b < end; ++b)
        matrix(place(a), place(b)) += scale * t.share * t.rows.coefficients[a] * t.rows.coefficients[b];
  });
}

}  // namespace burnish
