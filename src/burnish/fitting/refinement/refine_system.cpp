// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <burnish/fitting/refinement/refine_system.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

// With many pairs per unknown, every k-th pair makes a matrix good enough for a step. The slope uses all
// pairs.
constexpr std::size_t kMatrixPairsPerUnknown = 40;

// Returns ln(largest / smallest) of the values that a table may hold: by its format, or by the general
// floor.
double log_range(TableFormat format) {
  return format == TableFormat::unorm8 ? std::log(255.0) : -std::log(kTableFloor);
}

// rgb9e5 holds a channel down to one unit of a mantissa of at least 256.
const double kLogMantissa = std::log(256.0);
constexpr double kHeadroom = std::numbers::ln2;  // the least that a texel's largest channel may rise

// Returns for each rgb9e5 texel the range of logarithms that one shared exponent holds, wherever its
// channels move.
// The logarithms are relative to the channels' means, which are divided out before the texels are stored.
std::vector<LogRange> shared_exponent_ranges(const std::vector<double>& logs, std::size_t channels) {
  // The mean of each channel's logarithms is what storing divides out.
  std::vector<double> mean(channels);
  const double nodes = static_cast<double>(logs.size()) / static_cast<double>(channels);
  for (std::size_t i = 0; i < logs.size(); ++i) mean[i % channels] += logs[i] / nodes;
  std::vector<LogRange> ranges;
  for (std::size_t i = 0; i < logs.size(); i += channels) {
    // The range is centred on the texel's channels, and its top leaves at least kHeadroom above the largest
    // of them.
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

// Numbers the tables' nodes for a system of `channels` channels of a model.
std::vector<LobeLanes::NumberedTable> numbered_tables(const LogModel& model, std::size_t channels) {
  const Numbering numbering = number_nodes(model.spec, channels);
  std::vector<LobeLanes::NumberedTable> tables;
  for (std::size_t t = 0; t < model.spec.tables.size(); ++t)
    tables.push_back({numbering.tables[t], model.spec.tables[t].layout});
  return tables;
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
      lanes_(numbered_tables(model, channels()), lookups, channels()),
      albedo_(model.spec, lanes_.tables(), set.albedo, set.channels, first_channel, channels()) {
  add_tables(model, format);
  // The sums of weights over pixels and over other pairs turn sums of errors into means.
  for (std::size_t i = 0; i < set.size(); ++i)
    (i < set.picture_count ? picture_weight_ : pair_weight_) +=
        set.weights[i] * static_cast<double>(channels());
  fill_losses();
}

void RefineSystem::add_tables(const LogModel& model, TableFormat format) {
  for (const auto& [number, layout] : lanes_.tables()) {
    const std::size_t t = tables_.size();
    const auto& table = model.spec.tables[t];
    tables_.push_back({.number = number,
                       .nodes = layout.node_count(),
                       .step = model.step(t),
                       .share = table.smooth_share,
                       .log_range = log_range(format_of(table, format)),
                       .smoothness = smoothness_rows(layout, {.circle_z = table.circle_z})});
    size_ += tables_.back().nodes * number.copies;

    // Channels of an rgb9e5 texel share an exponent, so each unknown is limited to what that exponent holds.
    ranges_.resize(size_, {-INFINITY, INFINITY});
    if (model.step(t) == 1 || format_of(table, format) != TableFormat::rgb9e5) continue;
    const std::vector<LogRange> ranges = shared_exponent_ranges(model.log_values[t], model.step(t));
    for (std::size_t n = 0; n < tables_.back().nodes; ++n)
      for (std::size_t c = 0; c < number.copies; ++c) ranges_[number(n, c)] = ranges[n];
  }
}

void RefineSystem::fill_losses() {
  constexpr std::size_t kBlock = LobeLanes::kBlock;
  const std::size_t padded = lanes_.blocks() * kBlock;
  losses_.targets.resize(2 * padded * channels());
  losses_.cos_theta_i.resize(padded);
  losses_.picture_weight.resize(padded);
  losses_.pair_weight.resize(padded);
  for_each_chunk(
      set_.size(), Lookups::kBlocksATask * kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const bool picture = i < set_.picture_count;
          // A pair is a pixel or one of the other pairs. The weight of the other kind stays 0, which
          // switches its errors off.
          losses_.cos_theta_i[i] = static_cast<float>(set_.pairs[i].wi.z);
          (picture ? losses_.picture_weight : losses_.pair_weight)[i] = set_.weights[i];
          // The targets are the parts of each error that do not depend on the model. They are computed once.
          for (std::size_t c = 0; c < channels(); ++c) {
            const double f = set_.values[i * set_.channels + first_channel_ + c];
            const PictureLoss::Target target = loss_.target(f, set_.pairs[i].wi.z, picture);
            float* targets = losses_.targets.data() + 2 * (i / kBlock * channels() + c) * kBlock + i % kBlock;
            targets[0] = target.first;
            targets[kBlock] = target.second;
          }
        }
      });
}

// Calls visit(unknown, table, index in the table's log_values) for every unknown.
template <class Visit>
void RefineSystem::for_each_unknown(Visit visit) const {
  for (std::size_t t = 0; t < tables_.size(); ++t) {
    const auto& [number, nodes, step, share, log_range, smoothness] = tables_[t];
    for (std::size_t n = 0; n < nodes; ++n)
      for (std::size_t c = 0; c < number.copies; ++c)
        visit(static_cast<Eigen::Index>(number(n, c)), t, n * step + (step == 1 ? 0 : first_channel_ + c));
  }
}

Eigen::VectorXd RefineSystem::read(const LogModel& model) const {
  Eigen::VectorXd x(static_cast<Eigen::Index>(size_));
  for_each_unknown(
      [&](Eigen::Index unknown, std::size_t t, std::size_t at) { x[unknown] = model.log_values[t][at]; });
  return x;
}

void RefineSystem::write(const Eigen::VectorXd& x, LogModel& model) const {
  for_each_unknown(
      [&](Eigen::Index unknown, std::size_t t, std::size_t at) { model.log_values[t][at] = x[unknown]; });
}

// Calls visit(unknown, largest, mean, log_range) for every unknown. The largest and the mean are over its
// table's channel; log_range is how far its table's values may lie below the largest.
template <class Visit>
void RefineSystem::for_each_limit(const Eigen::VectorXd& x, Visit visit) const {
  for (const SystemTable& table : tables_)
    for (std::size_t c = 0; c < table.number.copies; ++c) {
      const auto unknown = [&](std::size_t n) { return static_cast<Eigen::Index>(table.number(n, c)); };
      double largest = x[unknown(0)], mean = 0;
      for (std::size_t n = 0; n < table.nodes; ++n) {
        largest = std::max(largest, x[unknown(n)]);
        mean += x[unknown(n)] / static_cast<double>(table.nodes);
      }
      for (std::size_t n = 0; n < table.nodes; ++n) visit(unknown(n), largest, mean, table.log_range);
    }
}

void RefineSystem::clamp(Eigen::VectorXd& x) const {
  // Each value stays above the table's floor below its largest, and within the range of its texel's shared
  // exponent.
  for_each_limit(x, [&](Eigen::Index unknown, double largest, double mean, double log_range) {
    const LogRange& range = ranges_[static_cast<std::size_t>(unknown)];
    double& value = x[unknown];
    value = std::clamp(std::max(value, largest - log_range), mean + range.least, mean + range.most);
  });
}

RefineSystem::Box RefineSystem::box(const Eigen::VectorXd& x) const {
  Box box{.least = x, .most = x};
  for_each_limit(x, [&](Eigen::Index unknown, double largest, double mean, double log_range) {
    // The box holds x itself, so that a start outside the limits is not moved. Its floor is that of a table
    // whose largest value has risen by kHeadroom.
    const LogRange& range = ranges_[static_cast<std::size_t>(unknown)];
    const double top = largest + kHeadroom;
    box.least[unknown] = std::min(x[unknown], std::max(top - log_range, mean + range.least));
    box.most[unknown] = std::max(x[unknown], std::min(top, mean + range.most));
  });
  return box;
}

LossInputs RefineSystem::loss_inputs(std::size_t block, std::size_t channel,
                                     const float* model) const noexcept {
  constexpr std::size_t kBlock = LobeLanes::kBlock;
  const std::size_t first = block * kBlock;
  const float* targets = losses_.targets.data() + 2 * (block * channels() + channel) * kBlock;
  return {.first = targets,
          .second = targets + kBlock,
          .model = model,
          .cos_theta_i = losses_.cos_theta_i.data() + first,
          .picture_weight = losses_.picture_weight.data() + first,
          .pair_weight = losses_.pair_weight.data() + first};
}

ErrorTerms RefineSystem::errors(const Eigen::VectorXd& x) const {
  // Each group of blocks evaluates the model f^ and sums the weighted errors of its pairs.
  const LobeLanes::Values values = lanes_.values(x);
  std::vector<ErrorTerms> partial(chunk_count(lanes_.blocks(), Lookups::kBlocksATask));
  for_each_chunk(lanes_.blocks(), Lookups::kBlocksATask,
                 [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                   LobeLanes::Block at = lanes_.block();
                   float gradient[LobeLanes::kBlock], curvature[LobeLanes::kBlock];
                   for (std::size_t b = begin; b < end; ++b)
                     for (std::size_t c = 0; c < channels(); ++c) {
                       lanes_.evaluate(values, b, c, at);
                       add_losses(loss_, loss_inputs(b, c, at.total.data()), LobeLanes::kBlock, {},
                                  partial[chunk], gradient, curvature);
                     }
                 });
  // The groups' sums are joined in their order and divided by the weights, which gives the means.
  ErrorTerms sums;
  for (const ErrorTerms& part : partial) sums += part;
  const auto mean = [](double sum, double weight) { return weight > 0 ? sum / weight : 0; };
  return {.pictures = mean(sums.pictures, picture_weight_),
          .dimmed = mean(sums.dimmed, picture_weight_),
          .relative = mean(sums.relative, pair_weight_),
          .log_cos = mean(sums.log_cos, pair_weight_),
          .absolute = mean(sums.absolute, pair_weight_),
          .albedo = mean(albedo_.residuals(x).squaredNorm(), static_cast<double>(albedo_.size()))};
}

RefineSystem::AlbedoPart RefineSystem::albedo_part(const Eigen::VectorXd& x,
                                                   const ErrorTerms& derivatives) const {
  // With residuals r, slopes J = dr/dx and d the derivative by their sum of squares, the term adds 2 d J r
  // to the slope. It adds 2 d J J^T to the matrix, whose root is sqrt(2 d) J.
  const AlbedoTerm::Rows rows = albedo_.rows(x);
  return {.gradient = 2 * derivatives.albedo * (rows.slopes * rows.residuals),
          .roots = std::sqrt(2 * derivatives.albedo) * rows.slopes};
}

// Visits the slopes and curvatures of the blocks [begin, end), evaluating the model at `values`.
template <class Visit>
void RefineSystem::for_each_slope(const LobeLanes::Values& values, const ErrorTerms& derivatives,
                                  std::size_t begin, std::size_t end, Visit visit) const {
  LobeLanes::Block at = lanes_.block();
  ErrorTerms sums;
  float gradient[LobeLanes::kBlock], curvature[LobeLanes::kBlock];
  for (std::size_t b = begin; b < end; ++b)
    for (std::size_t c = 0; c < channels(); ++c) {
      // The model's values give each pair's slope and curvature by ln f^. The lobes' factors then become d
      // ln f^ / d factor.
      lanes_.evaluate(values, b, c, at);
      add_losses(loss_, loss_inputs(b, c, at.total.data()), LobeLanes::kBlock, derivatives, sums, gradient,
                 curvature);
      lanes_.differentiate(at);
      visit(b, c, at, gradient, curvature);
    }
}

void RefineSystem::gauss_newton_matrix(const Eigen::VectorXd& x, const ErrorTerms& means,
                                       std::size_t first_unknown, std::size_t last_unknown,
                                       GaussNewton& result) const {
  // `derivatives` holds the objective's derivative by each sum of errors: it weighs the slopes of all pairs.
  const LobeLanes::Values values = lanes_.values(x);
  const std::size_t unknowns = last_unknown - first_unknown;
  const ErrorTerms derivatives =
      loss_.derivatives(means, picture_weight_, pair_weight_, static_cast<double>(albedo_.size()));

  // The matrix is J^T J of rows for every `every`-th pair, so that there are about kMatrixPairsPerUnknown
  // rows an unknown.
  const std::size_t every =
      std::max<std::size_t>(1, set_.size() * channels() / (kMatrixPairsPerUnknown * unknowns));
  LaneRows& factor = result.factor;
  factor.layout(lanes_, first_unknown, last_unknown, (set_.size() + every - 1) / every * channels());

  // The slope sums over all pairs. Each kept row is scaled by sqrt(curvature * every) and stands for `every`
  // pairs.
  constexpr std::size_t kBlock = LobeLanes::kBlock;
  const std::size_t group_size = (lanes_.blocks() + kMaxGroups - 1) / kMaxGroups;
  std::vector<AlignedVector<float>> gradient(chunk_count(lanes_.blocks(), group_size));
  for_each_chunk(lanes_.blocks(), group_size, [&](std::size_t group, std::size_t begin, std::size_t end) {
    gradient[group].resize(values.lambdas.size());
    for_each_slope(values, derivatives, begin, end,
                   [&](std::size_t b, std::size_t c, const LobeLanes::Block& at, const float* slopes,
                       const float* curvatures) {
                     lanes_.add_transposed(at, slopes, b, c, gradient[group]);
                     const std::size_t last = std::min((b + 1) * kBlock, set_.size());
                     for (std::size_t i = (b * kBlock + every - 1) / every * every; i < last; i += every)
                       factor.set(lanes_, i, c, i / every * channels() + c, at,
                                  std::sqrt(curvatures[i % kBlock] * static_cast<float>(every)));
                   });
  });
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(size_));
  for (const AlignedVector<float>& part : gradient) lanes_.gather(part, sum);

  // The unknowns are logarithms x = ln lambda, so derivatives by lambda are multiplied by d lambda / dx =
  // lambda.
  const auto segment = [&](const Eigen::VectorXd& v) {
    return v.segment(static_cast<Eigen::Index>(first_unknown), static_cast<Eigen::Index>(unknowns));
  };
  result.gradient = segment(sum).cwiseProduct(segment(values.lambda));
  scaled_gram(factor, segment(values.lambda), result.matrix);
  // The albedo residuals add their slope, and a matrix of rank albedo_.size().
  if (albedo_.size() == 0) return;
  const AlbedoPart albedo = albedo_part(x, derivatives);
  result.gradient += segment(albedo.gradient);
  result.matrix.selfadjointView<Eigen::Lower>().rankUpdate(
      albedo.roots.middleRows(static_cast<Eigen::Index>(first_unknown), static_cast<Eigen::Index>(unknowns)));
}

