#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/model_spec.h>

namespace burnish {

namespace {

constexpr int kLineNodes = 32, kHalfLineNodes = 64, kDiskNodes = 64;
// Highlights are narrow: near the normal the half vector's nodes stand three times as dense.
constexpr Warp kHalfWarp{WarpKind::rational, 0.5};

struct TableOption {
  int width = 0, height = 1;
  bool has_warp = false, shared = false;
  Warp warp;
  std::optional<TableFormat> format;
};

int parse_size(std::string_view text, std::string_view option) {
  int n = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), n);
  if (code != std::errc{} || end != text.data() + text.size() || n < 2)
    throw Error(fmt::format("table option '{}': expected a size N, NxN or NxM of at least 2, found '{}'",
                            option, text));
  return n;
}

using TableOptions = std::map<std::string, TableOption, std::less<>>;

TableOptions parse_table_options(std::span<const std::string> options) {
  TableOptions result;
  for (const std::string& text : options) {
    const auto equals = text.find('=');
    if (equals == text.npos || equals == 0)
      throw Error(fmt::format("table option: expected NAME=SIZE[,warp][,shared][,format], found '{}'", text));
    TableOption option;
    std::string_view rest = std::string_view(text).substr(equals + 1);
    for (bool first = true; first || !rest.empty(); first = false) {
      const std::string_view part = rest.substr(0, rest.find(','));
      rest.remove_prefix(std::min(rest.size(), part.size() + 1));
      if (first) {
        const auto cross = part.find('x');
        option.width = parse_size(part.substr(0, cross), text);
        if (cross != part.npos) option.height = parse_size(part.substr(cross + 1), text);
      } else if (part == "shared") {
        option.shared = true;
      } else if (const auto format = find_table_format(part)) {
        option.format = format;
      } else {
        option.warp = parse_warp(part);
        option.has_warp = true;
      }
    }
    if (!result.emplace(text.substr(0, equals), option).second)
      throw Error(fmt::format("table option: expected one for each table, found a second for '{}'", text));
  }
  return result;
}

/// Cuts the expression into names, brackets and projections.
class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text), rest_(text) { skip_spaces(); }

  bool done() const { return rest_.empty(); }
  bool accept(char c) {
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    skip_spaces();
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail(fmt::format("'{}'", c));
  }
  std::string name() {
    std::size_t n = 0;
    while (n < rest_.size() && (std::isalnum(static_cast<unsigned char>(rest_[n])) || rest_[n] == '_')) ++n;
    if (n == 0) fail("the name of a table");
    return take(n);
  }
  std::string until_bracket_or_comma() {
    const auto n = rest_.find_first_of("),");
    if (n == rest_.npos) fail("')'");
    return take(n);
  }

 private:
  std::string take(std::size_t n) {
    std::string part(rest_.substr(0, n));
    std::erase(part, ' ');
    rest_.remove_prefix(n);
    skip_spaces();
    return part;
  }
  void skip_spaces() { rest_.remove_prefix(std::min(rest_.size(), rest_.find_first_not_of(' '))); }
  [[noreturn]] void fail(const std::string& expected) const {
    throw Error(fmt::format("model '{}': expected {} at '{}'", text_, expected, rest_));
  }

  std::string_view text_, rest_;
};

/// NAME(PROJECTION) or NAME(PROJECTION,PROJECTION).
struct ParsedFactor {
  std::string name;
  FactorUse use;
  bool grid = false, angle_only = false;
};

ParsedFactor parse_factor(Parser& parser) {
  ParsedFactor factor{.name = parser.name(), .use = {}};
  parser.expect('(');
  const NamedProjection first = parse_projection(parser.until_bracket_or_comma());
  factor.use.projection = first.projection;
  factor.angle_only = first.angle_only;
  factor.grid = parser.accept(',');
  if (factor.grid) factor.use.projection_y = parse_projection(parser.until_bracket_or_comma()).projection;
  parser.expect(')');
  return factor;
}

/// The table that a factor asks for: as the options say, else of the size that its projection needs.
ModelSpec::TableSpec table_for(const ParsedFactor& factor, const TableOptions& options, bool isotropic) {
  ModelSpec::TableSpec table{.name = factor.name};
  TableLayout& layout = table.layout;
  const bool over_half = factor.use.projection == kProjectHalf;
  const auto given = options.find(factor.name);
  if (given != options.end()) {
    const TableOption& o = given->second;
    layout = {.shape = factor.grid     ? TableShape::grid
                       : o.height == 1 ? TableShape::line
                                       : TableShape::disk,
              .width = o.width,
              .height = o.height};
    table.shared = o.shared;
    table.format = o.format;
  } else if (factor.grid) {
    layout = {.shape = TableShape::grid, .width = kLineNodes, .height = kLineNodes};
  } else if (isotropic || factor.angle_only) {
    layout = {.shape = TableShape::line, .width = over_half ? kHalfLineNodes : kLineNodes};
  } else {
    layout = {.shape = TableShape::disk, .width = kDiskNodes, .height = kDiskNodes};
  }

  const bool warp_given = given != options.end() && given->second.has_warp;
  layout.warp = warp_given ? given->second.warp : over_half ? kHalfWarp : Warp{};
  if (factor.grid) layout.warp_y = factor.use.projection_y == kProjectHalf ? kHalfWarp : Warp{};
  if (factor.angle_only && layout.shape == TableShape::disk)
    throw Error(fmt::format("table '{}': expected a size N for a polar angle, found NxN", factor.name));
  check_layout(layout, factor.name);
  return table;
}

/// The number of the table of that name, a new one for a new name.
int add_table(ModelSpec& spec, ModelSpec::TableSpec table) {
  const auto known = std::ranges::find(spec.tables, table.name, &ModelSpec::TableSpec::name);
  const auto number = static_cast<int>(known - spec.tables.begin());
  if (known == spec.tables.end())
    spec.tables.push_back(std::move(table));
  else if (known->layout.shape != table.layout.shape)
    throw Error(fmt::format("table '{}': expected the same shape in every use, found two", table.name));
  return number;
}

}  // namespace

ModelSpec parse_model_spec(std::string_view expression, std::span<const std::string> table_options,
                           bool isotropic) {
  if (expression == "pqp") expression = "p(wo) q(h) p(wi)";
  if (expression == "pqpr") expression = "p(wo) q(h) r(theta_d) p(wi)";
  const TableOptions options = parse_table_options(table_options);

  // lobes are joined by +, a lobe's factors stand one after another
  ModelSpec spec;
  Parser parser(expression);
  bool more = true;
  while (more) {
    std::vector<FactorUse> lobe;
    do {
      const ParsedFactor factor = parse_factor(parser);
      lobe.push_back(factor.use);
      lobe.back().table = add_table(spec, table_for(factor, options, isotropic));
      more = parser.accept('+');
    } while (!parser.done() && !more);
    spec.lobes.push_back(std::move(lobe));
  }

  for (const auto& [name, option] : options)
    if (std::ranges::find(spec.tables, name, &ModelSpec::TableSpec::name) == spec.tables.end())
      throw Error(
          fmt::format("table option: expected a table of the model '{}', found '{}'", expression, name));
  return spec;
}

TableFormat format_of(const ModelSpec::TableSpec& table, TableFormat general) noexcept {
  const bool one_channel = table.shared && general == TableFormat::rgb9e5;
  return table.format.value_or(one_channel ? TableFormat::half : general);
}

}  // namespace burnish
