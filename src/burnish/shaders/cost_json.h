// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <nlohmann/json_fwd.hpp>

#include <burnish/factors/factored_brdf.h>
#include <burnish/shaders/shader.h>

namespace burnish {

/// Returns the cost of a model's shader with the hardware's filters; nothing for models that have neither one channel
/// nor three, which shaders cannot show.
std::optional<ShaderCost> shader_cost(const FactoredBrdf& model);

/// {"fetches", "textures", "operations", "divisions", "roots", "powers"}.
nlohmann::ordered_json cost_json(const ShaderCost& cost);

}  // namespace burnish
