#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/measured_nodes.h>
#include <burnish/reflectance/node_figures.h>

namespace burnish {

/// What measured nodes tell of one another, and of noise.
struct NodesQuality {
  /// Of the function between nodes at nodes that it has not seen (held_out_figures), and at incidences (held_out_incidences);
  /// none of anisotropic sources.
  std::optional<NodeFigures> held_out, held_out_incidences;
  double negative_share = 0;  ///< of the nodes' values
  double negative_rms = 0;    ///< their root mean square, 1/sr: noise about nothing
};

/// Of their negatives alone.
NodesQuality negatives_of(const MeasuredNodes& nodes);
/// Of the function whose covariance predicts best (choose_covariance). Throws Error as that does.
NodesQuality nodes_quality(const MeasuredNodes& nodes);

/// How good a measurement is: what another one of the same surface scores against it. A model that scores better
/// follows its noise.
struct MeasurementQuality : NodesQuality {
  bool repeated = false;          ///< by a second scan; else estimated from exchanged directions
  ErrorFigures figures;           ///< of the second scan, or estimated
  std::vector<PairError> errors;  ///< of the pairs that figures are means of
};

/// Scores a second scan, symmetrized like the scorer's reference; of the first scan's nodes the rest.
MeasurementQuality quality_by_repeat(const Scorer& scorer, BrdfRef second, const MeasuredNodes& nodes);

/// The same without a second scan, as far as exchanged directions tell (exchanged_figures).
std::optional<MeasurementQuality> quality_by_exchange(const Scorer& scorer, BrdfRef raw,
                                                      const MeasuredNodes& nodes);

/// What a second scan would score. Physics has f(wi, wo) = f(wo, wi), so where noise of the two is independent and
/// of size s, f differs from the mean of both, the scorer's reference, by s / sqrt(2), and the mean of a second scan
/// from it by s: what `raw` scores against the reference, times sqrt(2) (squares 2). What errs alike both ways is not
/// seen, so this is the least that the measurement is off by. Nothing where the reference is `raw` itself to rounding: a
/// source kept raw, or one that is reciprocal by form, such as a table of half/difference cells of half a circle.
std::optional<ErrorFigures> exchanged_figures(const Scorer& scorer, BrdfRef raw);

}  // namespace burnish