RefineSystem::GaussNewtonFactor RefineSystem::gauss_newton_factor(const Eigen::VectorXd& x,
                                                                  const ErrorTerms& means) const {
  const ErrorTerms derivatives =
      loss_.derivatives(means, picture_weight_, pair_weight_, static_cast<double>(albedo_.size()));
  const std::size_t block_size = lanes_.shares_of_block();
  GaussNewtonFactor result;
  result.values = lanes_.values(x);
  result.gradient = result.diagonal = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(size_));
  result.shares.resize(lanes_.blocks() * channels() * block_size);

  // Each group sums the slope and the matrix's diagonal over its pairs. The shares times sqrt(curvature)
  // make the rows of J, which gauss_newton_times multiplies with without forming J^T J.
  const std::size_t group_size = (lanes_.blocks() + kMaxGroups - 1) / kMaxGroups;
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
                     float* shares = result.shares.data() + (b * channels() + c) * block_size;
                     for (std::size_t k = 0; k < block_size; ++k)
                       shares[k] =
                           at.product[k] * std::sqrt(curvatures[k / LobeLanes::kLanes % LobeLanes::kBlock]);
                   });
  });
  for (std::size_t g = 0; g < gradient.size(); ++g) {
    lanes_.gather(gradient[g], result.gradient);
    lanes_.gather(diagonal[g], result.diagonal);
  }

  // Derivatives by lambda become derivatives by x = ln lambda. The diagonal takes the square of that factor.
  const Eigen::VectorXd& lambda = result.values.lambda;
  result.gradient = result.gradient.cwiseProduct(lambda);
  result.diagonal = result.diagonal.cwiseProduct(lambda.cwiseProduct(lambda));
  AlbedoPart albedo = albedo_part(x, derivatives);
  result.gradient += albedo.gradient;
  result.diagonal += albedo.roots.rowwise().squaredNorm();
  result.albedo_roots = std::move(albedo.roots);
  return result;
}

