#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/power/code.h>
#include <burnish/power/expression.h>

namespace burnish {
namespace {

struct Language {
  std::string_view name;
  std::string_view number_suffix;
  std::string_view declare;   // of a local: name, value
  std::string_view function;  // name, parameters, body
  std::string_view parameter;
  std::string_view comment;
  std::string_view helper;  // exponent_of
  std::map<Op, std::string_view> calls;
};

constexpr std::string_view kIfLess = "({0} < {1} ? {2} : {3})";

// clang-format off
const std::vector<Language>& languages() {
  static const std::vector<Language> all = {
      {"c", "f", "  const float {} = {};\n", "static inline float {}({}) {{\n{}}}\n", "float {}", "// {}\n",
       "#include <math.h>\n#include <string.h>\n\n"
       "// n where x = m 2^n, m in [2/3, 4/3)\n"
       "static inline float power_exponent_of(float x) {\n"
       "  int bits;\n  memcpy(&bits, &x, sizeof bits);\n  return (float)((bits - 0x3f2aaaab) >> 23);\n}\n\n",
       {{Op::max, "fmaxf({0}, {1})"}, {Op::min, "fminf({0}, {1})"}, {Op::sqrt, "sqrtf({0})"},
        {Op::exp2, "exp2f({0})"}, {Op::log2, "log2f({0})"}, {Op::acos, "acosf({0})"}, {Op::cos, "cosf({0})"},
        {Op::floor, "floorf({0})"}, {Op::scale_by_two, "ldexpf({0}, (int)({1}))"}, {Op::if_less, kIfLess}}},
      {"cuda", "f", "  const float {} = {};\n", "__device__ inline float {}({}) {{\n{}}}\n", "float {}", "// {}\n",
       "// n where x = m 2^n, m in [2/3, 4/3)\n"
       "__device__ inline float power_exponent_of(float x) {\n"
       "  return (float)((__float_as_int(x) - 0x3f2aaaab) >> 23);\n}\n\n",
       {{Op::max, "fmaxf({0}, {1})"}, {Op::min, "fminf({0}, {1})"}, {Op::sqrt, "sqrtf({0})"},
        {Op::exp2, "exp2f({0})"}, {Op::log2, "log2f({0})"}, {Op::acos, "acosf({0})"}, {Op::cos, "cosf({0})"},
        {Op::floor, "floorf({0})"}, {Op::scale_by_two, "ldexpf({0}, (int)({1}))"}, {Op::if_less, kIfLess}}},
      {"glsl", "", "  float {} = {};\n", "float {}({}) {{\n{}}}\n", "float {}", "// {}\n",
       "// n where x = m 2^n, m in [2/3, 4/3)\n"
       "float power_exponent_of(float x) {\n"
       "  return float((floatBitsToInt(x) - 0x3f2aaaab) >> 23);\n}\n\n",
       {{Op::max, "max({0}, {1})"}, {Op::min, "min({0}, {1})"}, {Op::sqrt, "sqrt({0})"}, {Op::exp2, "exp2({0})"},
        {Op::log2, "log2({0})"}, {Op::acos, "acos({0})"}, {Op::cos, "cos({0})"}, {Op::floor, "floor({0})"},
        {Op::scale_by_two, "ldexp({0}, int({1}))"}, {Op::if_less, kIfLess}}},
      {"glsl_es", "", "  float {} = {};\n", "float {}({}) {{\n{}}}\n", "float {}", "// {}\n",
       "// n where x = m 2^n, m in [2/3, 4/3)\n"
       "float power_exponent_of(float x) {\n"
       "  return float((floatBitsToInt(x) - 0x3f2aaaab) >> 23);\n}\n\n",
       {{Op::max, "max({0}, {1})"}, {Op::min, "min({0}, {1})"}, {Op::sqrt, "sqrt({0})"}, {Op::exp2, "exp2({0})"},
        {Op::log2, "log2({0})"}, {Op::acos, "acos({0})"}, {Op::cos, "cos({0})"}, {Op::floor, "floor({0})"},
        {Op::scale_by_two, "{0} * exp2({1})"}, {Op::if_less, kIfLess}}},
      {"hlsl", "", "  float {} = {};\n", "float {}({}) {{\n{}}}\n", "float {}", "// {}\n",
       "// n where x = m 2^n, m in [2/3, 4/3)\n"
       "float power_exponent_of(float x) {\n  return float((asint(x) - 0x3f2aaaab) >> 23);\n}\n\n",
       {{Op::max, "max({0}, {1})"}, {Op::min, "min({0}, {1})"}, {Op::sqrt, "sqrt({0})"}, {Op::exp2, "exp2({0})"},
        {Op::log2, "log2({0})"}, {Op::acos, "acos({0})"}, {Op::cos, "cos({0})"}, {Op::floor, "floor({0})"},
        {Op::scale_by_two, "ldexp({0}, {1})"}, {Op::if_less, kIfLess}}},
      {"msl", "f", "  const float {} = {};\n", "inline float {}({}) {{\n{}}}\n", "float {}", "// {}\n",
       "// n where x = m 2^n, m in [2/3, 4/3)\n"
       "inline float power_exponent_of(float x) {\n"
       "  return float((as_type<int>(x) - 0x3f2aaaab) >> 23);\n}\n\n",
       {{Op::max, "max({0}, {1})"}, {Op::min, "min({0}, {1})"}, {Op::sqrt, "sqrt({0})"}, {Op::exp2, "exp2({0})"},
        {Op::log2, "log2({0})"}, {Op::acos, "acos({0})"}, {Op::cos, "cos({0})"}, {Op::floor, "floor({0})"},
        {Op::scale_by_two, "ldexp({0}, int({1}))"}, {Op::if_less, kIfLess}}},
      {"rust", "f32", "    let {} = {};\n", "pub fn {}({}) -> f32 {{\n{}}}\n", "{}: f32", "// {}\n",
       "/// n where x = m 2^n, m in [2/3, 4/3)\n"
       "fn power_exponent_of(x: f32) -> f32 {\n    ((x.to_bits() as i32 - 0x3f2aaaab) >> 23) as f32\n}\n\n",
       {{Op::max, "({0}).max({1})"}, {Op::min, "({0}).min({1})"}, {Op::sqrt, "({0}).sqrt()"},
        {Op::exp2, "({0}).exp2()"}, {Op::log2, "({0}).log2()"}, {Op::acos, "({0}).acos()"},
        {Op::cos, "({0}).cos()"}, {Op::floor, "({0}).floor()"}, {Op::scale_by_two, "{0} * ({1}).exp2()"},
        {Op::if_less, "(if {0} < {1} {{ {2} }} else {{ {3} }})"}}},
      {"wgsl", "", "  let {} = {};\n", "fn {}({}) -> f32 {{\n{}}}\n", "{}: f32", "// {}\n",
       "// n where x = m 2^n, m in [2/3, 4/3)\n"
       "fn power_exponent_of(x: f32) -> f32 {\n  return f32((bitcast<i32>(x) - 0x3f2aaaab) >> 23u);\n}\n\n",
       {{Op::max, "max({0}, {1})"}, {Op::min, "min({0}, {1})"}, {Op::sqrt, "sqrt({0})"}, {Op::exp2, "exp2({0})"},
        {Op::log2, "log2({0})"}, {Op::acos, "acos({0})"}, {Op::cos, "cos({0})"}, {Op::floor, "floor({0})"},
        {Op::scale_by_two, "ldexp({0}, i32({1}))"}, {Op::if_less, "select({3}, {2}, {0} < {1})"}}},
  };
  return all;
}
// clang-format on

const Language& language(std::string_view name) {
  std::string known;
  for (const Language& l : languages()) {
    if (l.name == name) return l;
    known += (known.empty() ? "" : ", ") + std::string(l.name);
  }
  throw Error(fmt::format("language: expected one of {}, found {}", known, name));
}

using Node = Expr::Node;

// Writes expression graphs as statements: terms used more than once become locals.
class Writer {
 public:
  explicit Writer(const Language& l) : language_(l) {}

