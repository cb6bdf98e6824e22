// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace burnish::cli {

/// Describes the making of a model as lines for people, each a word and its text. `notes` is a model's JSON object
/// (Model::notes). Returns nothing for "{}". Returns the text itself where it is no JSON object.
std::vector<std::pair<std::string, std::string>> notes_lines(const std::string& notes);

/// Returns the reason why a solver ended, in words that follow its number of steps: "all that were planned" where this
/// number was the limit. `reason` is a name by to_string(StopReason); other texts are returned unchanged.
std::string ending_text(const std::string& reason);

}  // namespace burnish::cli
