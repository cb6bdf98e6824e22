// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/factors/model_spec.h>
#include <burnish/fitting/one_lobe/homomorphic.h>
#include <burnish/fitting/refinement/training_set.h>

namespace burnish {

/// A factored BRDF during a fit: the logarithms of its tables, which include the lobes' scales. Every value is
/// positive for all logarithms.
struct LogModel {
  ModelSpec spec;
  std::size_t channels = 0;
  std::vector<std::vector<double>> log_values;  ///< of table t: [node * step(t) + channel]

  /// Returns the channels of a table: 1 where it is shared.
  std::size_t step(std::size_t table) const noexcept { return spec.tables[table].shared ? 1 : channels; }
  /// Returns true if some table is shared and so couples the channels.
  bool any_shared() const noexcept {
    return channels > 1 && std::ranges::any_of(spec.tables, &ModelSpec::TableSpec::shared);
  }
};

/// Fits one lobe log-linearly to the set, with `values` in place of its own. Throws as fit_homomorphic does.
LogModel fit_one_lobe(const ModelSpec& spec, const TrainingSet& set, const std::vector<float>& values,
                      const HomomorphicOptions& options);

/// Splits lobe `lobe` in two that add up to it: its table over theta_d is multiplied with a step from 1 to 0
/// (or 0 to 1) at tan(theta_d / 2) = `centre`, the other tables are copied. The new tables are named
/// `suffix` after the old; tables named in `common`, not all of the lobe's, serve both. A lobe without a 1-D
/// table over theta_d of its own is split in two halves.
LogModel with_lobe_split(LogModel model, std::size_t lobe, double centre, const std::string& suffix,
                         std::span<const std::string> common = {});

/// Returns the model in the tables of `spec`. Tables of the same name and shape hold the same functions, whatever
/// their size and warp; others are 1 everywhere.
/// A table that becomes common to all lobes, and so loses its number, starts as the first lobe's. A table that
/// becomes shared by the channels starts as their mean; each channel's deviation goes to a table of the lobe's own.
LogModel resampled(const LogModel& model, const ModelSpec& spec);

/// Returns the tables' logarithms and the lobes as from_log_tables takes them, in each table's format, or `format`.
std::vector<Table> log_tables(const LogModel& model, TableFormat format);
std::vector<Lobe> log_scaled_lobes(const LogModel& model);

/// Rounds each table to its own format, or to `format`; see format_of and from_log_tables.
FactoredBrdf to_brdf(const LogModel& model, TableFormat format);

}  // namespace burnish
