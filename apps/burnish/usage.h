#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

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

/// What is said of an error: one line of at most 299 characters, of longer ones the beginning and the end.
std::string short_message(std::string_view message);

/// What a command line's first unknown verb or option may have meant, "expected a verb, found 'ft'; did you mean
/// 'fit'?"; nothing where all are known.
std::optional<std::string> misspelling(const CLI::App& app, std::span<char* const> arguments);

}  // namespace burnish::cli
