#include <algorithm>
#include <cmath>

#include <burnish/fitting/refine_system.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

constexpr std::size_t kChunk = 2048;
constexpr std::size_t kPartialBytes = std::size_t{32} << 20;  // of matrices summed side by side
constexpr std::size_t kMostGroups = 16;
constexpr std::size_t kPairsPerUnknown = 4;  // fewer are not worth a matrix of their own
// Of many pairs an even part makes a matrix good enough for a step; the slope is that of all.
constexpr std::size_t kMatrixPairsPerUnknown = 40;
constexpr std::size_t kColumns = 64;  // of matrices, added up together

// ln of a table's largest value over the smallest that its format, or the general floor, leaves.
double log_range(TableFormat format) {
  return format == TableFormat::unorm8 ? std::log(255.0) : -std::log(kTableFloor);
}

// rgb9e5 holds a channel down to one unit of a mantissa of at least 256.
const double kLogMantissa = std::log(256.0);

// What the other channels of a texel ask of each value of an rgb9e5 table, whose channels are stored with one
// geometric mean.
std::vector<double> shared_exponent_floors(const std::vector<double>& logs, std::size_t channels) {
  std::vector<double> mean(channels), floors(logs.size());
  const double nodes = static_cast<double>(logs.size()) / static_cast<double>(channels);
  for (std::size_t i = 0; i < logs.size(); ++i) mean[i % channels] += logs[i] / nodes;
  for (std::size_t i = 0; i < logs.size(); i += channels) {
    double largest = logs[i] - mean[0];
    for (std::size_t c = 1; c < channels; ++c) largest = std::max(largest, logs[i + c] - mean[c]);
    for (std::size_t c = 0; c < channels; ++c) floors[i + c] = largest - kLogMantissa + mean[c];
  }
  return floors;
}

}  // namespace

Lookups find_lookups(const ModelSpec& spec, const TrainingSet& set) {
  Lookups found;
  for (const auto& lobe : spec.lobes) found.uses += lobe.size();
  found.node.resize(found.uses * set.size());
  found.fx.resize(found.node.size());
  found.fy.resize(found.node.size());
  for_each_chunk(set.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::size_t k = begin * found.uses;
    for (std::size_t i = begin; i < end; ++i)
      for (const auto& lobe : spec.lobes)
        for (const FactorUse& use : lobe) {
          const TableLayout& layout = spec.tables[static_cast<std::size_t>(use.table)].layout;
          const Lookup at = locate(layout, use, set.pairs[i].wi, set.pairs[i].wo);
          found.node[k] = static_cast<std::uint32_t>(at.node);
          found.fx[k] = static_cast<float>(at.fx);
          found.fy[k] = static_cast<float>(at.fy);
          ++k;
        }
  });
  return found;
}

RefineSystem::RefineSystem(const LogModel& model, const TrainingSet& set, const Lookups& lookups,
                           const PictureLoss& loss, TableFormat format, std::size_t first_channel,
                           std::size_t last_channel)
    : set_(set),
      lookups_(lookups),
      loss_(loss),
      first_channel_(first_channel),
      last_channel_(last_channel),
      lobes_(model.spec.lobes.size()) {
  const std::size_t channels = last_channel - first_channel;
  for (std::size_t t = 0; t < model.spec.tables.size(); ++t) {
    const auto& table = model.spec.tables[t];
    const std::size_t copies = model.step(t) == 1 ? 1 : channels;
    tables_.push_back({.base = size_,
                       .stride = copies,
                       .copies = copies,
                       .nodes = table.layout.node_count(),
                       .step = model.step(t),
                       .share = table.smooth_share,
                       .log_range = log_range(format_of(table, format)),
                       .rows = smoothness_rows(table.layout)});
    size_ += tables_.back().nodes * copies;
    floors_.resize(size_, -INFINITY);
    if (model.step(t) == 1 || format_of(table, format) != TableFormat::rgb9e5) continue;
    const std::vector<double> floors = shared_exponent_floors(model.log_values[t], model.step(t));
    for (std::size_t n = 0; n < tables_.back().nodes; ++n)
      for (std::size_t c = 0; c < copies; ++c)
        floors_[tables_.back().base + n * copies + c] = floors[n * model.step(t) + first_channel + c];
  }
  for (std::size_t j = 0; j < lobes_; ++j)
    for (const FactorUse& use : model.spec.lobes[j]) {
      const auto t = static_cast<std::size_t>(use.table);
      const TableLayout& layout = model.spec.tables[t].layout;
      uses_.push_back({.base = tables_[t].base,
                       .stride = tables_[t].stride,
                       .channel_stride = tables_[t].copies > 1 ? std::size_t{1} : 0,
                       .next_row = layout.shape == TableShape::line
                                       ? 0
                                       : static_cast<std::size_t>(layout.width) * tables_[t].stride,
                       .lobe = j});
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
      double largest = *first;
      for (std::size_t n = 0; n < table.nodes; ++n) largest = std::max(largest, first[n * table.stride]);
      const double* floor = floors_.data() + table.base + c;
      for (std::size_t n = 0; n < table.nodes; ++n)
        first[n * table.stride] =
            std::max({first[n * table.stride], largest - table.log_range, floor[n * table.stride]});
    }
}

