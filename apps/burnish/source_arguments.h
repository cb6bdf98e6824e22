// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include <burnish/io/open_source.h>

namespace burnish::cli {

/// The BRDF argument of a verb, and the options to open it.
struct SourceArguments {
  std::string spec;
  OpenOptions options;

  /// Opens the BRDF and prints the reader's warnings on standard error.
  Source open() const;
};

/// Adds the positional BRDF and the options of OpenOptions to a verb. `arguments` must outlive the parse.
void add_source_arguments(CLI::App& verb, SourceArguments& arguments);

/// Adds the options without the positional argument.
void add_open_options(CLI::App& verb, OpenOptions& options);

/// Adds only the option for the light under which spectra become RGB.
void add_illuminant(CLI::App& verb, OpenOptions& options);

}  // namespace burnish::cli
