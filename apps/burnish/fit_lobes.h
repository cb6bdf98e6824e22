#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include <burnish/factors/factored_brdf.h>
#include <burnish/factors/model_spec.h>
#include <burnish/io/source.h>

namespace burnish::cli {

/// What `fit` is told about models of several lobes.
struct LobesArguments {
  std::uint64_t budget = 0;  ///< bytes; 0: none given
  int lobes = 0;
  std::string loss = "image", format;
  bool search = false, no_symmetrize = false;
  double smooth = -1;  ///< negative: the default
  std::uint64_t seed = 1;
};

/// Adds --budget, --lobes, --loss and --search.
void add_lobes_arguments(CLI::App& verb, LobesArguments& arguments);

/// The best model of a number of bytes; `notes` receives what was done.
FactoredBrdf fit_to_budget(const Source& source, const LobesArguments& arguments,
                           nlohmann::ordered_json& notes);

/// A given model of several lobes.
FactoredBrdf fit_several_lobes(const Source& source, const ModelSpec& spec, const LobesArguments& arguments,
                               nlohmann::ordered_json& notes);

/// The model of one lobe that a budget holds.
ModelSpec one_lobe_spec(const Source& source, const LobesArguments& arguments);

}  // namespace burnish::cli
