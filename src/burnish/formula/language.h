// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include <burnish/formula/expression.h>

namespace burnish {

/// The spelling of formulas and shaders in a language. Patterns are those of fmt.
struct Language {
  /// An operation on {0}, {1}, …; `precedence` tells where its text needs parentheses: 3, a call, nowhere.
  struct Call {
    std::string_view pattern;
    int precedence = 3;
  };

  std::string_view name;
  std::string_view suffix;                   // of float literals
  std::string_view scalar, vector, integer;  // types; vector empty: none
  std::string_view local;                    // a statement: {0} type, {1} name, {2} value
  std::string_view result;                   // the last statement of a function: {0} value
  std::string_view parameter;                // {0} type, {1} name
  std::string_view definition;               // of a function: {0} type, {1} name, {2} parameters, {3} body
  std::string_view header;                   // of a shader's file, after its comment
  std::string_view math;                     // what code with calls needs before it
  std::string_view exponent_of;              // helper for Op::exponent_of, with `math`; empty: none
  std::map<Op, Call> calls;

  std::string_view texel, texel_3d;    // {0} texture, {1} x, {2} y (, {3} z), last channels' letters
  std::string_view sample, sample_3d;  // likewise at texture coordinates
  std::string_view sample_1d;          // {0} texture, {1} u, {2} channels' letters; empty: none
  std::string_view array;              // constant floats: {0} name, {1} how many, {2} values
  // declarations: {0} name, {1} number, {2} twice it, {3} and one, {4} place of the texture, {5} place of its
  // sampler, {6} precision of its texels; empty: none
  std::string_view texture_1d, texture, texture_3d, filtered_texture, filtered_texture_3d;
  // places in declarations: {0} set, {1} number, {2} number where samplers have numbers too. `bound` where only a
  // number was asked for, `placed` where a set was.
  std::string_view unbound, bound, placed;
  // products of texels in half precision: its types, what makes a vector, what converts from single (empty:
  // nothing has to), suffix of literals, and what stands instead of `header`
  std::string_view half_scalar, half_vector, half_constructor, half_from_scalar, half_from_vector,
      half_suffix, half_header;
  std::string_view texture_struct;  // what gathers declarations: {0} name, {1} declarations; empty: nothing

  // of surfaces: a statement that reads a map at u, v and lod, {0} local, {1} texture, {2} its number; what the
  // function around it takes besides, {0} name of texture_struct, and what stands before that function
  std::string_view map_read, map_parameter, map_template;
  // structs: {0} type, {1} name; {0} name, {1} members; the last statement of a function that returns one, {0} name,
  // {1} values
  std::string_view member, structure, made;

  /// `half`: of what is computed from texels in half precision.
  std::string_view type_name(ValueType type, bool half = false) const noexcept;
  /// A float: the shortest digits that restore it, of what is none nine digits.
  std::string literal(double value, bool half = false) const;
  std::string declaration(ValueType type, std::string_view name, std::string_view value,
                          bool half = false) const;
  /// A function's head and body; `more` is text that follows the parameters, each a `type`.
  std::string function(ValueType type, std::string_view name, std::span<const std::string_view> parameters,
                       std::string_view more, std::string_view body) const;
  /// Reads a texel of a 2-D or 3-D texture, at as many integers as it has dimensions.
  std::string fetch(std::string_view texture, std::span<const std::string> at, ValueType type) const;
  /// Filtered, at one to three texture coordinates.
  std::string filtered(std::string_view texture, std::span<const std::string> at, ValueType type) const;
  /// A constant array of floats.
  std::string declare_array(std::string_view name, std::span<const double> values) const;
};

/// c, cuda, cpp (C++ that CUDA compiles too, with a vector type of its own), glsl, glsl_es (3.00), hlsl, msl,
/// rust, slang and wgsl.
std::span<const Language> languages();
/// Throws Error naming those known.
const Language& language(std::string_view name);

}  // namespace burnish