// Calls visit(coefficients, unknown, table) for every roughness row. The row is the sum over k of
// coefficients[k] times the unknown numbered unknown(k); its square is a part of the roughness.
template <class Visit>
void RefineSystem::for_each_roughness_row(Visit visit) const {
  for (const SystemTable& table : tables_)
    for (std::size_t c = 0; c < table.number.copies; ++c)
      for (std::size_t r = 0; r < table.smoothness.size(); ++r) {
        const std::size_t begin = table.smoothness.starts[r], end = table.smoothness.starts[r + 1];
        const auto unknown = [&](std::size_t k) {
          return static_cast<Eigen::Index>(table.number(table.smoothness.nodes[begin + k], c));
        };
        visit(std::span(table.smoothness.coefficients).subspan(begin, end - begin), unknown, table);
      }
}

bool RefineSystem::has_volume() const noexcept {
  return std::ranges::any_of(lanes_.tables(), [](const LobeLanes::NumberedTable& table) {
    return table.layout.shape == TableShape::volume;
  });
}

void RefineSystem::fill(const Eigen::VectorXd& x, const ErrorTerms& means, double smooth,
                        NodeBand& band) const {
  const LobeLanes::Values values = lanes_.values(x);
  const ErrorTerms derivatives = loss_.derivatives(means, picture_weight_, pair_weight_);
  // The band holds the sum over pairs of curvature * slope slope^T. It preconditions only, so albedos are left out.
  band.set_zero();
  std::vector<NodeBand::Term> row;

  // Appends to `row` the derivative of ln f^ by each node that one lobe's lookup touches, 2, 4 or 8 of them.
  const auto add_terms = [&](const LobeLanes::Slot& slot, const Lookups::Place& place, std::size_t lane,
                             std::size_t channel, double slope) {
    const auto& [number, layout] = lanes_.tables()[lanes_.families()[slot.family].tables[lane]];
    const std::size_t row_nodes = slot.next_row / LobeLanes::kLanes,
                      layer_nodes = slot.next_layer / LobeLanes::kLanes;
    for (std::size_t k = 0; k < std::size_t{1} << axis_count(layout.shape); ++k) {
      // The bits of k pick the lower or upper node along x, y and z; the weight is that of linear
      // interpolation.
      const double weight = (k & 1 ? place.fx : 1 - place.fx) * (k & 2 ? place.fy : 1 - place.fy) *
                            (k & 4 ? place.fz : 1 - place.fz);
      const std::size_t node = place.node + (k & 1) + (k & 2 ? row_nodes : 0) + (k & 4 ? layer_nodes : 0);
      const std::size_t unknown = number(node, channel);
      // The unknown is x = ln lambda, so the derivative by lambda is multiplied by lambda.
      row.push_back({static_cast<std::uint32_t>(unknown),
                     slope * weight * values.lambda[static_cast<Eigen::Index>(unknown)]});
    }
  };
  for_each_slope(
      // Each pair collects the terms of all its lookups and adds their products, weighted with its curvature.
      values, derivatives, 0, lanes_.blocks(),
      [&](std::size_t b, std::size_t c, const LobeLanes::Block& at, const float*, const float* curvatures) {
        const Lookups::Place* places = lanes_.places(b);
        const std::size_t count = std::min(LobeLanes::kBlock, set_.size() - b * LobeLanes::kBlock);
        for (std::size_t i = 0; i < count; ++i) {
          row.clear();
          for (std::size_t s = 0; s < lanes_.slots().size(); ++s) {
            const LobeLanes::Slot& slot = lanes_.slots()[s];
            const float* slopes = at.factor.data() + s * LobeLanes::kBlockLanes + i * LobeLanes::kLanes;
            for (std::size_t l = 0; l < (slot.one_table ? 1 : LobeLanes::kLanes); ++l)
              if (lanes_.families()[slot.family].tables[l] != LobeLanes::kNone)
                add_terms(slot, places[slot.place * LobeLanes::kBlock + i], l, c,
                          static_cast<double>(slopes[l]));
          }
          if (curvatures[i] > 0) band.add_row(row, static_cast<double>(curvatures[i]));
        }
      });
  // Each roughness row adds its products too. Those outside the band go to the diagonal.
  for_each_roughness_row(
      [&](std::span<const double> coefficients, const auto& unknown, const SystemTable& table) {
        row.clear();
        for (std::size_t a = 0; a < coefficients.size(); ++a)
          row.push_back({static_cast<std::uint32_t>(unknown(a)), coefficients[a]});
        band.add_wide_row(row, smooth * table.share);
      });
}

