#pragma once

#include <string>
#include <string_view>

#include <burnish/shaders/dialect.h>

namespace burnish {

/// Letters, digits and single underscores, a letter first.
bool is_identifier(std::string_view name) noexcept;

/// Throws Error unless is_identifier(name).
void check_shader_name(std::string_view name);

/// `burnish_NAME_world(n, t, l, v)`, which calls `burnish_NAME(wi, wo)`; `more` declares a third parameter of
/// both, called tables.
std::string world_function(const Dialect& dialect, const std::string& name, std::string_view more);

}  // namespace burnish