  // Prepares the use counts of everything below `root`.
  void add_root(const Expr& root) { count(root.node().get()); }
  std::string text(const Expr& root) { return operand(root.node().get()); }
  const std::string& statements() const noexcept { return statements_; }
  bool uses_exponent_of() const noexcept { return uses_exponent_of_; }

 private:
  void count(const Node* node) {
    if (++uses_[node] > 1) return;
    for (const auto& argument : node->arguments) count(argument.get());
  }

  std::string number(double value) const {
    std::string digits = fmt::format("{:.9g}", value);
    if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
    digits += language_.number_suffix;
    return value < 0 ? "(" + digits + ")" : digits;
  }

  std::string operand(const Node* node) {
    if (node->op == Op::constant) return number(node->constant);
    if (node->op == Op::input) return node->input;
    if (const auto known = names_.find(node); known != names_.end()) return known->second;
    std::string text = formula(node);
    if (uses_[node] < 2) return text;
    const std::string name = fmt::format("t{}", names_.size());
    statements_ += fmt::format(fmt::runtime(language_.declare), name, text);
    return names_[node] = name;
  }

  std::string formula(const Node* node) {
    std::vector<std::string> a;
    for (const auto& argument : node->arguments) a.push_back(operand(argument.get()));
    switch (node->op) {
      case Op::add:
        return fmt::format("({} + {})", a[0], a[1]);
      case Op::subtract:
        return fmt::format("({} - {})", a[0], a[1]);
      case Op::multiply:
        return fmt::format("({} * {})", a[0], a[1]);
      case Op::divide:
        return fmt::format("({} / {})", a[0], a[1]);
      case Op::mul_add:
        return fmt::format("({} * {} + {})", a[0], a[1], a[2]);
      case Op::neg_mul_add:
        return fmt::format("({} - {} * {})", a[2], a[0], a[1]);
      case Op::exponent_of:
        uses_exponent_of_ = true;
        return fmt::format("power_exponent_of({})", a[0]);
      default:
        a.resize(4);
        return fmt::format(fmt::runtime(language_.calls.at(node->op)), a[0], a[1], a[2], a[3]);
    }
  }

