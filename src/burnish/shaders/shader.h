// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// GLSL 4.50, GLSL ES 3.00 (WebGL2), HLSL (shader model 5), MSL, Slang, WGSL, and C++ that CUDA compiles too.
enum class ShaderLanguage { glsl, glsl_es, hlsl, msl, slang, wgsl, cpp };

/// The ways to interpolate tables:
enum class ShaderFilter { exact, hardware };

inline constexpr std::array kShaderLanguages{
    ShaderLanguage::glsl,  ShaderLanguage::glsl_es, ShaderLanguage::hlsl, ShaderLanguage::msl,
    ShaderLanguage::slang, ShaderLanguage::wgsl,    ShaderLanguage::cpp};

/// "glsl", "glsl_es", "hlsl", "msl", "slang", "wgsl" or "cpp".
std::string_view to_string(ShaderLanguage language) noexcept;

/// The numbers that declarations give to textures. None of them is written where nothing is set, but HLSL and WGSL
/// count from 0 in group 0.
struct ShaderPlaces {
  std::optional<int>
      binding;             ///< first one of glsl, slang and wgsl, first register of hlsl; >= 0, by default 0
  std::optional<int> set;  ///< descriptor set of glsl (Vulkan's) and slang, group of wgsl; >= 0
  std::optional<int> space;  ///< of the registers of hlsl; >= 0

  friend bool operator==(const ShaderPlaces&, const ShaderPlaces&) = default;
};

struct ShaderOptions {
  ShaderLanguage language = ShaderLanguage::glsl;
  ShaderFilter filter = ShaderFilter::exact;
  std::string name = "brdf";  ///< letters, digits and single underscores, a letter first
  /// For the hardware filter: values from textures are multiplied in half precision (mediump, half, min16float, f16).
  /// Positions are still found in single precision.
  bool half_products = false;
  /// For glsl with the hardware filter: a texture of one row is 1-D, which takes half the texels where no texture
  /// unit reads them.
  bool lines_are_1d = false;
  /// For glsl: no uniforms are declared. The functions take the textures as their last arguments, all of them
  /// sampler2D. The 3-D one is a picture of its layers, the first at v = 0 and the others behind it.
  bool textures_are_arguments = false;
  /// For a surface: its maps are pairs in blocks, see pack_maps.
  bool maps_in_blocks = false;
  ShaderPlaces places = {};
  /// The text is to stand behind other code in a file: it lacks what must come first there, `enable f16` of WGSL.
  bool appended = false;
};

/// The cost of one evaluation in the local frame, above the horizon. Floating-point operations are counted for each
/// component; integers, conversions and the test for the horizon are not counted.
struct ShaderCost {
  int fetches = 0;     ///< of texels (exact), or filtered reads (hardware)
  int textures = 0;    ///< that they are of (C++: arrays)
  int operations = 0;  ///< adds, subtracts, multiplies, minima, maxima, floors and selects
  int divisions = 0, roots = 0, powers = 0;

  ShaderCost& operator+=(const ShaderCost& other) noexcept {
    fetches += other.fetches;
    textures = std::max(textures, other.textures);
    operations += other.operations;
    divisions += other.divisions;
    roots += other.roots;
    powers += other.powers;
    return *this;
  }
  friend bool operator==(const ShaderCost&, const ShaderCost&) = default;
};

/// The place of a table in a texture.
struct PlacedTable {
  std::size_t table = 0;       ///< of the model
  std::array<int, 3> first{};  ///< x, y and z of the texel that is its first node
  int exponent = 0;            ///< its values are there times 2^exponent
};

/// A texture that a shader reads: tables beside, above or behind each other. Texels around a table repeat its edge.
struct ShaderTexture {
  std::string name;           ///< of the sampler; of the array in C++; of a member in MSL
  int width = 0, height = 0;  ///< height 0: 1-D
  int depth = 0;              ///< > 0: 3-D
  std::size_t channels = 1;
  TableFormat format = TableFormat::half;  ///< that `values` are rounded to
  std::vector<float> values;               ///< [z][y][x][channel]
  std::vector<PlacedTable> tables;
};

struct Shader {
  std::string text;                     ///< no #version line
  std::vector<ShaderTexture> textures;  ///< at most one 2-D and one 3-D; of C++ one a table
  ShaderCost cost;
};

/// Writes source text that evaluates a factored BRDF as FactoredBrdf::eval does, in floats:
/// - `burnish_NAME(wi, wo)`: takes unit vectors of the local frame and returns f_r in 1/sr as three components (a grey
///   model's value three times), without the cosine, zero below the horizon;
/// - `burnish_NAME_world(n, t, l, v)`: the same in any frame. It takes the unit normal and tangent, orthogonal to each
///   other, and unit vectors to light and viewer.
/// The textures are all that is left to set. One 2-D texture holds all lines, disks and grids, and one 3-D texture
/// all volumes: one channel in red or three in red, green, blue, in any format that holds the values. They are
/// clamped to the edge, and linear for the hardware filter.
/// MSL takes them in a struct, as third or fifth argument; C++ has an array a table. docs/guide/shaders.md states how
/// precise the text is.
///
/// With half products the relative error stays below 1 % where f_r is between 1e-3 and 3e4 and tables are smooth.
/// Values above 65504 become infinite.
///
/// Throws Error if the name or the options are not as ShaderOptions says, channels are not 1 or 3, a texture's side
/// would be above 16384, for C++ with the hardware filter, and for half products with the exact one.
Shader generate_shader(const FactoredBrdf& brdf, const ShaderOptions& options);

/// The computation of generate_shader in two pieces of GLSL, for a pixel that several lights shine on: `view` once,
/// then `light` and `value` for every light.
struct SplitShader {
  std::string declarations;  ///< of the textures
  std::string view;          ///< statements that need vec3 wo
  std::string light;         ///< statements that need vec3 wi, wo and those of `view`
  std::string value;         ///< after those an expression: f_r of directions above the horizon, vec3
  std::vector<ShaderTexture> textures;
  ShaderCost view_cost, light_cost;
};

/// Writes source text for `options.language`, glsl or glsl_es. Throws Error as generate_shader, and for other
/// languages.
SplitShader split_shader(const FactoredBrdf& brdf, const ShaderOptions& options);

/// "12 fetches of 2 textures, 87 operations, 4 divisions, 2 roots, 0 powers".
std::string to_string(const ShaderCost& cost);

}  // namespace burnish
