// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <burnish/metrics/measurement_quality.h>

namespace burnish {

NodesQuality negatives_of(const MeasuredNodes& nodes) {
  NodesQuality quality;
  double squares = 0;
  std::size_t negative = 0;
  for (const double f : nodes.samples.values)
    if (f < 0) {
      squares += f * f;
      ++negative;
    }
  if (negative > 0) {
    quality.negative_share = static_cast<double>(negative) / static_cast<double>(nodes.samples.values.size());
    quality.negative_rms = std::sqrt(squares / static_cast<double>(negative));
  }
  return quality;
}

NodesQuality nodes_quality(const MeasuredNodes& nodes) {
  NodesQuality quality = negatives_of(nodes);
  if (nodes.samples.isotropic) {
    const LogCovariance covariance = choose_covariance(nodes);
    quality.held_out = held_out_figures(nodes, covariance);
    quality.held_out_incidences = held_out_incidences(nodes, covariance);
  }
  return quality;
}

MeasurementQuality quality_by_repeat(const Scorer& scorer, BrdfRef second, const MeasuredNodes& nodes) {
  MeasurementQuality quality{nodes_quality(nodes)};
  quality.repeated = true;
  quality.figures = scorer.score(second);
  quality.errors = scorer.pair_errors(second);
  return quality;
}

std::optional<ErrorFigures> exchanged_figures(const Scorer& scorer, BrdfRef raw) {
  constexpr double kRounding = 1e-6;  // of tables that are reciprocal by form
  const ErrorFigures half = scorer.score(raw);
  if (half.relative < kRounding) return {};
  ErrorFigures figures = half;
  figures.log_cos *= std::sqrt(2);
  figures.relative = std::expm1(std::sqrt(2) * std::log1p(half.relative));
  figures.rms_log *= std::sqrt(2);
  figures.rms *= std::sqrt(2);
  figures.mean_abs_log *= std::sqrt(2);
  figures.psnr -= 10 * std::log10(2);
  figures.ssim = 1 - 2 * (1 - half.ssim);  // near 1 it falls with the squared error
  return figures;
}

std::optional<MeasurementQuality> quality_by_exchange(const Scorer& scorer, BrdfRef raw,
                                                      const MeasuredNodes& nodes) {
  const std::optional<ErrorFigures> figures = exchanged_figures(scorer, raw);
  if (!figures) return {};
  MeasurementQuality quality{nodes_quality(nodes)};
  quality.figures = *figures;
  quality.errors = scorer.pair_errors(raw);
  for (PairError& error : quality.errors) {
    error.log_cos *= std::sqrt(2);
    error.log_ratio *= std::sqrt(2);
    error.abs_log *= std::sqrt(2);
    error.log_ratio_sq *= 2;
    error.difference_sq *= 2;
  }
  return quality;
}

}  // namespace burnish
