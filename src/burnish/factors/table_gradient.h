// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// Returns one array of zeros a table, each as long as the table's values.
std::vector<std::vector<double>> zero_table_gradient(const FactoredBrdf& brdf);

/// Adds to `gradient` the derivatives of the sum over channels of weight[c] f_c(wi, wo) by each value of each table.
/// gradient[t] is laid out as the values of table t. The tables count as real numbers: rounding to their formats has no
/// derivative. The derivative by a value's logarithm is the value times this one. Below the horizon f is 0, and nothing
/// is added. Preconditions: weight has channels() entries, gradient is as zero_table_gradient returns it.
void add_table_gradient(const FactoredBrdf& brdf, Vec3 wi, Vec3 wo, std::span<const double> weight,
                        std::span<std::vector<double>> gradient) noexcept;

}  // namespace burnish
