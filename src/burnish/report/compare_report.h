// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/image/svg_plot.h>
#include <burnish/metrics/albedo.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/metrics/measurement_quality.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/expected_error.h>
#include <burnish/reflectance/node_figures.h>
#include <burnish/source.h>

namespace burnish {

/// One candidate of a comparison; the BRDF must outlive it.
struct ComparedModel {
  std::string name;
  BrdfRef brdf;
  std::optional<std::uint64_t> bytes = {};  ///< of its tables as stored
  std::string note = {};                    ///< how it was made: factors, fit time; one line, may be empty
  /// The model whose tables a report shows; null for any other BRDF. It must outlive this.
  const FactoredBrdf* factored = nullptr;
};

/// The share of light from one direction (radians) that is reflected, by the reference and by a model.
struct ComparedAlbedo {
  double theta_i = 0, phi_i = 0;
  DirectionalAlbedo reference, model;
};

/// The figures of one candidate.
struct ComparedFigures {
  std::string name;
  std::optional<std::uint64_t> bytes;
  std::string note;
  ErrorFigures figures;
  std::vector<ComparedAlbedo> albedos;    ///< at 0, 15, ... 75 degrees, see albedo_curve
  std::optional<NodeFigures> nodes = {};  ///< where the reference is a measurement
  /// The error against the truth behind scattered samples; nothing for other references.
  std::optional<ExpectedError> expected = {};
};

/// The psnr of lit spheres, in dB, of their discs alone: the black background, equal in every picture, is left out. A
/// disc has pi / 4 of its frame.
double psnr_of_disc(double psnr) noexcept;

/// The text in place of the measurement's own score, where nothing tells it (exchanged_figures).
inline constexpr std::string_view kCannotBeTold = "cannot be told from this file";

/// The facts known of a reference that is a measurement.
struct Measurement {
  MeasuredNodes nodes;                        ///< those that are scored
  NodeFigures itself;                         ///< the reference's own figures there, made reciprocal
  std::optional<MeasurementQuality> quality;  ///< none where nothing tells
  /// The function between scattered samples, which knows how far it may be off; null for other references. It must
  /// outlive this.
  const KrigedNodes* between = nullptr;
  std::optional<ExpectedError> expected = {};  ///< the error of that function itself
};

/// Returns the facts known of an opened reference, which is scored as `scored` (reciprocal or as it is). Only the nodes
/// that `only` names are kept, where it is not empty (parse_node_part). Returns nothing for a formula or model, unless
/// nodes are asked for. Throws Error where nodes are asked for and there are none. The source must outlive the result.
std::optional<Measurement> measurement_of(const Source& source, BrdfRef scored, bool nodes_asked = false,
                                          const std::string& only = {});

/// Figures of every model, in their order; at the nodes too where a measurement is given. Throws Error as Scorer.
std::vector<ComparedFigures> compare_models(const Scorer& scorer, std::span<const ComparedModel> models,
                                            const Measurement* measurement = nullptr);

/// Returns a JSON list of objects with these members:
/// - model, bytes (null if unknown), log_cos, relative, rms_log, mean_abs_log;
/// - psnr (null for equal pictures, where it is infinite), ssim, psnr_of_disc (likewise), unknown_fraction,
///   unknown_pixels;
/// - albedo, a list of theta_i_deg, phi_i_deg, reference and model, one number a channel, reference_unknown_fraction;
/// - note, if there is one;
/// - for a measurement, nodes (count, log_cos, relative, rms_log, rms, and the same as itself);
/// - for scattered samples, expected (relative, from_theta_i_deg, and the same as itself: see json_of(ExpectedError));
/// - for a measurement, measurement (repeated, log_cos, relative, rms_log, rms, psnr, ssim, negative_share,
///   negative_rms, held_out and held_out_incidences, each with the figures of nodes).
std::string to_json(std::span<const ComparedFigures> figures, const Measurement* measurement = nullptr);

/// Returns a JSON list of objects about the nodes alone: model, bytes (null if unknown), count, log_cos, relative,
/// rms_log, rms. The reference itself comes first. Throws Error as node_figures.
std::string nodes_json(const Measurement& measurement, std::span<const ComparedModel> models);

/// f over theta_o in the plane of incidence at theta_i (radians, in (0, pi/2)), reference and models, mean
/// over the channels, 1/sr on a logarithmic axis. theta_o is positive on the mirror's side; unknown and black
/// values are gaps.
Plot incidence_plane_plot(BrdfRef reference, std::span<const ComparedModel> models, double theta_i);

/// Albedo over theta_i, mean over the channels, of the reference and the models; each azimuth its own curve.
Plot albedo_plot(std::span<const ComparedFigures> figures);

/// Which half/difference angle an error is plotted over.
enum class ErrorAxis { theta_h, theta_d };

/// Mean |ln((f + floor) / (f^ + floor))| in bins of 5 degrees; errors[i] belong to models[i]. The measurement's own
/// error is a dashed line.
Plot error_plot(std::span<const ComparedModel> models, std::span<const std::vector<PairError>> errors,
                ErrorAxis axis, const MeasurementQuality* measurement = nullptr);

/// Writes the folder of a comparison, made if missing:
/// - index.html (needs nothing beside the folder) and report.json;
/// - overview.png (reference and all models) and model_N.png (reference, model and difference under the three lights
///   and the dome);
/// - spheres/ (each picture by itself) and factors/ (each table of a factored model, see factor_image);
/// - plots as SVG and PNG, of a measurement also with what it would score itself.
///
/// Returns the figures. Throws Error as Scorer, or if there is no model or the folder cannot be written.
std::vector<ComparedFigures> write_report(const std::filesystem::path& folder,
                                          const std::string& reference_name, const Scorer& scorer,
                                          std::span<const ComparedModel> models,
                                          const Measurement* measurement = nullptr);

}  // namespace burnish
