#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include <burnish/source.h>

namespace burnish::cli {

/// Adds --method, which stays empty where our own factors are wanted.
void add_method_argument(CLI::App& verb, std::string& method);

/// How `fit --method` fits what is no product of positive factors.
struct BaselineArguments {
  std::string method, out;
  std::size_t budget = 0;   ///< bytes; 0: the default
  std::size_t samples = 0;  ///< pairs drawn from a source that is a function; 0: the default
  std::uint64_t seed = 1;
  bool symmetrize = true;
};

/// Fits, writes the JSON file and returns what `fit` prints.
nlohmann::ordered_json fit_baseline(const Source& source, const BaselineArguments& arguments);

/// Prints that as text.
void print_baseline(const nlohmann::ordered_json& notes);

}  // namespace burnish::cli
