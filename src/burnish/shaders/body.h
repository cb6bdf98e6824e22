#pragma once

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include <burnish/shaders/dialect.h>

namespace burnish {

/// Statements of a function, one a value: what is asked for twice is computed once.
class Body {
 public:
  explicit Body(const Dialect& dialect) : dialect_(dialect) {}

  /// The variable that holds `expression`, named after `hint`. `cost` is what computing it costs.
  std::string let(std::string_view type, std::string_view hint, const std::string& expression,
                  const ShaderCost& cost) {
    const auto [known, added] = names_.try_emplace(expression);
    if (!added) return known->second;
    const int uses = ++uses_[std::string(hint)];
    known->second = uses == 1 ? std::string(hint) : std::string(hint) + std::to_string(uses);
    const std::string statement = dialect_.declaration(type, known->second, expression);
    const bool lit = needs_light(expression);
    if (lit) lit_.insert(known->second);
    text_ += statement;
    (lit ? light_text_ : view_text_) += statement;
    cost_ += cost;
    (lit ? light_cost_ : view_cost_) += cost;
    return known->second;
  }
  std::string scalar(std::string_view hint, const std::string& expression, const ShaderCost& cost) {
    return let(dialect_.scalar, hint, expression, cost);
  }
  std::string vector(std::string_view hint, const std::string& expression, const ShaderCost& cost) {
    return let(dialect_.vector, hint, expression, cost);
  }

  const Dialect& dialect() const noexcept { return dialect_; }
  const std::string& text() const noexcept { return text_; }
  const ShaderCost& cost() const noexcept { return cost_; }

  /// The statements that depend on the view alone, and those that depend on the light too.
  const std::string& view_text() const noexcept { return view_text_; }
  const std::string& light_text() const noexcept { return light_text_; }
  const ShaderCost& view_cost() const noexcept { return view_cost_; }
  const ShaderCost& light_cost() const noexcept { return light_cost_; }

 private:
  // Whether one of the expression's names is wi or was made of it.
  bool needs_light(std::string_view expression) const {
    const auto part_of_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    for (std::size_t i = 0; i < expression.size(); ++i) {
      std::size_t end = i;
      while (end < expression.size() && part_of_name(expression[end])) ++end;
      const bool component = i > 0 && expression[i - 1] == '.';
      if (end > i && !component && lit_.contains(std::string(expression.substr(i, end - i)))) return true;
      i = std::max(i, end);
    }
    return false;
  }

  const Dialect& dialect_;
  std::string text_, view_text_, light_text_;
  ShaderCost cost_, view_cost_, light_cost_;
  std::set<std::string> lit_{"wi"};
  std::map<std::string, std::string> names_;
  std::map<std::string, int> uses_{{"wi", 1}, {"wo", 1}};
};

/// A cost of this many plain operations.
constexpr ShaderCost ops(int operations) noexcept {
  return {.operations = operations};
}

}  // namespace burnish
