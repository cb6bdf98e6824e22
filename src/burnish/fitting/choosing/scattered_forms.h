// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <burnish/factors/model_spec.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

/// Returns the sets of factors of a lobe for scattered samples with at most `fetches` table reads; 0: any number.
/// They go from "pqmr", the fullest, to "q", and are at least one.
std::vector<std::string> scattered_factor_sets(int fetches, bool isotropic);

/// Returns a lobe of these factors for the source with at most `most` texels within `bytes`. Its p has at least
/// `least_p` nodes; its q takes the rest. None if the texels are too few.
std::optional<ModelSpec> scattered_spec(const std::string& set, std::size_t bytes, std::size_t most,
                                        const SampleSource& source, TableFormat format, int least_p = 0);

/// Returns the models to compare: the fullest set of factors, from coarse to fine, at last with a p fine enough to
/// distinguish incidences. If the bytes hold too few texels for a choice, or if fetches forbid a fuller set, the
/// other sets are compared too.
std::vector<ModelSpec> scattered_specs(const SampleSource& source, std::size_t bytes, TableFormat format,
                                       const std::vector<std::string>& sets);

/// Returns a lobe about wi = wo, of at most `fetches` reads; 0: any number. It has the most factors whose grids the
/// bytes hold, with grids as fine as possible. None if all grids would be too coarse.
std::optional<ModelSpec> retro_spec_within(std::size_t bytes, const SampleSource& source, TableFormat format,
                                           int fetches);

/// The smallest number of bytes for which plan_scattered has a model: one table of the half vector, as coarse as
/// possible.
std::size_t least_scattered_bytes(std::size_t channels, bool isotropic, TableFormat format);

}  // namespace burnish
