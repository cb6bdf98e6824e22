#pragma once

#include <nlohmann/json_fwd.hpp>

namespace burnish::cli {

/// What `--json` prints: one value, indented by two; bytes of names that are no UTF-8 become U+FFFD.
void print_as_json(const nlohmann::ordered_json& json);

}  // namespace burnish::cli
