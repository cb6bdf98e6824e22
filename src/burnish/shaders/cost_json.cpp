// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include <burnish/shaders/cost_json.h>

namespace burnish {

std::optional<ShaderCost> shader_cost(const FactoredBrdf& model) {
  if (model.channels() != 1 && model.channels() != 3) return std::nullopt;
  return generate_shader(model, {.filter = ShaderFilter::hardware}).cost;
}

nlohmann::ordered_json cost_json(const ShaderCost& cost) {
  return {{"fetches", cost.fetches},     {"textures", cost.textures}, {"operations", cost.operations},
          {"divisions", cost.divisions}, {"roots", cost.roots},       {"powers", cost.powers}};
}

}  // namespace burnish