  const Language& language_;
  std::map<const Node*, int> uses_;
  std::map<const Node*, std::string> names_;
  std::string statements_;
  bool uses_exponent_of_ = false;
};

}  // namespace

std::vector<std::string_view> code_languages() {
  std::vector<std::string_view> names;
  for (const Language& l : languages()) names.push_back(l.name);
  return names;
}

std::string power_code(PowerMethod method, const CodeOptions& options) {
  const Language& l = language(options.language);
  const PowerInfo& info = power_info(method);
  if (options.normalize && !options.exponent) throw Error("a normalized member's code needs an exponent");

  std::vector<Expr> k;
  double bound = info.bounds.front().bound;
  if (options.exponent) {
    const PowerCoefficients constants = power_coefficients(method, *options.exponent);
    for (int i = 0; i < constants.count; ++i) k.emplace_back(constants.k[static_cast<std::size_t>(i)]);
    bound = power_bound(method, *options.exponent);
  } else {
    k = power_coefficient_expressions(method);
  }
  Expr value = power_value_expression(method, k);
  if (options.normalize) value = Expr(Op::multiply, {value, power_normalization(method, *options.exponent)});

  Writer writer(l);
  writer.add_root(value);
  const std::string result = writer.text(value);
  const std::string indent = l.name == "rust" ? "    " : "  ";
  const std::string body =
      writer.statements() + (l.name == "rust" ? fmt::format("{}{}\n", indent, result)
                                              : fmt::format("{}return {};\n", indent, result));
  const auto parameter = [&](std::string_view name) { return fmt::format(fmt::runtime(l.parameter), name); };
  const std::string parameters = options.exponent ? parameter("c") : parameter("c") + ", " + parameter("e");

  std::string code = fmt::format(fmt::runtime(l.comment), "Generated by burnish specular code; do not edit.");
  const auto comment = [&](const std::string& text) { code += fmt::format(fmt::runtime(l.comment), text); };
  if (l.name == "msl")
    comment("No compiler has checked this file: none for MSL is at hand where it is tested.");
  if (options.exponent)
    comment(fmt::format("c^{} for c in [0, 1]{}", *options.exponent,
                        options.normalize ? ", scaled to the energy of the power" : ""));
  else
    comment(fmt::format("c^e for c in [0, 1], e in [{}, {}]", info.min_exponent(), info.max_exponent()));
  comment(fmt::format("{}: {}; error at most {} before rounding{}", info.name, info.formula, bound,
                      options.normalize ? " and scaling" : ""));
  if (writer.uses_exponent_of())
    code += l.helper;
  else if (l.name == "c")
    code += "#include <math.h>\n\n";
  return code + fmt::format(fmt::runtime(l.function), fmt::format("power_{}", info.name), parameters, body);
}

std::string quadratic_table(std::string_view format, int count, int fraction_bits) {
  if (count < 1 || count > static_cast<int>(kMaxExponent))
    throw Error(fmt::format("table length: expected 1 to {}, found {}", kMaxExponent, count));
  if (fraction_bits < 0 || fraction_bits > 20)
    throw Error(fmt::format("fraction bits: expected 0 to 20, found {}", fraction_bits));
  std::string text;
  if (format == "csv") {
    text = "exponent,a\n";
    for (int e = 1; e <= count; ++e) text += fmt::format("{},{:.17g}\n", e, quadratic_coefficient(e));
  } else if (format == "c") {
    text =
        "/* Generated by burnish specular table; do not edit.\n"
        "   cos^e = a cos^2 + (1 - a) cos; a by exponent, entry 0 unused. */\n";
    text += fmt::format("static const float burnish_quadratic_a[{}] = {{\n    0.0f,\n", count + 1);
    for (int e = 1; e <= count; ++e) {
      const float a = static_cast<float>(quadratic_coefficient(e));
      text += fmt::format("    {:.9g}{}f,\n", a, a == std::floor(a) ? ".0" : "");
    }
    text += "};\n";
  } else if (format == "mem") {
    const double scale = std::ldexp(1.0, fraction_bits);
    const auto word = [&](int e) { return std::llround(quadratic_coefficient(e) * scale); };
    const int digits = static_cast<int>(fmt::format("{:x}", word(count)).size());
    text = fmt::format(
        "// Generated by burnish specular table; do not edit.\n"
        "// PROM of a(e), address e = 0 to {}, unsigned fixed point with {} fraction bits.\n",
        count, fraction_bits);
    for (int e = 0; e <= count; ++e) text += fmt::format("{:0{}x}\n", e == 0 ? 0 : word(e), digits);
  } else {
    throw Error(fmt::format("table format: expected c, csv or mem, found {}", format));
  }
  return text;
}

}  // namespace burnish
