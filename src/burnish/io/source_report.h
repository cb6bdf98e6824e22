// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/metrics/albedo.h>
#include <burnish/reflectance/statistics.h>
#include <burnish/source.h>

namespace burnish {

/// The shares of light from one direction that a part reflects or transmits, in [0, 1]; of a colour the luminance.
struct TotalAt {
  double theta_i = 0, phi_i = 0;
  double direct =
      0;  ///< into the mirror direction or straight on: a file's own statement, or as light_shares has it
  double scattered = 0;
};

/// The totals of one part and band, at theta_i 0, 30 and 60 degrees, phi_i 0.
struct PartTotals {
  BsdfBlock block;
  std::vector<TotalAt> totals;
};

/// Returns the totals of the block that was read. Values that are not known count as zero.
PartTotals totals_of(const Source& source);

/// Everything that the report says about a source, which must outlive the report.
struct SourceReport {
  const Source& source;
  std::vector<AlbedoAt> albedos;  ///< at theta_i 0, 30 and 60 degrees; up to 5 % unknown counts as the rest
  ReciprocityError reciprocity;   ///< over 20,000 pairs
  const FactoredBrdf* model;      ///< nullptr if the source is no model
  std::optional<double> mirror_asymmetry;  ///< reflectance/mirror_asymmetry.h; for isotropic sources
  /// Totals of the block that was read, if its format has several parts or states direct light. Callers add others.
  std::vector<PartTotals> totals;
  std::vector<std::string> warnings;  ///< the reader's, and one if more is reflected than received
};

SourceReport report_on(const Source& source);

/// Returns a JSON object, indented by two spaces, with these members:
/// - every source: name, format, description, channels, isotropic, lambda_nm, illuminant, conventions, warnings,
///   left_out, comments; samples, holes, negatives, most_negative, theta_i_deg and theta_o_deg (the ranges covered);
///   reciprocity_error, reciprocity_pairs, albedo (with clamped_albedo, the albedo if values below zero are cut);
/// - formats with several parts: part and band (of the block that was read), parts (part, band and read of each) and
///   totals (part, band, theta_i_deg, direct and scattered);
/// - isotropic sources: mirror_asymmetry;
/// - compressed BRDFs: bytes;
/// - models: table_bytes, lobes, scales, expression, reciprocal, tables.
std::string to_json(const SourceReport& report);

}  // namespace burnish
