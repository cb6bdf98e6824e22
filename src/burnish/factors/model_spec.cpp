// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
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
constexpr Warp kHalfWarp{WarpKind::rational, 0.5}, kVolumeHalfWarp{WarpKind::power, 0.5};
constexpr int kMaxAxes = 3;

struct TableOption {
  std::vector<int> sides;
  bool shared = false;
  std::vector<Warp> warps;
  std::optional<TableFormat> format;
};

int parse_size(std::string_view text, std::string_view option) {
  int n = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), n);
  if (code != std::errc{} || end != text.data() + text.size() || n < 2)
    throw Error(fmt::format(
        "table option '{}': expected a size N, NxN, NxM or NxMxK of at least 2, found '{}'", option, text));
  return n;
}

using TableOptions = std::map<std::string, TableOption, std::less<>>;

TableOptions parse_table_options(std::span<const std::string> options) {
  TableOptions result;
  for (const std::string& text : options) {
    const auto equals = text.find('=');
    if (equals == text.npos || equals == 0)
      throw Error(
          fmt::format("table option: expected NAME=SIZE[,warp...][,shared][,format], found '{}'", text));
    // the sides first, then what else there is in any order
    TableOption option;
    std::string_view rest = std::string_view(text).substr(equals + 1);
    for (bool first = true; first || !rest.empty(); first = false) {
      const std::string_view part = rest.substr(0, rest.find(','));
      rest.remove_prefix(std::min(rest.size(), part.size() + 1));
      if (first) {
        for (std::size_t at = 0, cross = 0; cross != part.npos && option.sides.size() < kMaxAxes;
             at = cross + 1) {
          cross = option.sides.size() + 1 < kMaxAxes ? part.find('x', at) : part.npos;
          option.sides.push_back(parse_size(part.substr(at, cross - at), text));
        }
      } else if (part == "shared") {
        option.shared = true;
      } else if (const auto format = find_table_format(part)) {
        option.format = format;
      } else {
        option.warps.push_back(parse_warp(part));
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

/// NAME(PROJECTION), or with two or three projections.
struct ParsedFactor {
  std::string name;
  FactorUse use;
  int projections = 1;
  bool angle_only = false;
};

ParsedFactor parse_factor(Parser& parser) {
  ParsedFactor factor{.name = parser.name(), .use = {}};
  parser.expect('(');
  const NamedProjection first = parse_projection(parser.until_bracket_or_comma());
  factor.use.projection = first.projection;
  factor.angle_only = first.angle_only;
  for (Projection* more : {&factor.use.projection_y, &factor.use.projection_z}) {
    if (!parser.accept(',')) break;
    *more = parse_projection(parser.until_bracket_or_comma()).projection;
    ++factor.projections;
  }
  parser.expect(')');
  return factor;
}

/// The shape of so many projections and sides.
TableShape shape_of(int projections, std::size_t sides) {
  if (projections == 3) return TableShape::volume;
  if (projections == 2) return TableShape::grid;
  return sides == 1 ? TableShape::line : TableShape::disk;
}

/// Nodes along an axis of a volume over `projection`.
int volume_nodes(const Projection& projection) {
  if (projection == kProjectHalf) return 24;
  return projection == kProjectDifference ? 12 : 8;
}

/// The table that a factor asks for: as the options say, else of the size that its projection needs.
ModelSpec::TableSpec table_for(const ParsedFactor& factor, const TableOptions& options, bool isotropic) {
  ModelSpec::TableSpec table{.name = factor.name};
  TableLayout& layout = table.layout;
  const std::array<Projection, kMaxAxes> over{factor.use.projection, factor.use.projection_y,
                                              factor.use.projection_z};
  const auto given = options.find(factor.name);
  if (given != options.end()) {
    const std::vector<int>& sides = given->second.sides;
    const auto side = [&](std::size_t k) { return k < sides.size() ? sides[k] : 1; };
    layout = {.shape = shape_of(factor.projections, sides.size()),
              .width = side(0),
              .height = side(1),
              .depth = side(2)};
    table.shared = given->second.shared;
    table.format = given->second.format;
  } else if (factor.projections == 3) {
    layout = {.shape = TableShape::volume,
              .width = volume_nodes(over[0]),
              .height = volume_nodes(over[1]),
              .depth = volume_nodes(over[2])};
  } else if (factor.projections == 2) {
    layout = {.shape = TableShape::grid, .width = kLineNodes, .height = kLineNodes};
  } else if (isotropic || factor.angle_only) {
    layout = {.shape = TableShape::line, .width = over[0] == kProjectHalf ? kHalfLineNodes : kLineNodes};
  } else {
    layout = {.shape = TableShape::disk, .width = kDiskNodes, .height = kDiskNodes};
  }

  // spacings: as given, axis by axis, else dense where highlights are narrow
  const auto warp_of = [&](std::size_t axis) {
    if (given != options.end() && axis < given->second.warps.size()) return given->second.warps[axis];
    if (over[axis] != kProjectHalf) return Warp{};
    return layout.shape == TableShape::volume ? kVolumeHalfWarp : kHalfWarp;
  };
  const int axes = projection_count(layout.shape);
  layout.warp = warp_of(0);
  if (axes > 1) layout.warp_y = warp_of(1);
  if (axes > 2) layout.warp_z = warp_of(2);
  if (given != options.end() && given->second.warps.size() > static_cast<std::size_t>(axes))
    throw Error(fmt::format("table '{}': expected at most {} warps, found {}", factor.name, axes,
                            given->second.warps.size()));
  if (factor.angle_only && layout.shape == TableShape::disk)
    throw Error(fmt::format("table '{}': expected a size N for a polar angle, found NxN", factor.name));
  check_layout(layout, factor.name);
  return table;
}

/// The number of the table of that name, a new one for a new name.
std::size_t add_table(ModelSpec& spec, ModelSpec::TableSpec table) {
  const auto known = std::ranges::find(spec.tables, table.name, &ModelSpec::TableSpec::name);
  const auto number = static_cast<std::size_t>(known - spec.tables.begin());
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
