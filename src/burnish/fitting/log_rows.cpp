#include <algorithm>
#include <cmath>

#include <burnish/error.h>
#include <burnish/fitting/log_rows.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

constexpr std::size_t kBlock = 1024;  // samples produced at a time

// Values at or below zero, as a share of the floor.
constexpr double kZeroShare = 1e-6;

}  // namespace

LogRows RowMaker::make(std::size_t begin, std::size_t end) const {
  const std::vector<FactorUse>& uses = spec->lobes.front();
  const auto channels = static_cast<std::size_t>(source->channels);
  LogRows rows;
  const std::size_t most = end - begin;
  rows.node.reserve(most * uses.size());
  rows.fx.reserve(most * uses.size());
  rows.fy.reserve(most * uses.size());
  rows.target.reserve(most * channels);
  rows.weight.reserve(most * channels);

  std::vector<DirectionPair> pairs(kBlock);
  std::vector<double> values(kBlock * channels), sample_weights(kBlock);
  for (std::size_t at = begin; at < end; at += kBlock) {
    const std::size_t n = std::min(kBlock, end - at);
    source->fill(at, std::span(pairs).first(n), std::span(values).first(n * channels),
                 std::span(sample_weights).first(n));
    for (std::size_t i = 0; i < n; ++i) {
      const auto [wi, wo] = pairs[i];
      if (!(sample_weights[i] > 0) || wi.z <= 0 || wo.z <= 0) continue;
      ++rows.size;
      for (const FactorUse& use : uses) {
        const Lookup at_nodes = locate(spec->tables[static_cast<std::size_t>(use.table)].layout, use, wi, wo);
        rows.node.push_back(static_cast<std::uint32_t>(at_nodes.node));
        rows.fx.push_back(static_cast<float>(at_nodes.fx));
        rows.fy.push_back(static_cast<float>(at_nodes.fy));
      }
      for (std::size_t c = 0; c < channels; ++c) {
        const double f = std::max(values[i * channels + c], kZeroShare * weights.floor);
        const double share = f / (f + weights.floor);
        double weight = sample_weights[i] * share * share;
        if (weights.image > 0) {
          const double brightness = std::pow(std::min(1.0, f * wi.z / weights.white), 1 / 2.2);
          weight *= 1 + weights.image * brightness * brightness;
        }
        rows.target.push_back(static_cast<float>(std::log(f)));
        rows.weight.push_back(static_cast<float>(weight));
      }
    }
  }
  return rows;
}

Unknowns number_unknowns(const ModelSpec& spec, int channels) {
  Unknowns unknowns;
  for (const ModelSpec::TableSpec& table : spec.tables) {
    unknowns.base.push_back(unknowns.count);
    unknowns.channels.push_back(table.shared ? 1 : static_cast<std::size_t>(channels));
    unknowns.count += table.layout.node_count() * unknowns.channels.back();
  }
  return unknowns;
}

double estimate_white(const SampleSource& source) {
  constexpr std::size_t kMostSamples = 100'000;
  constexpr double kSmallestCosine = 0.5, kShare = 0.97;
  const auto channels = static_cast<std::size_t>(source.channels);
  const std::size_t stride = std::max<std::size_t>(1, source.count / kMostSamples);
  const std::size_t count = source.count / stride;
  struct Entry {
    double radiance, weight;
  };
  std::vector<Entry> entries(count * channels);
  for_each_chunk(count, 4096, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<double> values(channels);
    for (std::size_t i = begin; i < end; ++i) {
      DirectionPair pair;
      double weight = 0;
      source.fill(i * stride, {&pair, 1}, values, {&weight, 1});
      const Vec3 h = half_vector(pair.wi, pair.wo);
      const bool seen = pair.wi.z > kSmallestCosine && pair.wo.z > kSmallestCosine;
      // sin(theta_h) d theta_h: the solid angle; samples are dense in theta_h like u^2, hence another root
      const double solid_angle = std::sqrt(h.x * h.x + h.y * h.y) * std::sqrt(std::acos(std::min(h.z, 1.0)));
      for (std::size_t c = 0; c < channels; ++c)
        entries[i * channels + c] = {values[c] * pair.wi.z, seen ? weight * solid_angle : 0};
    }
  });
  std::ranges::sort(entries, {}, &Entry::radiance);
  double total = 0, below = 0;
  for (const Entry& e : entries) total += e.weight;
  for (const Entry& e : entries) {
    below += e.weight;
    if (below >= kShare * total && e.radiance > 0) return e.radiance;
  }
  return 1;
}

}  // namespace burnish
