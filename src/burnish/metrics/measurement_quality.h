// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/measured_nodes.h>
#include <burnish/reflectance/node_figures.h>

namespace burnish {

/// Figures that measured nodes give of one another, and of noise.
struct NodesQuality {
  /// Errors of the function between nodes at nodes that it has not seen (held_out_figures), and at incidences
  /// (held_out_incidences); none for anisotropic sources.
  std::optional<NodeFigures> held_out, held_out_incidences;
  double negative_share = 0;  ///< of the nodes' values
  double negative_rms = 0;    ///< their root mean square, 1/sr: noise about nothing
};

/// Returns the figures of negative values alone.
NodesQuality negatives_of(const MeasuredNodes& nodes);
/// Returns the figures of the function whose covariance predicts best (choose_covariance). Throws Error as that does.
NodesQuality nodes_quality(const MeasuredNodes& nodes);

/// The quality of a measurement: the score of a second measurement of the same surface against it. A model that
/// scores better follows its noise.
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

/// Returns the figures that a second scan would score, estimated from exchanged directions.
/// Physics has f(wi, wo) = f(wo, wi). Let the noise of the two be independent and of size s. Then f differs by s /
/// sqrt(2) from the mean of both, which is the scorer's reference, and the mean of a second scan differs from it by
/// s. So the result is the score of `raw` against the reference, times sqrt(2) (squares 2).
/// Errors that are alike both ways are not seen, so this is the least error of the measurement. Returns nothing where
/// the reference is `raw` itself to rounding: a source kept raw, or one that is reciprocal by form, such as a table
/// of half/difference cells of half a circle.
std::optional<ErrorFigures> exchanged_figures(const Scorer& scorer, BrdfRef raw);

}  // namespace burnish
