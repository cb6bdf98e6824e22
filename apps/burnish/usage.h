// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/short_message.h>

namespace burnish::cli {

/// Returns f(), and turns its Error into a misuse of the command line (exit code 2). It is for errors that depend on
/// options alone.
template <class F>
auto usage(F f) -> decltype(f()) {
  try {
    return f();
  } catch (const Error& error) {
    throw CLI::ValidationError(error.what());
  }
}

/// Checks that an option's value is one of these. The message for another value suggests the one that it may have
/// meant.
CLI::Validator one_of(std::vector<std::string> names);

/// Checks that an option's value is a number from low to high.
template <class T>
CLI::Validator in_range(T low, T high) {
  const auto check = [=](std::string& value) {
    T number{};
    const bool is = CLI::detail::lexical_cast(value, number) && number >= low && number <= high;
    return is ? std::string() : fmt::format("expected a number from {} to {}, found '{}'", low, high, value);
  };
  return {check, fmt::format("{} in [{} - {}]", CLI::detail::type_name<T>(), low, high)};
}
/// Check that a value is a finite number of at least 0, or greater than 0.
CLI::Validator at_least_zero();
CLI::Validator above_zero();

/// Returns "; did you mean 'NAME'?" with the name closest to a misspelt word, or an empty text where none is close.
std::string suggestion(std::string_view word, const std::vector<std::string>& names);

/// Throws Error where a folder can neither be written to nor made; makes nothing. Call it before long work.
void check_folder(const std::filesystem::path& folder);

/// Refuses, as a misuse, an output whose name ends as files of another kind do, such as paint.png for a model. Call it
/// before long work. `endings` are the accepted ones, ".exr". Names with other unknown endings, "paint" and "paint.v2",
/// are accepted too.
void check_ending(const std::string& path, const std::vector<std::string>& endings);

/// Does the same for a folder that does not exist yet: paint.glsl is no name of a folder.
void check_folder_name(const std::string& path);

/// Refuses a command line with an empty word. No option takes an empty word, and no file has it as its name.
void check_no_empty_word(std::span<char* const> arguments);

/// Lists the verbs that people use, a line each with its description, and where to read more.
std::string list_of_verbs(const CLI::App& app);

/// Returns a message on the first unknown verb or option of a command line: "expected a verb, found 'ft'; did you mean
/// 'fit'?". Returns nothing where all are known.
std::optional<std::string> misspelling(const CLI::App& app, std::span<char* const> arguments);

}  // namespace burnish::cli
