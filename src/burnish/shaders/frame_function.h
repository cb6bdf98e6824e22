// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>

#include <burnish/formula/language.h>

namespace burnish {

/// Letters, digits and single underscores, a letter first.
bool is_identifier(std::string_view name) noexcept;

/// Throws Error unless is_identifier(name).
void check_shader_name(std::string_view name);

inline constexpr std::array<std::string_view, 2> kTwoDirections{"wi", "wo"};

/// A statement that returns zero where one of wi and wo is not above the horizon.
std::string horizon_test(const Language& language);

/// The parameters of functions besides the directions: declarations, and the names in them; both may be empty.
struct MoreParameters {
  std::string declarations, names;
};

/// `burnish_NAME_world(n, t, l, v)`, which calls `burnish_NAME(wi, wo)`, both with `more`.
std::string world_function(const Language& language, const std::string& name, const MoreParameters& more);

}  // namespace burnish
