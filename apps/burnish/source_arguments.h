#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include <burnish/io/open_source.h>

namespace burnish::cli {

/// A BRDF argument and how to open it.
struct SourceArguments {
  std::string spec;
  OpenOptions options;

  /// Says on the standard error output what the reader warns of.
  Source open() const;
};

/// Adds the positional BRDF and the options of OpenOptions to a verb. `arguments` must outlive the parse.
void add_source_arguments(CLI::App& verb, SourceArguments& arguments);

/// The same without the positional argument.
void add_open_options(CLI::App& verb, OpenOptions& options);

/// Of these the light of spectra alone.
void add_illuminant(CLI::App& verb, OpenOptions& options);

}  // namespace burnish::cli
