// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <burnish/shaders/map_packing.h>
#include <burnish/shaders/shader.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// Source text that evaluates a surface as SpatialBrdf::eval does, in floats: weights and frame once a pixel, lobes once
/// a light.
/// - `burnish_NAME_at(u, v, lod)`: the place, a struct `burnish_NAME_place`: w0, w1, ... the lobes' weights, and where
///   there are maps of them the texel's tangent t, bitangent b and normal n. (u, v) as SurfaceMap::sample takes them:
///   v downwards. A fetch of each texture of `maps`.
/// - `burnish_NAME_lod(ux, vx, uy, vy)`: the level of detail by the derivatives of u and v along a picture's columns and
///   rows: log2 of the larger step in texels.
/// - `burnish_NAME(wi, wo, place)`: unit vectors of the surface's frame in, f_r in 1/sr out, as three components, without
///   the cosine; zero below the texel's horizon.
/// - `burnish_NAME_world(n, t, l, v, place)`: the same in any frame.
/// MSL takes textures in structs: `burnish_NAME_maps` as the first argument of `_at`, `burnish_NAME_tables` before the
/// place. C++ reads no maps itself: the first argument of `_at` has `sample(texture, u, v, lod)`, which returns something
/// of four floats x, y, z, w.
struct SpatialShader {
  std::string text;                     ///< no #version line
  std::vector<ShaderTexture> textures;  ///< of the lobes
  PackedMaps maps;
  ShaderCost place_cost, light_cost;
};

/// Throws Error as generate_shader, where textures are arguments, and for half products.
SpatialShader generate_shader(const SpatialBrdf& surface, const ShaderOptions& options);

/// The same as pieces for a pixel that several lights shine on, as split_shader parts a model.
struct SplitSpatialShader {
  std::string declarations;  ///< of textures, the struct and the functions that make a place
  /// Statements that set a variable `place`, from floats u, v, lod.
  std::string place;
  bool framed =
      false;  ///< whether place.t, .b, .n are there: the frame that wi and wo are of, in the surface's
  SplitShader lobes;  ///< declarations within those above
  PackedMaps maps;
};

/// glsl or glsl_es. Throws Error as split_shader.
SplitSpatialShader split_shader(const SpatialBrdf& surface, const ShaderOptions& options);

}  // namespace burnish
