#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <burnish/factors/model_spec.h>
#include <burnish/reflectance/sample_source.h>

namespace burnish {

/// The sets of factors of a lobe for scattered samples that read at most so many tables, any for 0: from "pqmr", the
/// fullest, to "q". At least one.
std::vector<std::string> scattered_factor_sets(int fetches, bool isotropic);

/// A lobe of these factors for the source: at most `most` texels within `bytes`, its p at least `least_p` nodes, its q
/// what the others leave. None where they do not suffice.
std::optional<ModelSpec> scattered_spec(const std::string& set, std::size_t bytes, std::size_t most,
                                        const SampleSource& source, TableFormat format, int least_p = 0);

/// What is compared: the fullest of the sets from coarse to fine, its p at last so fine that it tells incidences apart.
/// Where that is no choice, because the bytes hold few texels, or where fetches forbid a fuller one, the other sets too.
std::vector<ModelSpec> scattered_specs(const SampleSource& source, std::size_t bytes, TableFormat format,
                                       const std::vector<std::string>& sets);

/// A lobe about wi = wo, of at most so many fetches, any for 0: the most factors whose grids the bytes hold, as fine as
/// they do. None where all would be too coarse.
std::optional<ModelSpec> retro_spec_within(std::size_t bytes, const SampleSource& source, TableFormat format,
                                           int fetches);

/// The least bytes that plan_scattered has a model for: one table of the half vector, as coarse as can be.
std::size_t least_scattered_bytes(std::size_t channels, bool isotropic, TableFormat format);

}  // namespace burnish
