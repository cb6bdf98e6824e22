#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <burnish/fitting/fit_request.h>

namespace burnish::cli {

/// The options that say how something is fitted, as they are typed: words and flags by the options' names.
struct FitArguments {
  std::map<std::string, std::vector<std::string>> words;
  std::map<std::string, bool> flags;

  /// Whether the option of that name was typed.
  bool given(const std::string& name) const;
};

/// Adds an option for each row of fit_option_table. `arguments` must outlive the parse, and stay where it is.
void add_fit_arguments(CLI::App& verb, FitArguments& arguments);

/// What they ask for; opens the book. Throws CLI::ValidationError for what the options refuse, and Error for a book
/// that is none.
FitRequest request_of(const FitArguments& arguments);

}  // namespace burnish::cli
