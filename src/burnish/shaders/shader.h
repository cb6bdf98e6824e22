#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// GLSL 4.50, GLSL ES 3.00 (WebGL2), HLSL (shader model 5), MSL, WGSL, and C++ that CUDA compiles too.
enum class ShaderLanguage { glsl, glsl_es, hlsl, msl, wgsl, cpp };

/// How tables are interpolated:
/// - exact: the neighbouring texels are fetched and weighed in floats;
/// - hardware: one filtered read a lookup. Many GPUs weigh texels with 8 bits.
enum class ShaderFilter { exact, hardware };

inline constexpr std::array kShaderLanguages{ShaderLanguage::glsl, ShaderLanguage::glsl_es,
                                             ShaderLanguage::hlsl, ShaderLanguage::msl,
                                             ShaderLanguage::wgsl, ShaderLanguage::cpp};

/// "glsl", "glsl_es", "hlsl", "msl", "wgsl" or "cpp".
std::string_view to_string(ShaderLanguage language) noexcept;

struct ShaderOptions {
  ShaderLanguage language = ShaderLanguage::glsl;
  ShaderFilter filter = ShaderFilter::exact;
  std::string name = "brdf";  ///< letters, digits and single underscores, a letter first
  /// Of the hardware filter: what comes out of textures is multiplied in half precision (mediump, half,
  /// min16float, f16), positions still found in single.
  bool half_products = false;
  /// Of glsl with the hardware filter: a texture of one row is 1-D, which takes half the texels where no
  /// texture unit reads them.
  bool lines_are_1d = false;
  /// Of glsl: no uniforms are declared; the functions take the textures as their last arguments, all of them
  /// sampler2D, the 3-D one as a picture of its layers, the first at v = 0 and the others behind it.
  bool textures_are_arguments = false;
  /// Of a surface: its maps are pairs in blocks, see pack_maps.
  bool maps_in_blocks = false;
};

/// What one evaluation in the local frame costs, above the horizon. Floating-point operations are counted a
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

/// Where a table stands in a texture.
struct PlacedTable {
  std::size_t table = 0;       ///< of the model
  std::array<int, 3> first{};  ///< x, y and z of the texel that is its first node
  int exponent = 0;            ///< its values are there times 2^exponent
};

/// What a shader reads: tables beside, above or behind each other. Texels around a table repeat its edge.
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

/// Source text that evaluates a factored BRDF as FactoredBrdf::eval does, in floats:
/// - `burnish_NAME(wi, wo)`: unit vectors of the local frame in, f_r in 1/sr out as three components (a grey
///   model's value three times), without the cosine, zero below the horizon;
/// - `burnish_NAME_world(n, t, l, v)`: the same in any frame: unit normal and tangent, orthogonal to each
///   other, and unit vectors to light and viewer.
/// Nothing of the model is left to set but its textures: one 2-D texture of all lines, disks and grids and one
/// 3-D texture of all volumes, one channel in red or three in red, green, blue, in any format that holds the
/// values; clamped to the edge and linear for the hardware filter. MSL takes them in a struct, as third or
/// fifth argument; C++ has an array a table. docs/guide/shaders.md states how precise it is.
///
/// With half products the relative error stays below 1 % where f_r is between 1e-3 and 3e4 and tables are
/// smooth; what is brighter than 65504 becomes infinite.
///
/// Throws Error if the name is not as above, channels are not 1 or 3, a texture's side would be above 16384,
/// for C++ with the hardware filter, for half products with the exact one, or if lines_are_1d or
/// textures_are_arguments are not as above.
Shader generate_shader(const FactoredBrdf& brdf, const ShaderOptions& options);

/// What generate_shader computes, in two pieces of GLSL for a pixel that several lights shine on: `view`
/// once, then `light` and `value` for every light.
struct SplitShader {
  std::string declarations;  ///< of the textures
  std::string view;          ///< statements that need vec3 wo
  std::string light;         ///< statements that need vec3 wi, wo and those of `view`
  std::string value;         ///< after those an expression: f_r of directions above the horizon, vec3
  std::vector<ShaderTexture> textures;
  ShaderCost view_cost, light_cost;
};

/// Source text for `options.language`, glsl or glsl_es. Throws Error as generate_shader, and for other
/// languages.
SplitShader split_shader(const FactoredBrdf& brdf, const ShaderOptions& options);

/// "12 fetches of 2 textures, 87 operations, 4 divisions, 2 roots, 0 powers".
std::string to_string(const ShaderCost& cost);

}  // namespace burnish
