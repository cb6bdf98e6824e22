// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/capture/pictures/capture.h>
#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/math/closest_name.h>

namespace burnish {

using Json = nlohmann::ordered_json;

/// A member of a JSON text and its path, which errors name. Every function throws Error if the text has something
/// else.
class JsonMember {
 public:
  JsonMember(const FileBytes& file, const Json& json, std::string name)
      : file_(&file), json_(&json), name_(std::move(name)) {}

  [[noreturn]] void fail(const std::string& expected) const {
    std::string found = json_->dump(-1, ' ', false, Json::error_handler_t::replace);
    if (found.size() > 40) found = found.substr(0, 40) + "...";
    throw Error::in_file(file_->name, name_.empty() ? expected : name_ + ": " + expected, found);
  }
  bool has(const char* key) const { return json_->is_object() && json_->contains(key); }
  JsonMember at(const char* key) const {
    if (!json_->is_object()) fail("an object");
    if (!json_->contains(key)) throw Error::in_file(file_->name, child(key), "none");
    return {*file_, (*json_)[key], child(key)};
  }
  /// Throws Error for a member that is not in `known`; members that begin with _ are notes.
  void has_only(std::initializer_list<std::string_view> known) const {
    if (!json_->is_object()) fail("an object");
    for (const auto& [key, value] : json_->items())
      if (!key.starts_with('_') && std::ranges::find(known, key) == known.end())
        throw Error(fmt::format("{}: {}{}", file_->name, name_.empty() ? "" : name_ + ": ",
                                expected_one_of(std::span(known.begin(), known.size()), key)));
  }
  std::vector<JsonMember> list(std::size_t least, std::size_t most) const {
    if (!json_->is_array() || json_->size() < least || json_->size() > most)
      fail(range("a list of ", "a list of ", least, most));
    std::vector<JsonMember> items;
    for (std::size_t i = 0; i < json_->size(); ++i)
      items.emplace_back(*file_, (*json_)[i], fmt::format("{}[{}]", name_, i));
    return items;
  }
  double number(double least, double most) const {
    const double value = json_->is_number() ? json_->get<double>() : NAN;
    if (!(value >= least && value <= most)) fail(range("", "a number from ", least, most));
    return value;
  }
  int integer(int least, int most) const {
    if (!json_->is_number_integer()) fail(range("", "a whole number from ", least, most));
    return static_cast<int>(number(least, most));
  }
  bool truth() const {
    if (!json_->is_boolean()) fail("true or false");
    return json_->get<bool>();
  }
  std::string text() const {
    if (!json_->is_string()) fail("a text");
    return json_->get<std::string>();
  }
  /// Returns the name of a file within the folder.
  std::string file() const {
    std::string name = text();
    const std::filesystem::path path(name);
    const bool outside = path.is_absolute() || std::ranges::find(path, "..") != path.end();
    if (name.empty() || outside || name.find('\0') != std::string::npos)
      fail("the name of a file in the folder");
    return name;
  }
  Vec3 vector() const {
    constexpr double kMax = 1e9;
    const std::vector<JsonMember> xyz = list(3, 3);
    return {xyz[0].number(-kMax, kMax), xyz[1].number(-kMax, kMax), xyz[2].number(-kMax, kMax)};
  }
  bool is_list() const { return json_->is_array(); }

 private:
  // Returns the text for one expected number, or for several.
  template <class T>
  static std::string range(const char* of_one, const char* of_several, T least, T most) {
    return least == most ? fmt::format("{}{}", of_one, least)
                         : fmt::format("{}{} to {}", of_several, least, most);
  }
  std::string child(const char* key) const { return name_.empty() ? key : name_ + "." + key; }

  const FileBytes* file_;
  const Json* json_;
  std::string name_;
};

/// Parses the text of a file as JSON that is at most 32 levels deep. Throws Error if it is not.
inline Json parse_json(const FileBytes& file) {
  constexpr int kMaxDepth = 32;
  bool shallow = true;
  const auto measure = [&](int depth, Json::parse_event_t, Json&) {
    return shallow = shallow && depth <= kMaxDepth;
  };
  Json json = Json::parse(file.text(), measure, false);
  if (json.is_discarded() || !shallow)
    throw Error::in_file(file.name, "JSON text", "none, or one nested too deep");
  return json;
}

/// Reads {"direction": [x, y, z]}, a unit vector above the surface, or {"position": [x, y, z]}, a point above it.
Station parse_station(const JsonMember& member);

}  // namespace burnish
