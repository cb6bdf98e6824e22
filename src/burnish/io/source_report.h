#pragma once

#include <optional>
#include <string>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/metrics/albedo.h>
#include <burnish/reflectance/statistics.h>
#include <burnish/source.h>

namespace burnish {

/// Everything that is to be said about a source, which must outlive it.
struct SourceReport {
  const Source& source;
  std::vector<AlbedoAt> albedos;  ///< at theta_i 0, 30 and 60 degrees; up to 5 % that is unknown as the rest
  ReciprocityError reciprocity;   ///< over 20,000 pairs
  const FactoredBrdf* model;      ///< nullptr where it is none
  std::optional<double> mirror_asymmetry;  ///< reflectance/mirror_asymmetry.h; of isotropic sources
  std::vector<std::string> warnings;       ///< the reader's, and that more is reflected than received
};

SourceReport report_on(const Source& source);

/// A JSON object, indented by two spaces: name, format, description, channels, isotropic, lambda_nm, illuminant,
/// conventions, warnings, left_out, comments, samples, holes, negatives, most_negative, theta_i_deg and theta_o_deg
/// (ranges covered), reciprocity_error, reciprocity_pairs, albedo (of it clamped_albedo, where values below zero are
/// cut). Of formats with several parts also part and band (of what was read) and parts (part, band and read of each).
/// Of isotropic sources also mirror_asymmetry; of a compressed BRDF bytes; of a model table_bytes, lobes, scales,
/// expression, reciprocal, tables.
std::string to_json(const SourceReport& report);

}  // namespace burnish
