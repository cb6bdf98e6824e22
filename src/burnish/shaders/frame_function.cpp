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

std::string world_function(const Dialect& d, const std::string& name, std::string_view more) {
  const auto local = [&](char w) {
    return fmt::format("{0}(dot(t, {1}), dot(s, {1}), dot(n, {1}))", d.vector, w);
  };
  return d.function("burnish_" + name + "_world", {"n", "t", "l", "v"}, more) +
         d.declaration(d.vector, "s", "cross(n, t)") +
         fmt::format("  return burnish_{}({}, {}{});\n}}\n", name, local('l'), local('v'),
                     more.empty() ? "" : ", tables");
}

}  // namespace burnish
