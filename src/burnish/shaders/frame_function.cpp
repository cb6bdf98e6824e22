// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/shaders/frame_function.h>

namespace burnish {

bool is_identifier(std::string_view name) noexcept {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto fits = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && letter(name.front()) && std::ranges::all_of(name, fits) && name.back() != '_' &&
         name.find("__") == name.npos;
}

void check_shader_name(std::string_view name) {
  if (!is_identifier(name))
    throw Error(fmt::format(
        "shader: expected a name of letters, digits and single underscores, a letter first, found '{}'",
        name));
}

std::string horizon_test(const Language& l) {
  return fmt::format("  if (wi.z <= {0} || wo.z <= {0}) {{ return {1}({0}, {0}, {0}); }}\n", l.literal(0),
                     l.vector);
}

std::string world_function(const Language& l, const std::string& name, const MoreParameters& more) {
  const auto local = [&](char w) {
    return fmt::format("{0}(dot(t, {1}), dot(s, {1}), dot(n, {1}))", l.vector, w);
  };
  constexpr std::array<std::string_view, 4> kVectors{"n", "t", "l", "v"};
  const std::string value = fmt::format("burnish_{}({}, {}{}{})", name, local('l'), local('v'),
                                        more.names.empty() ? "" : ", ", more.names);
  return l.function(
      ValueType::vector, "burnish_" + name + "_world", kVectors, more.declarations,
      l.declaration(ValueType::vector, "s", "cross(n, t)") + fmt::format(fmt::runtime(l.result), value));
}

}  // namespace burnish
