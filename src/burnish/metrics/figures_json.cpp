// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/metrics/figures_json.h>

namespace burnish {

namespace {

using Json = nlohmann::ordered_json;

template <class Figures>
struct NamedFigure {
  std::string_view name;
  double Figures::*value;
};

constexpr NamedFigure<ErrorFigures> kErrorFigures[] = {{"log_cos", &ErrorFigures::log_cos},
                                                       {"relative", &ErrorFigures::relative},
                                                       {"rms_log", &ErrorFigures::rms_log},
                                                       {"rms", &ErrorFigures::rms},
                                                       {"mean_abs_log", &ErrorFigures::mean_abs_log},
                                                       {"psnr", &ErrorFigures::psnr},
                                                       {"ssim", &ErrorFigures::ssim},
                                                       {"unknown_fraction", &ErrorFigures::unknown_fraction}};

constexpr NamedFigure<NodeFigures> kNodeFigures[] = {{"log_cos", &NodeFigures::log_cos},
                                                     {"relative", &NodeFigures::relative},
                                                     {"rms_log", &NodeFigures::rms_log},
                                                     {"rms", &NodeFigures::rms}};

template <class Figures>
void add_figures(const Figures& figures, std::span<const NamedFigure<Figures>> known,
                 std::initializer_list<std::string_view> names, Json& json) {
  for (const std::string_view name : names) {
    const auto found = std::ranges::find(known, name, &NamedFigure<Figures>::name);
    if (found == known.end())
      throw Error(fmt::format("expected the name of an error figure, found '{}'", name));
    const double value = figures.*(found->value);
    json[std::string(name)] = std::isfinite(value) ? Json(value) : Json();
  }
}

}  // namespace

Json json_of(const ErrorFigures& figures, std::initializer_list<std::string_view> names) {
  Json json = Json::object();
  add_figures<ErrorFigures>(figures, kErrorFigures, names, json);
  return json;
}

Json json_of(const NodeFigures& figures, std::initializer_list<std::string_view> names) {
  Json json{{"count", figures.count}};
  add_figures<NodeFigures>(figures, kNodeFigures, names, json);
  return json;
}

Json json_of(const ExpectedError& expected) {
  Json json{{"relative", expected.relative}};
  for (std::size_t band = 0; band < expected.by_theta_i.size(); ++band)
    if (const auto& relative = expected.by_theta_i[band])
      json["from_theta_i_deg"][fmt::format("{:.0f}", ExpectedError::begin_degrees(band))] = *relative;
  return json;
}

}  // namespace burnish
