// SPDX-License-Identifier: Apache-2.0
#pragma once

// For the library's own files: JSON before it is text.

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <burnish/fitting/fit_report.h>

namespace burnish {

/// Returns the JSON that to_json writes.
nlohmann::ordered_json json_of(const FitReport& report);

/// Text of it; indent as nlohmann's dump. File names need not be UTF-8: what is not is replaced.
std::string to_text(const nlohmann::ordered_json& json, int indent);

}  // namespace burnish
