// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/math/closest_name.h>

namespace burnish::wasm {

/// A verb's options from scripts. The constructor refuses unknown names, and readers refuse values of the wrong kind.
/// `own` are names that the package itself adds to a request. Methods throw Error, "VERB: expected ...".
class Options {
 public:
  using Json = nlohmann::ordered_json;

  Options(std::string_view verb, const Json& object, std::initializer_list<std::string_view> names,
          std::initializer_list<std::string_view> own = {})
      : verb_(verb), object_(object) {
    if (!object.is_object()) throw expected("options", object);
    for (const auto& item : object.items())
      if (std::ranges::find(names, item.key()) == names.end() &&
          std::ranges::find(own, item.key()) == own.end())
        throw Error(fmt::format("{}: {}", verb,
                                expected_one_of(std::vector(names.begin(), names.end()), item.key())));
  }

  /// Returns null where the option is missing or null.
  const Json* found(const char* name) const {
    const auto place = object_.find(name);
    return place == object_.end() || place->is_null() ? nullptr : &*place;
  }

  /// Sets `to` where the option is given.
  void read(const char* name, bool& to) const {
    if (const Json* value = of_kind(name, "true or false", &Json::is_boolean)) to = value->get<bool>();
  }
  void read(const char* name, std::string& to) const {
    if (const Json* value = of_kind(name, "a text", &Json::is_string)) to = value->get<std::string>();
  }
  void read(const char* name, double& to, double least = -std::numeric_limits<double>::infinity()) const {
    const Json* value = of_kind(name, "a number", &Json::is_number);
    if (value && !(value->get<double>() >= least))
      throw expected(fmt::format("{} of at least {}", name, least), *value);
    if (value) to = value->get<double>();
  }
  template <std::integral T>
  void read(const char* name, T& to, std::uint64_t least = 0,
            std::uint64_t most = static_cast<std::uint64_t>(std::numeric_limits<T>::max())) const {
    const Json* value = of_kind(name, "a whole number", &Json::is_number);
    if (value && !(value->is_number_unsigned() && value->get<std::uint64_t>() >= least &&
                   value->get<std::uint64_t>() <= most))
      throw expected(fmt::format("{} from {} to {}", name, least, most), *value);
    if (value) to = value->get<T>();
  }
  void read(const char* name, std::vector<std::string>& to) const {
    const Json* value = of_kind(name, "a list of texts", &Json::is_array);
    if (value && !std::ranges::all_of(*value, [](const Json& item) { return item.is_string(); }))
      throw expected(fmt::format("{} as a list of texts", name), *value);
    if (value) to = value->get<std::vector<std::string>>();
  }
  template <class T, class... Limits>
  void read(const char* name, std::optional<T>& to, Limits... limits) const {
    if (!found(name)) return;
    T value{};
    read(name, value, limits...);
    to = value;
  }
  std::string text(const char* name, std::string otherwise = {}) const {
    read(name, otherwise);
    return otherwise;
  }

  /// Returns the error "VERB: expected WHAT, found VALUE".
  Error expected(std::string_view what, const Json& value) const {
    std::string found = value.dump(-1, ' ', true, Json::error_handler_t::replace);
    return Error(fmt::format("{}: expected {}, found {}", verb_, what, found.substr(0, 40)));
  }

 private:
  const Json* of_kind(const char* name, std::string_view kind, bool (Json::*is)() const noexcept) const {
    const Json* value = found(name);
    if (value && !(value->*is)()) throw expected(fmt::format("{} as {}", name, kind), *value);
    return value;
  }

  std::string_view verb_;
  const Json& object_;
};

}  // namespace burnish::wasm
