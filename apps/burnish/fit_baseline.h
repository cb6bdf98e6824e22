#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <burnish/io/source.h>

namespace burnish::cli {

/// How `fit --method` fits what is no product of positive factors.
struct BaselineArguments {
  std::string method, out;
  std::size_t budget = 0;
  std::size_t samples = 0;  ///< pairs drawn from a source that is a function
  std::uint64_t seed = 1;
  bool symmetrize = true;
};

/// Fits, writes the JSON file and returns what `fit` prints.
nlohmann::ordered_json fit_baseline(const Source& source, const BaselineArguments& arguments);

/// Prints that as text.
void print_baseline(const nlohmann::ordered_json& notes);

}  // namespace burnish::cli
