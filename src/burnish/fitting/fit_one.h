// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <burnish/factors/model_spec.h>
#include <burnish/fitting/fit.h>
#include <burnish/fitting/fitted_model.h>
#include <burnish/fitting/fitted_source.h>

namespace burnish {

/// The paper's fit [HomomorphicBrdf]: one lobe, log-linear. The smoothness is the options', or the one that predicts
/// best of scattered samples and where `how` asks for it. Throws Error as fit_homomorphic does.
FittedLobe fit_one(const FittedSource& source, const FitOptions& options, ModelSpec spec,
                   const LogLinear& how, const Stages& stages);

/// The lobe for scattered samples that predicts best within the bytes and, if they are given, the fetches. Throws Error
/// as plan_scattered does. Precondition: source.samples() is not null.
FittedLobe fit_scattered(const FittedSource& source, const FitOptions& options, const LogLinear& how,
                         std::uint64_t bytes, std::optional<int> fetches, const Stages& stages);

/// Returns true if a table of the spec is a hemisphere.
bool has_disk(const ModelSpec& spec);

}  // namespace burnish
