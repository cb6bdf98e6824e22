#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <burnish/factors/factored_brdf.h>
#include <burnish/factors/model_spec.h>
#include <burnish/fitting/training_set.h>

namespace burnish {

/// A factored BRDF on its way: the logarithms of its tables, the lobes' scales among them. Every value is
/// positive whatever the logarithms are.
struct LogModel {
  ModelSpec spec;
  int channels = 0;
  std::vector<std::vector<double>> log_values;  ///< of table t: [node * step(t) + channel]

  /// Channels of a table: 1 where it is shared.
  std::size_t step(std::size_t table) const noexcept {
    return spec.tables[table].shared ? 1 : static_cast<std::size_t>(channels);
  }
};

/// The log-linear fit of one lobe to the set with `values` in place of its own. Throws what fit_homomorphic
/// throws.
LogModel fit_one_lobe(const ModelSpec& spec, const TrainingSet& set, const std::vector<float>& values,
                      double smooth);

/// Puts the lobes of two models side by side. Tables keep their names and must differ in them.
LogModel joined(LogModel a, const LogModel& b);

/// Splits lobe `lobe` in two that add up to it: its table over theta_d is multiplied with a step from 1 to 0
/// (or 0 to 1) at tan(theta_d / 2) = `centre`, the other tables are copied. The new tables are named
/// `suffix` after the old. A lobe without a 1-D table over theta_d is split in two halves.
LogModel with_lobe_split(LogModel model, std::size_t lobe, double centre, const std::string& suffix);

/// The model in the tables of `spec`: those of the same name and shape hold the same functions, whatever
/// their size and warp, others are 1 everywhere.
LogModel resampled(const LogModel& model, const ModelSpec& spec);

/// Rounds each table to its own format, or to `format`; see format_of and from_log_tables.
FactoredBrdf to_brdf(const LogModel& model, TableFormat format);

}  // namespace burnish
