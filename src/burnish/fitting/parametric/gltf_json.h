// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <burnish/reflectance/gltf_material.h>

namespace burnish {

/// A material of a glTF asset, without a name: pbrMetallicRoughness, and under `extensions`, which is left out where it
/// is empty, those that do something.
nlohmann::ordered_json gltf_json(const GltfMaterial& material);

}  // namespace burnish
