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

/// f(), with its Error as a misuse of the command line (exit code 2): for what options alone decide.
template <class F>
auto usage(F f) -> decltype(f()) {
  try {
    return f();
  } catch (const Error& error) {
    throw CLI::ValidationError(error.what());
  }
}

/// That an option's value is one of these; of another it says which it may have meant.
CLI::Validator one_of(std::vector<std::string> names);

/// That an option's value is a number from low to high.
template <class T>
CLI::Validator in_range(T low, T high) {
  const auto check = [=](std::string& value) {
    T number{};
    const bool is = CLI::detail::lexical_cast(value, number) && number >= low && number <= high;
    return is ? std::string() : fmt::format("expected a number from {} to {}, found '{}'", low, high, value);
  };
  return {check, fmt::format("{} in [{} - {}]", CLI::detail::type_name<T>(), low, high)};
}
/// That it is a finite number of at least 0, or of more.
CLI::Validator at_least_zero();
CLI::Validator above_zero();

/// "; did you mean 'NAME'?" of the name that is closest to a misspelt word, or nothing.
std::string suggestion(std::string_view word, const std::vector<std::string>& names);

/// Before long work: throws Error where a folder can neither be written to nor made. Makes nothing.
void check_folder(const std::filesystem::path& folder);

/// Before long work: refuses, as a misuse, an output whose name ends as files of another kind do, such as paint.png for
/// a model. `endings` are those that serve, ".exr"; other names, "paint" and "paint.v2", serve too.
void check_ending(const std::string& path, const std::vector<std::string>& endings);

/// The same for a folder that is not there yet: paint.glsl is no name of one.
void check_folder_name(const std::string& path);

/// Refuses a command line with an empty word, which no option takes and no file has for its name.
void check_no_empty_word(std::span<char* const> arguments);

/// The verbs that people use, a line each with what they do, and where to read on.
std::string list_of_verbs(const CLI::App& app);

/// What a command line's first unknown verb or option may have meant, "expected a verb, found 'ft'; did you mean
/// 'fit'?"; nothing where all are known.
std::optional<std::string> misspelling(const CLI::App& app, std::span<char* const> arguments);

}  // namespace burnish::cli
