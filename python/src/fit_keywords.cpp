// SPDX-License-Identifier: Apache-2.0
#include "fit_keywords.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include <burnish/error.h>
#include <burnish/math/closest_name.h>

namespace burnish::python {

namespace {

using Json = nlohmann::ordered_json;

Json json_of_whole(nb::handle value) {
  const nb::int_ whole(value);
  std::uint64_t positive = 0;
  std::int64_t negative = 0;
  if (nb::try_cast(whole, positive)) return positive;
  if (nb::try_cast(whole, negative)) return negative;
  return nb::cast<std::string>(nb::str(whole));  // too large for any option's range
}

Json json_of(const std::string& name, nb::handle value) {
  if (value.is_none()) return nullptr;
  if (nb::isinstance<nb::bool_>(value)) return nb::cast<bool>(value);
  if (PyIndex_Check(value.ptr())) return json_of_whole(value);
  if (nb::isinstance<nb::str>(value)) return nb::cast<std::string>(value);
  if (nb::isinstance<nb::list>(value) || nb::isinstance<nb::tuple>(value)) {
    Json list = Json::array();
    for (const nb::handle each : value) list.push_back(json_of(name, each));
    return list;
  }
  if (nb::hasattr(value, "__float__")) {
    const double number = nb::cast<double>(nb::float_(value));
    return std::isfinite(number) ? Json(number) : Json(nb::cast<std::string>(nb::str(value)));
  }
  throw nb::type_error(fmt::format("{}: expected None, a bool, a number, a string or a list, found {}", name,
                                   nb::repr(value).c_str())
                           .c_str());
}

bool taken(const FitOption& option, bool with_method) {
  const FitOption& method = fit_option("method");
  return with_method ? !excludes(option, method) : option.name != method.name;
}

void check_names(std::string_view caller, const nb::kwargs& keywords,
                 std::span<const std::string_view> others) {
  std::vector<std::string_view> names;
  for (const FitOption& option : fit_option_table()) names.push_back(option.name);
  names.insert(names.end(), others.begin(), others.end());
  for (const auto& [key, value] : keywords)
    if (const auto name = nb::cast<std::string>(key); std::ranges::find(names, name) == names.end())
      throw Error(fmt::format("{}: {}", caller, expected_one_of(names, name)));
}

std::string type_of(const FitOption& option) {
  switch (option.takes) {
    case FitValue::flag:
      return "bool";
    case FitValue::texts:
      return "Sequence[str]";
    case FitValue::whole:
      return "int";
    case FitValue::number:
      return "float";
    case FitValue::bytes:
      return "int | str";
    case FitValue::smoothness:
      return "float | str";
    case FitValue::file:
      return "Book";
    default:
      return "str";
  }
}

std::string parameter(const FitOption& option, bool with_method) {
  if (with_method && option.name == "method") return ", method: str";
  const std::string_view standard = option.standard;
  std::string value(standard);
  if (option.takes == FitValue::flag) value = standard == "true" ? "True" : "False";
  if (option.takes == FitValue::choice) value = fmt::format("'{}'", standard);
  return standard.empty() ? fmt::format(", {}: {} | None = None", option.name, type_of(option))
                          : fmt::format(", {}: {} = {}", option.name, type_of(option), value);
}

}  // namespace

FitRequest request_of(std::string_view caller, const nb::kwargs& keywords,
                      std::span<const std::string_view> others) {
  check_names(caller, keywords, others);
  Json object = Json::object();
  std::shared_ptr<const MaterialBook> book;
  for (const auto& [key, value] : keywords) {
    const auto name = nb::cast<std::string>(key);
    const bool is_book = name == "book" && nb::isinstance<MaterialBook>(value);
    if (is_book) book = nb::cast<std::shared_ptr<const MaterialBook>>(value);
    object[name] = is_book ? Json("a Book") : json_of(name, value);
  }
  if (!book && object.contains("book") && !object["book"].is_null())
    throw nb::type_error(
        fmt::format("book: expected a Book, found {}", nb::repr(keywords["book"]).c_str()).c_str());
  FitRequest request = request_of_json(object, FitFront::python);
  request.book = std::move(book);
  return request;
}

std::string fit_signature(bool with_method) {
  std::string text = "def fit(source: Source, *";
  for (const FitOption& option : fit_option_table())
    if (taken(option, with_method)) text += parameter(option, with_method);
  return text + ", progress: object | None = None) -> " + (with_method ? "Baseline" : "Model");
}

std::string fit_keyword_help(bool with_method) {
  std::string text;
  for (const FitOption& option : fit_option_table()) {
    if (!taken(option, with_method)) continue;
    text += fmt::format("{}: {}", option.name, option.help);
    if (!option.left_out.empty()) text += fmt::format(" Default: {}.", option.left_out);
    text += '\n';
  }
  return text;
}

}  // namespace burnish::python
