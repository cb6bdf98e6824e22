#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include <burnish/formula/expression.h>

namespace burnish {

/// How a language spells what formulas and shaders are made of. Patterns are those of fmt.
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

  std::string_view texel;       // {0} texture, {1} x, {2} y, {3} channels' letters
  std::string_view sample;      // {0} texture, {1} u, {2} v, {3} channels' letters
  std::string_view sample_1d;   // {0} texture, {1} u, {2} channels' letters; empty: none
  std::string_view texture;     // declaration: {0} name, {1} number, {2} twice it, {3} and one; 2-D
  std::string_view texture_1d;  // empty: none
  std::string_view filtered_texture;
  std::string_view texture_struct;  // what gathers declarations: {0} name, {1} declarations; empty: nothing

  std::string_view type_name(ValueType type) const noexcept;
  /// A float: the shortest digits that restore it, of what is none nine digits.
  std::string literal(double value) const;
  std::string declaration(ValueType type, std::string_view name, std::string_view value) const;
  /// A function's head and body; `more` is text that follows the parameters, each a `type`.
  std::string function(ValueType type, std::string_view name, std::span<const std::string_view> parameters,
                       std::string_view more, std::string_view body) const;
  std::string fetch(std::string_view texture, std::string_view x, std::string_view y, ValueType type) const;
  /// Filtered, at texture coordinates; v empty: of a 1-D texture.
  std::string filtered(std::string_view texture, std::string_view u, std::string_view v,
                       ValueType type) const;
};

/// c, cuda, cpp (C++ that CUDA compiles too, with a vector type of its own), glsl, glsl_es (3.00), hlsl, msl,
/// rust and wgsl.
std::span<const Language> languages();
/// Throws Error naming those known.
const Language& language(std::string_view name);

}  // namespace burnish
