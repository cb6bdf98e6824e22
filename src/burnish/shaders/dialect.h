#pragma once

#include <string>
#include <string_view>

#include <burnish/shaders/shader.h>

namespace burnish {

/// How a language spells what shaders are made of.
struct Dialect {
  ShaderLanguage language;
  std::string_view scalar, vector, integer;  // types
  std::string_view suffix;                   // of float literals
  std::string_view declare;                  // before "name = value;"; empty: the type
  std::string_view header;                   // of the file, after its comment

  /// "  float name = value;\n"
  std::string declaration(std::string_view type, std::string_view name, std::string_view value) const;
  /// A float, with the digits that restore it.
  std::string literal(double value) const;
  std::string select(std::string_view condition, std::string_view yes, std::string_view no) const;
  /// "vec3 name(vec3 a, vec3 b, more) {\n"
  std::string function(std::string_view name, std::initializer_list<std::string_view> vectors,
                       std::string_view more) const;
  /// A texel of table `texture`, `channels` of it.
  std::string fetch(std::string_view texture, std::string_view x, std::string_view y, int channels) const;
  /// The filtered value at texture coordinates; v empty: of a 1-D texture (glsl).
  std::string sample(std::string_view texture, std::string_view u, std::string_view v, int channels) const;
};

const Dialect& dialect_of(ShaderLanguage language) noexcept;

}  // namespace burnish
