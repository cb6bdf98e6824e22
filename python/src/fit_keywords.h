#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <burnish/fitting/fit.h>

namespace burnish::python {

/// What `fit` and `batch` take of a fit.
struct FitKeywords {
  std::string model = "";
  std::vector<std::string> tables = {};
  std::variant<std::uint64_t, std::string> budget = std::uint64_t{0};
  int fetches = 0, lobes = 0;
  bool search = false;
  std::string loss = "image";
  std::variant<std::monostate, double, std::string> smooth = {};
  std::optional<int> reweightings = {};
  double floor = LogLinear{}.floor;
  std::optional<std::string> format = {};
  std::size_t samples = 0;
  std::uint64_t seed = 1;
  bool symmetrize = true, conserve_energy = false;
  std::shared_ptr<const MaterialBook> book = nullptr;
  std::string method = "";                 ///< of baselines
  std::string target = "", hold_out = "";  ///< empty: default_target, none
};

/// What they ask for; throws Error on a word that is none.
FitOptions fit_options(const FitKeywords& given, bool isotropic);

}  // namespace burnish::python
