// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace burnish::cli {

/// Prints the JSON of `--json`: one value, indented by two. Bytes that are no UTF-8, as in some names, become U+FFFD.
void print_as_json(const nlohmann::ordered_json& json);

}  // namespace burnish::cli