double RefineSystem::evaluate(const double* lambda, std::size_t pair, std::size_t channel,
                              std::span<double> factor, std::span<double> product) const noexcept {
  std::fill(product.begin(), product.end(), 1.0);
  for (std::size_t s = 0; s < uses_.size(); ++s) {
    const Use& use = uses_[s];
    const std::size_t k = pair * uses_.size() + s;
    const double* at = lambda + use.base + lookups_.node[k] * use.stride + channel * use.channel_stride;
    double v = at[0] + lookups_.fx[k] * (at[use.stride] - at[0]);
    if (use.next_row > 0) {
      const double* next = at + use.next_row;
      v += lookups_.fy[k] * (next[0] + lookups_.fx[k] * (next[use.stride] - next[0]) - v);
    }
    factor[s] = v;
    product[use.lobe] *= v;
  }
  double total = 0;
  for (const double p : product) total += p;
  return total;
}

std::size_t RefineSystem::differentiate(const double* lambda, std::size_t pair, std::size_t channel,
                                        double total, std::span<const double> factor,
                                        std::span<const double> product,
                                        std::span<Term> terms) const noexcept {
  std::size_t count = 0;
  for (std::size_t s = 0; s < uses_.size(); ++s) {
    const Use& use = uses_[s];
    const std::size_t k = pair * uses_.size() + s;
    const std::size_t first = use.base + lookups_.node[k] * use.stride + channel * use.channel_stride;
    const double share = product[use.lobe] / (total * factor[s]), fx = lookups_.fx[k], fy = lookups_.fy[k];
    const auto push = [&](std::size_t unknown, double weight) {
      terms[count++] = {static_cast<std::uint32_t>(unknown),
                        static_cast<float>(weight * share * lambda[unknown])};
    };
    push(first, (1 - fx) * (1 - fy));
    push(first + use.stride, fx * (1 - fy));
    if (use.next_row == 0) continue;
    push(first + use.next_row, (1 - fx) * fy);
    push(first + use.next_row + use.stride, fx * fy);
  }
  return count;
}

ErrorTerms RefineSystem::errors(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd lambda = x.array().exp();
  const std::size_t channels = last_channel_ - first_channel_;
  std::vector<ErrorTerms> partial(chunk_count(set_.size(), kChunk));
  for_each_chunk(set_.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::vector<double> factor(uses_.size()), product(lobes_);
    const ErrorTerms none{};
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t c = 0; c < channels; ++c)
        loss_.add(targets_[i * channels + c], evaluate(lambda.data(), i, c, factor, product),
                  set_.pairs[i].wi.z, i < set_.picture_count, set_.weights[i], none, partial[chunk]);
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

void RefineSystem::find_normal(const Eigen::VectorXd& x, const ErrorTerms& means, std::size_t first_unknown,
                               std::size_t last_unknown, std::vector<Normal>& partial) const {
  const Eigen::VectorXd lambda = x.array().exp();
  const std::size_t unknowns = last_unknown - first_unknown;
  const auto n = static_cast<Eigen::Index>(unknowns);
  const std::size_t channels = last_channel_ - first_channel_;
  const ErrorTerms derivatives = loss_.derivatives(means, picture_weight_, pair_weight_);
  const std::size_t groups =
      std::clamp<std::size_t>(std::min(kPartialBytes / (unknowns * unknowns * sizeof(double)),
                                       set_.size() * channels / (kPairsPerUnknown * unknowns)),
                              2, kMostGroups);
  const std::size_t every =
      std::max<std::size_t>(1, set_.size() * channels / (kMatrixPairsPerUnknown * unknowns));
  const std::size_t group_size = (set_.size() + groups - 1) / groups;
  partial.resize(chunk_count(set_.size(), group_size));
  // Each pair of terms is added once, below or above the diagonal; twice the diagonal's own is taken off it.
  for_each_chunk(set_.size(), group_size, [&](std::size_t group, std::size_t begin, std::size_t end) {
    Normal& sum = partial[group];
    sum.gradient.setZero(n);
    sum.matrix.setZero(n, n);
    std::vector<double> factor(uses_.size()), product(lobes_);
    std::vector<Term> terms(4 * uses_.size());
    ErrorTerms sums{};
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t c = 0; c < channels; ++c) {
        const double model = evaluate(lambda.data(), i, c, factor, product);
        const PictureLoss::Slope slope =
            loss_.add(targets_[i * channels + c], model, set_.pairs[i].wi.z, i < set_.picture_count,
                      set_.weights[i], derivatives, sums);
        std::size_t count = differentiate(lambda.data(), i, c, model, factor, product, terms);
        if (unknowns < size_) {
          std::size_t kept = 0;
          for (std::size_t a = 0; a < count; ++a)
            if (terms[a].unknown >= first_unknown && terms[a].unknown < last_unknown) {
              terms[kept] = terms[a];
              terms[kept++].unknown -= static_cast<std::uint32_t>(first_unknown);
            }
          count = kept;
        }
        for (std::size_t a = 0; a < count; ++a)
          sum.gradient[terms[a].unknown] += slope.gradient * terms[a].value;
        if (i % every > 0) continue;
        const double curvature = slope.curvature * static_cast<double>(every);
        for (std::size_t a = 0; a < count; ++a) {
          const double value = terms[a].value, scaled = curvature * value;
          double* column = sum.matrix.data() + terms[a].unknown * unknowns;
          column[terms[a].unknown] += 0.5 * scaled * value;
          for (std::size_t b = a + 1; b < count; ++b) column[terms[b].unknown] += scaled * terms[b].value;
        }
      }
  });
  Normal& total = partial.front();
  for_each_chunk(unknowns, kColumns, [&](std::size_t, std::size_t begin, std::size_t end) {
    const auto first = static_cast<Eigen::Index>(begin), count = static_cast<Eigen::Index>(end - begin);
    for (std::size_t g = 1; g < partial.size(); ++g)
      total.matrix.middleCols(first, count) += partial[g].matrix.middleCols(first, count);
  });
  for (std::size_t g = 1; g < partial.size(); ++g) total.gradient += partial[g].gradient;
  // both triangles become the sum of the two
  for (Eigen::Index column = 0; column < n; ++column)
    for (Eigen::Index row = 0; row <= column; ++row) {
      const double sum = total.matrix(row, column) + total.matrix(column, row);
      total.matrix(row, column) = total.matrix(column, row) = sum;
    }
}

