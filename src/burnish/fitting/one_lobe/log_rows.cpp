// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/error.h>
#include <burnish/fitting/one_lobe/log_rows.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

constexpr std::size_t kSamplesAtOnce = 1024;

// Reweighting: errors below kSmallError count as squares, a step changes a value by at most e^kLongestStep,
// and the model is taken as at least this share of the floor.
constexpr double kSmallError = 0.2, kLongestStep = 3, kMinShare = 1e-2;

constexpr double kNearest = 1.0 / 64;  // of HomomorphicOptions::backscatter

}  // namespace

LogRows RowMaker::make(std::size_t begin, std::size_t end) const {
  const std::vector<FactorUse>& uses = spec->lobes.front();
  const auto channels = source->channels;
  // Memory is reserved for all samples.
  LogRows rows;
  const std::size_t most = end - begin;
  rows.node.reserve(most * uses.size());
  rows.fx.reserve(most * uses.size());
  rows.fy.reserve(most * uses.size());
  rows.fz.reserve(most * uses.size());
  rows.target.reserve(most * channels);
  rows.weight.reserve(most * (current ? channels : 1));

  rows.weight_channels = current ? channels : 1;
  // Samples are read in blocks. Those above the horizon with weight give their lookups, then targets and weights.
  std::vector<double> model(channels);
  std::vector<DirectionPair> pairs(kSamplesAtOnce);
  std::vector<double> values(kSamplesAtOnce * channels), sample_weights(kSamplesAtOnce);
  for (std::size_t at = begin; at < end; at += kSamplesAtOnce) {
    const std::size_t n = std::min(kSamplesAtOnce, end - at);
    source->fill(at, std::span(pairs).first(n), std::span(values).first(n * channels),
                 std::span(sample_weights).first(n));
    for (std::size_t i = 0; i < n; ++i) {
      const auto [wi, wo] = pairs[i];
      if (!(sample_weights[i] > 0) || wi.z <= 0 || wo.z <= 0) continue;
      ++rows.size;
      for (const FactorUse& use : uses) {
        const Lookup at_nodes = locate(spec->tables[use.table].layout, use, wi, wo);
        rows.node.push_back(static_cast<std::uint32_t>(at_nodes.node));
        rows.fx.push_back(static_cast<float>(at_nodes.fx));
        rows.fy.push_back(static_cast<float>(at_nodes.fy));
        rows.fz.push_back(static_cast<float>(at_nodes.fz));
      }
      const std::span<const double> f = std::span(values).subspan(i * channels, channels);
      const double weight = sample_weights[i] * emphasis(pairs[i]);
      if (current)
        add_reweighted(pairs[i], f, weight, model, rows);
      else
        add_plain(f, weight, rows);
    }
  }
  return rows;
}

double RowMaker::emphasis(const DirectionPair& pair) const noexcept {
  if (backscatter <= 0) return 1;
  // The number of evenly spread samples within theta_d of wi = wo grows with its square. The number in each step of
  // sqrt(theta_d) grows with its power of 1.5, so the weight is its inverse.
  const double share = angle_between(pair.wi, pair.wo) / 2 / backscatter;
  return share < 1 ? std::pow(std::max(share, kNearest), -1.5) : 1;
}

void RowMaker::add_plain(std::span<const double> f, double weight, LogRows& rows) const {
  // The target is log(max(f, 0) + floor).
  rows.weight.push_back(static_cast<float>(weight));
  for (const double v : f) rows.target.push_back(static_cast<float>(std::log(std::max(v, 0.0) + floor)));
}

void RowMaker::add_reweighted(const DirectionPair& pair, std::span<const double> f, double weight,
                              std::span<double> model, LogRows& rows) const {
  current->eval(pair.wi, pair.wo, model);
  for (std::size_t c = 0; c < f.size(); ++c) {
    // Linearized about log m, the error of log(f + floor) is a row of target log m + error / slope and weight
    // slope^2. Dividing that by |error| makes the squares count as absolute values [Daubechies 2010].
    const double m = std::max(model[c], floor * kMinShare);
    const double slope = m / (m + error_floor);
    const double error = std::log((std::max(f[c], 0.0) + error_floor) / (m + error_floor));
    const double step = std::clamp(error / slope, -kLongestStep, kLongestStep);
    rows.target.push_back(static_cast<float>(std::log(m) + step));
    rows.weight.push_back(
        static_cast<float>(weight * slope * slope / std::max(std::abs(error), kSmallError)));
  }
}

}  // namespace burnish
