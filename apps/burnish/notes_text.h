#pragma once

#include <string>
#include <utility>
#include <vector>

namespace burnish::cli {

/// What a model's notes say about its making, as lines that a person reads: a word and what it says. `notes` is a
/// model's JSON object (Model::notes); nothing of "{}", and of what is no object the text itself.
std::vector<std::pair<std::string, std::string>> notes_lines(const std::string& notes);

/// How a solver ended, in words that fit behind its number of steps: "all that were planned" where it was stopped by
/// their number. `reason` is what to_string(StopReason) says; others are repeated.
std::string ending_text(const std::string& reason);

}  // namespace burnish::cli
