// SPDX-License-Identifier: Apache-2.0
#include "json_output.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace burnish::cli {

void print_as_json(const nlohmann::ordered_json& json) {
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace burnish::cli
