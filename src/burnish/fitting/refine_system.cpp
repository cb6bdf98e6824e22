#include <algorithm>
#include <cmath>
#include <numbers>

#include <burnish/fitting/refine_system.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

constexpr std::size_t kChunk = 2048;
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
std::vector<LaneProduct::Unknowns> unknowns_of(const LogModel& model, std::size_t channels) {
  std::vector<LaneProduct::Unknowns> unknowns;
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
      lookups_(lookups),
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
  for (std::size_t k = 0; k < lookups.lookups.size(); ++k) {
    const auto t = static_cast<std::size_t>(lookups.lookups[k].table);
    const TableLayout& layout = model.spec.tables[t].layout;
    const bool line = layout.shape == TableShape::line;
    places_.push_back({.base = tables_[t].base,
                       .stride = tables_[t].stride,
                       .channel_stride = tables_[t].copies > 1 ? std::size_t{1} : 0,
                       .next_row = line ? 0 : static_cast<std::size_t>(layout.width) * tables_[t].stride,
                       .table = t,
                       .place = lookups.place_of[k]});
    term_pairs_ += line ? 1 : 2;
  }
  for (std::size_t i = 0; i < set.size(); ++i)
    (i < set.picture_count ? picture_weight_ : pair_weight_) +=
        set.weights[i] * static_cast<double>(channels);
  targets_.resize(set.size() * channels);
  for_each_chunk(set.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t c = 0; c < channels; ++c)
        targets_[i * channels + c] =
            loss.target(set.values[i * static_cast<std::size_t>(set.channels) + first_channel + c],
                        set.pairs[i].wi.z, i < set.picture_count);
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

RefineSystem::Scratch RefineSystem::scratch() const {
  return {.factor = std::vector<double>(places_.size()),
          .share = std::vector<double>(places_.size()),
          .product = std::vector<double>(lookups_.lobes.size()),
          .terms = std::vector<TermPair>(term_pairs_)};
}

double RefineSystem::evaluate(const double* lambda, std::size_t pair, std::size_t channel,
                              Scratch& at) const noexcept {
  const Lookups::Place* found = lookups_.of_pair(pair);
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const Place& place = places_[k];
    const auto [node, fx, fy] = found[place.place * Lookups::kBlock];
    const double x = fx;
    const double* v = lambda + place.base + node * place.stride + channel * place.channel_stride;
    double factor = v[0] + x * (v[place.stride] - v[0]);
    if (place.next_row > 0) {
      const double* next = v + place.next_row;
      factor += fy * (next[0] + x * (next[place.stride] - next[0]) - factor);
    }
    at.factor[k] = factor;
  }
  double total = 0;
  for (std::size_t j = 0; j < at.product.size(); ++j) {
    double product = 1;
    for (const std::size_t k : lookups_.lobes[j]) product *= at.factor[k];
    at.product[j] = product;
    total += product;
  }
  return total;
}

void RefineSystem::differentiate(const double* lambda, std::size_t pair, std::size_t channel, double total,
                                 Scratch& at) const noexcept {
  std::ranges::fill(at.share, 0);
  for (std::size_t j = 0; j < at.product.size(); ++j)
    for (const std::size_t k : lookups_.lobes[j]) at.share[k] += at.product[j];
  const Lookups::Place* found = lookups_.of_pair(pair);
  auto term = at.terms.begin();
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const Place& place = places_[k];
    const auto [node, x, y] = found[place.place * Lookups::kBlock];
    const double fx = x, fy = y;
    const std::size_t first = place.base + node * place.stride + channel * place.channel_stride;
    const auto push = [&](std::size_t unknown, double share) {
      *term++ = {.unknown = unknown,
                 .stride = place.stride,
                 .value = {share * (1 - fx) * lambda[unknown], share * fx * lambda[unknown + place.stride]}};
    };
    const double share = at.share[k] /= total * at.factor[k];
    push(first, share * (1 - fy));
    if (place.next_row > 0) push(first + place.next_row, share * fy);
  }
}

