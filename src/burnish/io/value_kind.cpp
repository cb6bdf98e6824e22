// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/io/value_kind.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr double kHorizonCosine = 1e-6;  // a smaller cosine cannot be divided out

constexpr std::array<std::string_view, 8> kNamesOfF = {"brdf", "bsdf",  "f",      "fr",
                                                       "f_r",  "value", "values", "val"};
constexpr std::array<std::string_view, 5> kNamesOfBrf = {"brf", "reflectance_factor", "radiance_factor",
                                                         "bidirectional_reflectance_factor", "rf"};
constexpr std::array<std::string_view, 4> kNamesOfCorrected = {"ccbrdf", "ccbsdf", "cosine_corrected_brdf",
                                                               "cosine_corrected_bsdf"};

template <std::size_t n>
bool is_one_of(const std::array<std::string_view, n>& names, std::string_view name) noexcept {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::optional<ValueKind> asked_kind(const OpenOptions& options) {
  std::optional<ValueKind> kind;
  for (const auto& [asked, what] :
       {std::pair{options.has_cosine, ValueKind::f_cos_i},
        std::pair{options.has_cosine_o, ValueKind::f_cos_o}, std::pair{options.brf, ValueKind::brf}}) {
    if (!asked) continue;
    if (kind) throw Error("values: expected one of brf, has_cosine and has_cosine_o, found two");
    kind = what;
  }
  return kind;
}

std::optional<ValueKind> kind_of_name(std::string_view name) {
  if (is_one_of(kNamesOfF, name)) return ValueKind::f;
  if (is_one_of(kNamesOfBrf, name)) return ValueKind::brf;
  if (is_one_of(kNamesOfCorrected, name)) return ValueKind::f_cos_o;
  // The value is f_r times the cosine of a named angle.
  const std::size_t cosine = name.find("_cos");
  if (cosine == std::string_view::npos || !is_one_of(kNamesOfF, name.substr(0, cosine))) return std::nullopt;
  std::string angle(name.substr(cosine + 4));
  angle.erase(std::remove(angle.begin(), angle.end(), '_'), angle.end());
  if (angle.starts_with("theta")) angle.erase(0, 5);
  if (angle == "i" || angle == "in") return ValueKind::f_cos_i;
  constexpr std::array<std::string_view, 5> kViewerNames = {"o", "r", "s", "v", "out"};
  if (is_one_of(kViewerNames, angle)) return ValueKind::f_cos_o;
  return std::nullopt;
}

double f_of_value(ValueKind kind, double value, const DirectionPair& pair) noexcept {
  if (kind == ValueKind::f) return value;
  if (kind == ValueKind::brf) return value / kPi;
  const double cosine = kind == ValueKind::f_cos_i ? pair.wi.z : pair.wo.z;
  return cosine < kHorizonCosine ? std::numeric_limits<double>::quiet_NaN() : value / cosine;
}

std::string kind_sentence(ValueKind kind, std::string_view why) {
  switch (kind) {
    case ValueKind::f_cos_i:
      return fmt::format("The cosine of theta_i was divided out, {}.", why);
    case ValueKind::f_cos_o:
      return fmt::format("The cosine of theta_o was divided out, {}.", why);
    case ValueKind::brf:
      return fmt::format("Values are reflectance factors, {}: divided by pi.", why);
    case ValueKind::f:
      break;
  }
  return "Values are f_r without the cosine.";
}

}  // namespace burnish
