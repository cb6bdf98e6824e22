// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <burnish/formula/language.h>
#include <burnish/shaders/shader.h>

namespace burnish {

/// Returns a texture's declaration by a pattern of the language, at the number after the first one that
/// `options.places` asks for.
std::string declared_texture(const Language& l, std::string_view pattern, std::string_view name,
                             std::size_t number, const ShaderOptions& options);

/// Throws Error for numbers below 0.
void check_places(const ShaderPlaces& places);

}  // namespace burnish