ErrorTerms RefineSystem::errors(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd lambda = x.array().exp();
  const std::size_t channels = last_channel_ - first_channel_;
  std::vector<ErrorTerms> partial(chunk_count(set_.size(), kChunk));
  for_each_chunk(set_.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    Scratch at = scratch();
    const ErrorTerms none{};
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t c = 0; c < channels; ++c)
        loss_.add(targets_[i * channels + c], evaluate(lambda.data(), i, c, at), set_.pairs[i].wi.z,
                  i < set_.picture_count, set_.weights[i], none, partial[chunk]);
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
void RefineSystem::for_each_slope(const Eigen::VectorXd& lambda, const ErrorTerms& derivatives,
                                  std::size_t begin, std::size_t end, Visit visit) const {
  const std::size_t channels = last_channel_ - first_channel_;
  Scratch at = scratch();
  ErrorTerms sums{};
  for (std::size_t i = begin; i < end; ++i)
    for (std::size_t c = 0; c < channels; ++c) {
      const double model = evaluate(lambda.data(), i, c, at);
      const PictureLoss::Slope slope = loss_.add(targets_[i * channels + c], model, set_.pairs[i].wi.z,
                                                 i < set_.picture_count, set_.weights[i], derivatives, sums);
      differentiate(lambda.data(), i, c, model, at);
      visit(i, c, slope, at);
    }
}

void RefineSystem::find_normal(const Eigen::VectorXd& x, const ErrorTerms& means, std::size_t first_unknown,
                               std::size_t last_unknown, Normal& normal) const {
  const Eigen::VectorXd lambda = x.array().exp();
  const std::size_t unknowns = last_unknown - first_unknown;
  const std::size_t channels = last_channel_ - first_channel_;
  const ErrorTerms derivatives = loss_.derivatives(means, picture_weight_, pair_weight_);
  const std::size_t every =
      std::max<std::size_t>(1, set_.size() * channels / (kMatrixPairsPerUnknown * unknowns));
  PairedRows& factor = normal.factor;
  factor.pairs.clear();
  std::vector<std::size_t> kept;  // term pairs that the factor has
  std::size_t term_pair = 0;
  for (const Place& place : places_) {
    const TableUnknowns& table = tables_[place.table];
    for (int row = 0; row < (place.next_row > 0 ? 2 : 1); ++row, ++term_pair) {
      if (table.base < first_unknown || table.base >= last_unknown) continue;
      kept.push_back(term_pair);
      factor.pairs.push_back(
          {.first = table.base - first_unknown, .count = table.nodes * table.copies, .stride = table.stride});
    }
  }
  factor.rows = (set_.size() + every - 1) / every * channels;
  factor.unknown.resize(kept.size() * factor.rows);
  factor.value.resize(factor.unknown.size());

  const std::size_t group_size = (set_.size() + kMostGroups - 1) / kMostGroups;
  std::vector<Eigen::VectorXd> gradient(chunk_count(set_.size(), group_size));
  for_each_chunk(set_.size(), group_size, [&](std::size_t group, std::size_t begin, std::size_t end) {
    Eigen::VectorXd& sum = gradient[group].setZero(static_cast<Eigen::Index>(unknowns));
    for_each_slope(lambda, derivatives, begin, end,
                   [&](std::size_t i, std::size_t c, PictureLoss::Slope slope, const Scratch& at_pair) {
                     const bool in_matrix = i % every == 0;
                     const double root = std::sqrt(slope.curvature * static_cast<double>(every));
                     std::size_t at = i / every * channels + c;
                     for (const std::size_t p : kept) {
                       const TermPair& pair = at_pair.terms[p];
                       const std::size_t unknown = pair.unknown - first_unknown;
                       for (std::size_t k = 0; k < 2; ++k)
                         sum[static_cast<Eigen::Index>(unknown + k * pair.stride)] +=
                             slope.gradient * pair.value[k];
                       if (!in_matrix) continue;
                       factor.unknown[at] = static_cast<std::uint32_t>(unknown);
                       factor.value[at] = {static_cast<float>(root * pair.value[0]),
                                           static_cast<float>(root * pair.value[1])};
                       at += factor.rows;
                     }
                   });
  });
  normal.gradient = gradient.front();
  for (std::size_t g = 1; g < gradient.size(); ++g) normal.gradient += gradient[g];
  find_gram(factor, unknowns, normal.matrix);
}

RefineSystem::Rows RefineSystem::rows(const Eigen::VectorXd& x, const ErrorTerms& means) const {
  const auto n = static_cast<Eigen::Index>(size_);
  const ErrorTerms derivatives = loss_.derivatives(means, picture_weight_, pair_weight_);
  Rows result;
  result.lambda = x.array().exp();
  result.gradient = result.diagonal = Eigen::VectorXd::Zero(n);
  result.slopes = lanes_.slopes();
  const std::size_t group_size = (set_.size() + kMostGroups - 1) / kMostGroups;
  std::vector<Eigen::VectorXd> gradient(chunk_count(set_.size(), group_size)), diagonal(gradient.size());
  for_each_chunk(set_.size(), group_size, [&](std::size_t group, std::size_t begin, std::size_t end) {
    gradient[group] = diagonal[group] = Eigen::VectorXd::Zero(n);
    for_each_slope(result.lambda, derivatives, begin, end,
                   [&](std::size_t i, std::size_t c, PictureLoss::Slope slope, const Scratch& at) {
                     const double root = std::sqrt(slope.curvature);
                     for (std::size_t k = 0; k < places_.size(); ++k)
                       result.slopes[lanes_.slot(i, c, k)] = static_cast<float>(root * at.share[k]);
                     for (const TermPair& pair : at.terms)
                       for (std::size_t k = 0; k < 2; ++k) {
                         const auto unknown = static_cast<Eigen::Index>(pair.unknown + k * pair.stride);
                         const double value = pair.value[k];
                         gradient[group][unknown] += slope.gradient * value;
                         diagonal[group][unknown] += slope.curvature * value * value;
                       }
                   });
  });
  for (std::size_t g = 0; g < gradient.size(); ++g) {
    result.gradient += gradient[g];
    result.diagonal += diagonal[g];
  }
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
