// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>

namespace burnish {

/// JSON no deeper than `most`: what writes it again calls itself for each level. Throws Error for what is deeper, the
/// library's error for what is no JSON.
inline nlohmann::json parse_shallow(const std::string& text, int most) {
  bool shallow = true;
  const auto measure = [&](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
    return shallow = shallow && depth <= most;
  };
  nlohmann::json json = nlohmann::json::parse(text, measure);
  if (!shallow) throw Error(fmt::format("expected JSON at most {} deep, found more", most));
  return json;
}

}  // namespace burnish
