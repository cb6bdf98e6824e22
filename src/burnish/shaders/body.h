#pragma once

#include <map>
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
    text_ += dialect_.declaration(type, known->second, expression);
    cost_.fetches += cost.fetches;
    cost_.operations += cost.operations;
    cost_.divisions += cost.divisions;
    cost_.roots += cost.roots;
    cost_.powers += cost.powers;
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

 private:
  const Dialect& dialect_;
  std::string text_;
  ShaderCost cost_;
  std::map<std::string, std::string> names_;
  std::map<std::string, int> uses_{{"wi", 1}, {"wo", 1}};
};

/// A cost of this many plain operations.
constexpr ShaderCost ops(int operations) noexcept {
  return {.operations = operations};
}

}  // namespace burnish