std::optional<SparseGram> RefineSystem::sparse_gram(double smooth) const {
  std::optional<SparseGram> gram = SparseGram::of(lanes_);
  if (!gram) return {};
  // The roughness is quadratic, so its matrix does not change between steps: it is the constant of the
  // sparse matrix.
  std::vector<Eigen::Triplet<double>> entries;
  for_each_roughness_row([&](std::span<const double> row, const auto& unknown, const SystemTable& table) {
    for (std::size_t a = 0; a < row.size(); ++a)
      for (std::size_t b = 0; b < row.size(); ++b)
        if (unknown(a) >= unknown(b))
          entries.emplace_back(static_cast<int>(unknown(a)), static_cast<int>(unknown(b)),
                               smooth * table.share * row[a] * row[b]);
  });
  gram->set_constant(entries);
  return gram;
}

RefineSystem::SparseGaussNewton RefineSystem::linearize(const Eigen::VectorXd& x, const ErrorTerms& means,
                                                        SparseGram& gram) const {
  const LobeLanes::Values values = lanes_.values(x);
  const ErrorTerms derivatives =
      loss_.derivatives(means, picture_weight_, pair_weight_, static_cast<double>(albedo_.size()));
  constexpr std::size_t kBlock = LobeLanes::kBlock;
  // One pass over the pairs sums the slope J^T gradient and the matrix's entries.
  gram.set_zero();
  AlignedVector<float> slope(values.lambdas.size());
  for_each_slope(values, derivatives, 0, lanes_.blocks(),
                 [&](std::size_t b, std::size_t c, const LobeLanes::Block& at, const float* slopes,
                     const float* curvatures) {
                   lanes_.add_transposed(at, slopes, b, c, slope);
                   gram.add(b, at, curvatures, std::min(kBlock, set_.size() - b * kBlock));
                 });
  SparseGaussNewton result{.gradient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(size_)),
                           .albedo_roots = {}};
  lanes_.gather(slope, result.gradient);

  // The unknowns are x = ln lambda, so slope and matrix are scaled by lambda. Albedo rows are dense and stay
  // apart.
  result.gradient = result.gradient.cwiseProduct(values.lambda);
  gram.make(values.lambda);
  AlbedoPart albedo = albedo_part(x, derivatives);
  result.gradient += albedo.gradient;
  result.albedo_roots = std::move(albedo.roots);
  return result;
}

