// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include <burnish/factors/model_file.h>
#include <burnish/fitting/fit.h>

namespace burnish {

/// The model as its file keeps it, with the report as notes. Throws Error where a baseline was fitted.
Model to_model(Fit fit);

/// The baseline likewise. Throws Error where a factored BRDF was fitted.
Baseline to_baseline(Fit fit);

/// The bytes of the file of that name: format_model_as's, or format_baseline's where a baseline was fitted.
std::string format_fit(const Fit& fit, const std::filesystem::path& name = {});

/// The JSON that `burnish fit --json` prints, indented by two: the report's, then output, model, bytes; of a
/// model table_bytes, textures, fetches, smallest_factor, reciprocal and its shader's cost, where shaders can show it;
/// of a baseline table_reads and multiplies; file_bytes, the size of the file that was written, where it is given; and
/// seconds.
std::string summary_json(const Fit& fit, const std::string& output, double seconds,
                         std::optional<std::size_t> file_bytes = {});

}  // namespace burnish