RefineSystem::Rows RefineSystem::rows(const Eigen::VectorXd& x, const ErrorTerms& means) const {
  const Eigen::VectorXd lambda = x.array().exp();
  const auto n = static_cast<Eigen::Index>(size_);
  const std::size_t channels = last_channel_ - first_channel_;
  const ErrorTerms derivatives = loss_.derivatives(means, picture_weight_, pair_weight_);
  std::size_t width = 0;
  for (const Use& use : uses_) width += use.next_row > 0 ? 4 : 2;
  Rows result;
  result.gradient = result.diagonal = Eigen::VectorXd::Zero(n);
  result.unknown.resize(set_.size() * channels * width);
  result.value.resize(result.unknown.size());
  result.width = width;
  const std::size_t group_size = (set_.size() + kMostGroups - 1) / kMostGroups;
  std::vector<Eigen::VectorXd> gradient(chunk_count(set_.size(), group_size)), diagonal(gradient.size());
  for_each_chunk(set_.size(), group_size, [&](std::size_t group, std::size_t begin, std::size_t end) {
    gradient[group] = diagonal[group] = Eigen::VectorXd::Zero(n);
    std::vector<double> factor(uses_.size()), product(lobes_);
    std::vector<Term> terms(4 * uses_.size());
    ErrorTerms sums{};
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t c = 0; c < channels; ++c) {
        const double model = evaluate(lambda.data(), i, c, factor, product);
        const PictureLoss::Slope slope =
            loss_.add(targets_[i * channels + c], model, set_.pairs[i].wi.z, i < set_.picture_count,
                      set_.weights[i], derivatives, sums);
        const std::size_t count = differentiate(lambda.data(), i, c, model, factor, product, terms);
        const double root = std::sqrt(slope.curvature);
        const std::size_t start = (i * channels + c) * width;
        for (std::size_t a = 0; a < count; ++a) {
          gradient[group][terms[a].unknown] += slope.gradient * terms[a].value;
          diagonal[group][terms[a].unknown] += slope.curvature * terms[a].value * terms[a].value;
          result.unknown[start + a] = terms[a].unknown;
          result.value[start + a] = static_cast<float>(root * terms[a].value);
        }
      }
  });
  for (std::size_t g = 0; g < gradient.size(); ++g) {
    result.gradient += gradient[g];
    result.diagonal += diagonal[g];
  }
  return result;
}

Eigen::VectorXd RefineSystem::apply(const Rows& rows, const Eigen::VectorXd& v) const {
  const std::size_t width = rows.width, count = rows.value.size() / width;
  const std::size_t group_size = (count + kMostGroups - 1) / kMostGroups;
  std::vector<Eigen::VectorXd> partial(chunk_count(count, group_size));
  for_each_chunk(count, group_size, [&](std::size_t group, std::size_t begin, std::size_t end) {
    partial[group] = Eigen::VectorXd::Zero(v.size());
    for (std::size_t r = begin; r < end; ++r) {
      const std::uint32_t* unknown = rows.unknown.data() + r * width;
      const float* value = rows.value.data() + r * width;
      double sum = 0;
      for (std::size_t a = 0; a < width; ++a) sum += value[a] * v[unknown[a]];
      for (std::size_t a = 0; a < width; ++a) partial[group][unknown[a]] += sum * value[a];
    }
  });
  for (std::size_t g = 1; g < partial.size(); ++g) partial.front() += partial[g];
  return partial.front();
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
