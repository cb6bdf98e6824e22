// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/shaders/texture_declaration.h>

namespace burnish {

std::string declared_texture(const Language& l, std::string_view pattern, std::string_view name,
                             std::size_t number, const ShaderOptions& options) {
  const ShaderPlaces& places = options.places;
  const std::optional<int> set = options.language == ShaderLanguage::hlsl ? places.space : places.set;
  const std::string_view place = set ? l.placed : places.binding ? l.bound : l.unbound;
  // A sampler that has numbers of its own stands behind its texture.
  const std::size_t first = static_cast<std::size_t>(places.binding.value_or(0)), alone = first + number,
                    paired = first + 2 * number;
  return fmt::format(fmt::runtime(pattern), name, alone, paired, paired + 1,
                     fmt::format(fmt::runtime(place), set.value_or(0), alone, paired),
                     fmt::format(fmt::runtime(place), set.value_or(0), alone, paired + 1),
                     options.half_products ? "mediump" : "highp");
}

void check_places(const ShaderPlaces& places) {
  const auto check = [](const char* what, const std::optional<int>& number) {
    if (number && *number < 0)
      throw Error(fmt::format("shader: expected a {} of at least 0, found {}", what, *number));
  };
  check("binding", places.binding);
  check("set", places.set);
  check("space", places.space);
}

}  // namespace burnish
