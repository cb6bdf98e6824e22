#pragma once

#include <CLI/CLI.hpp>

#include <burnish/error.h>

namespace burnish::cli {

/// f(), with its Error as a misuse of the command line (exit code 2): for what options alone decide.
template <class F>
auto usage(F f) -> decltype(f()) {
  try {
    return f();
  } catch (const Error& error) {
    throw CLI::ValidationError(error.what());
  }
}

}  // namespace burnish::cli