double RefineSystem::roughness(const Eigen::VectorXd& x) const {
  // The roughness is the sum over the tables of share times the squares of their rows.
  double sum = 0;
  for_each_roughness_row([&](std::span<const double> row, const auto& unknown, const SystemTable& table) {
    double value = 0;
    for (std::size_t a = 0; a < row.size(); ++a) value += row[a] * x[unknown(a)];
    sum += table.share * value * value;
  });
  return sum;
}

Eigen::VectorXd RefineSystem::roughness_matrix_times(const Eigen::VectorXd& v) const {
  // y = sum over rows of share * row (row . v), which is the product with the matrix without forming it.
  Eigen::VectorXd y = Eigen::VectorXd::Zero(v.size());
  for_each_roughness_row([&](std::span<const double> row, const auto& unknown, const SystemTable& table) {
    double value = 0;
    for (std::size_t a = 0; a < row.size(); ++a) value += row[a] * v[unknown(a)];
    for (std::size_t a = 0; a < row.size(); ++a) y[unknown(a)] += table.share * value * row[a];
  });
  return y;
}

Eigen::VectorXd RefineSystem::roughness_diagonal() const {
  // The diagonal is the sum over rows of share times the squared coefficients.
  Eigen::VectorXd d = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(size_));
  for_each_roughness_row([&](std::span<const double> row, const auto& unknown, const SystemTable& table) {
    for (std::size_t a = 0; a < row.size(); ++a) d[unknown(a)] += table.share * row[a] * row[a];
  });
  return d;
}

void RefineSystem::add_roughness_matrix(double scale, std::size_t first, Eigen::MatrixXd& matrix) const {
  const std::size_t last = first + static_cast<std::size_t>(matrix.rows());
  const auto start = static_cast<Eigen::Index>(first);
  for_each_roughness_row([&](std::span<const double> row, const auto& unknown, const SystemTable& table) {
    // Rows of tables outside the matrix's unknowns are skipped: a row never spans two tables.
    if (table.number.base < first || table.number.base >= last) return;
    for (std::size_t a = 0; a < row.size(); ++a)
      for (std::size_t b = 0; b < row.size(); ++b)
        matrix(unknown(a) - start, unknown(b) - start) += scale * table.share * row[a] * row[b];
  });
}

}  // namespace burnish
