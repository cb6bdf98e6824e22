// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <burnish/fitting/fit_request.h>

namespace burnish::cli {

/// The options of a fit as they were typed: words and flags, by the options' names.
struct FitArguments {
  std::map<std::string, std::vector<std::string>> words;
  std::map<std::string, bool> flags;

  /// Returns true if the option of that name was typed.
  bool given(const std::string& name) const;
};

/// Adds an option for each row of fit_option_table. `arguments` must outlive the parse and must not move.
void add_fit_arguments(CLI::App& verb, FitArguments& arguments);

/// Converts the typed options to a request, and opens the book. Throws CLI::ValidationError for options that contradict
/// each other or are out of range. Throws Error for a file that is no book.
FitRequest request_of(const FitArguments& arguments);

}  // namespace burnish::cli
