#pragma once

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include <burnish/fitting/fit.h>

namespace burnish::cli {

/// The options that say how something is fitted, as they are typed.
struct FitArguments {
  FitOptions options;
  OneLobe one_lobe{.model = ""};
  Budget budget{.bytes = {}};
  std::string bytes, method, target, hold_out, loss = "image", smooth = "default", format;
  std::shared_ptr<const MaterialBook> book;
  bool no_symmetrize = false;
};

/// Adds them to a verb. `arguments` must outlive the parse.
void add_fit_arguments(CLI::App& verb, FitArguments& arguments);

/// What they say of a source that is isotropic or not, without progress. Throws CLI::ValidationError where they
/// contradict each other.
FitOptions fit_options(const FitArguments& arguments, bool isotropic);

}  // namespace burnish::cli
