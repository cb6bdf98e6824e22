// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <burnish/io/csv_columns.h>
#include <burnish/io/sample_file.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxHeader = 1 << 16;  // bytes of the line of names

template <std::size_t n>
bool among(const std::array<std::string_view, n>& names, std::string_view name) noexcept {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

/// A column's name in this file's words: lower case, '_' between them, its unit apart.
struct ColumnName {
  std::string name, unit;
};

// Degrees have their sign in UTF-8 or Latin-1, or the ordinal sign that is often taken for it.
constexpr std::array<std::string_view, 7> kDegrees = {"deg",      "degs", "degree",  "degrees",
                                                      "\xc2\xb0", "\xb0", "\xc2\xba"};
constexpr std::array<std::string_view, 4> kRadians = {"rad", "rads", "radian", "radians"};

ColumnName plain_name(std::string_view cell) {
  std::string text = lower_case(cell);
  for (const auto& [letter, word] :
       {std::pair{"\xce\xb8", "theta"}, std::pair{"\xcf\x86", "phi"}, std::pair{"\xcf\x95", "phi"},
        std::pair{"\xce\xbb", "lambda"}, std::pair{"\xc2\xb5m", "um"}, std::pair{"\xce\xbcm", "um"}})
    replace_all(text, letter, word);
  ColumnName result;
  // A unit in brackets may stand at the end.
  if (!text.empty() && (text.back() == ')' || text.back() == ']' || text.back() == '}')) {
    const std::size_t open = text.find_last_of("([{");
    // The angle of a cosine is no unit.
    if (open != std::string::npos && open > 0 && !text.substr(0, open).ends_with("cos")) {
      result.unit = trimmed(std::string_view(text).substr(open + 1, text.size() - open - 2));
      text.erase(open);
    }
  }
  // Every sign between words becomes '_'; a point between digits stays.
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool point = c == '.' && i + 1 < text.size() && text[i + 1] >= '0' && text[i + 1] <= '9';
    const bool letter =
        (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80;
    if (letter || point)
      result.name += c;
    else if (!result.name.empty() && result.name.back() != '_')
      result.name += '_';
  }
  while (!result.name.empty() && result.name.back() == '_') result.name.pop_back();
  // A unit may be the last word.
  const std::size_t last = result.name.rfind('_');
  if (result.unit.empty() && last != std::string::npos) {
    const std::string word = result.name.substr(last + 1);
    if (among(kDegrees, word) || among(kRadians, word)) {
      result.unit = word;
      result.name.erase(last);
    }
  }
  return result;
}

/// The role of a direction's column. Names with s are of the scattered direction, or of the source beside a view.
enum class Role { theta_i, phi_i, theta_o, phi_o, theta_s, phi_s, theta, phi, turn, vector, none };

constexpr std::array<std::string_view, 16> kIncident = {
    "i",     "in", "inc",  "incident", "incidence", "incoming", "illumination", "illum",
    "light", "l",  "lamp", "source",   "src",       "sun",      "solar",        "inci"};
constexpr std::array<std::string_view, 20> kOutgoing = {
    "o",    "out",     "outgoing", "r",   "refl",     "reflected",   "v",   "view",     "viewing", "viewer",
    "exit", "exitant", "e",        "obs", "observer", "observation", "det", "detector", "sensor",  "camera"};
constexpr std::array<std::string_view, 5> kScattered = {"s", "scat", "scatter", "scattered", "sc"};
constexpr std::array<std::string_view, 7> kPolar = {"theta", "zenith", "zen", "polar", "z", "th", "angle"};
constexpr std::array<std::string_view, 5> kAround = {"phi", "azimuth", "azi", "az", "a"};
constexpr std::array<std::string_view, 10> kTurns = {
    "dphi",         "delta_phi",    "phi_d", "relative_azimuth", "rel_azimuth",
    "azimuth_diff", "relative_phi", "raa",   "phi_rel",          "azimuth_difference"};

constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};

/// Returns the place of a vector's component among wi_x ... wo_z.
std::optional<std::size_t> component_of(std::string_view name) {
  std::string text(name);
  text.erase(std::remove(text.begin(), text.end(), '_'), text.end());
  if (text.empty()) return std::nullopt;
  const auto axis = std::find(kAxes.begin(), kAxes.end(), text.substr(text.size() - 1));
  if (axis == kAxes.end()) return std::nullopt;
  text.pop_back();
  const auto at = static_cast<std::size_t>(axis - kAxes.begin());
  if (text == "wi" || text == "l" || text == "i" || text == "omegai") return at;
  if (text == "wo" || text == "v" || text == "o" || text == "omegao") return at + 3;
  return std::nullopt;
}

Role role_of(std::string_view name) {
  if (component_of(name)) return Role::vector;
  if (name == "aoi" || name == "angle_of_incidence" || name == "sza" || name == "incident_angle")
    return Role::theta_i;
  if (name == "saa") return Role::phi_i;
  if (name == "vza") return Role::theta_o;
  if (name == "vaa") return Role::phi_o;
  if (among(kTurns, name)) return Role::turn;
  if (name == "theta") return Role::theta;
  if (name == "phi") return Role::phi;
  // A name has an angle's word and a side's, in either order.
  const auto role = [&](std::string_view angle, std::string_view side) {
    const bool polar = among(kPolar, angle);
    if (!polar && !among(kAround, angle)) return Role::none;
    if (among(kIncident, side)) return polar ? Role::theta_i : Role::phi_i;
    if (among(kOutgoing, side)) return polar ? Role::theta_o : Role::phi_o;
    if (among(kScattered, side)) return polar ? Role::theta_s : Role::phi_s;
    return Role::none;
  };
  if (const std::size_t bar = name.find('_'); bar != std::string_view::npos) {
    const std::string_view first = name.substr(0, bar);
    std::string_view second = name.substr(bar + 1);
    if (second.ends_with("_angle")) second.remove_suffix(6);
    if (const Role found = role(first, second); found != Role::none) return found;
    return role(second, first);
  }
  for (const std::string_view angle : {"theta", "phi"})
    if (name.starts_with(angle)) return role(angle, name.substr(angle.size()));
  return Role::none;
}

/// The parts of a value column's name.
struct ValueName {
  std::optional<ValueKind> kind;
  std::optional<std::size_t> colour;  // 0, 1, 2: red, green, blue
  std::optional<double> lambda_nm;
};

constexpr double kLeast_nm = 50, kMost_nm = 1e6;  // range of bare numbers that are wavelengths

std::optional<ValueName> wavelength_name(std::string_view name) {
  double scale = 1;
  bool unit = true;
  if (name.ends_with("nm"))
    name.remove_suffix(2);
  else if (name.ends_with("um"))
    name.remove_suffix(2), scale = 1000;
  else
    unit = false;
  if (name.ends_with('_')) name.remove_suffix(1);
  const std::size_t letters = name.find_last_not_of("0123456789.");
  const std::size_t digits = letters == std::string_view::npos ? 0 : letters + 1;
  const auto number = parse_number(name.substr(digits));
  if (!number) return std::nullopt;
  std::string_view word = name.substr(0, digits);
  if (word.ends_with('_')) word.remove_suffix(1);
  ValueName found{.kind = kind_of_name(word), .colour = {}, .lambda_nm = *number * scale};
  if (word == "value") {  // burnish's own name, at any wavelength
    found.kind.reset();
    return found;
  }
  constexpr std::array<std::string_view, 5> kWords = {"", "lambda", "wavelength", "wl", "w"};
  if (!found.kind && !among(kWords, word)) return std::nullopt;
  if (!unit && !(*found.lambda_nm >= kLeast_nm && *found.lambda_nm <= kMost_nm)) return std::nullopt;
  return found;
}

/// A column of wavelengths and its factor to nanometres; `to_nm` is empty if its name has no unit.
struct WavelengthColumn {
  std::optional<double> to_nm;
};

std::optional<WavelengthColumn> wavelength_column(const ColumnName& column) {
  constexpr std::array<std::string_view, 5> kWords = {"wavelength", "wavelengths", "lambda", "wl",
                                                      "wave_length"};
  const auto factor = [](std::string_view unit) -> std::optional<double> {
    if (unit == "nm" || unit == "nanometer" || unit == "nanometers" || unit == "nanometre") return 1;
    if (unit == "um" || unit == "micron" || unit == "microns" || unit == "micrometer") return 1e3;
    if (unit == "m") return 1e9;
    return std::nullopt;
  };
  if (among(kWords, column.name))
    return column.unit.empty() || factor(column.unit) ? std::optional(WavelengthColumn{factor(column.unit)})
                                                      : std::nullopt;
  const std::size_t bar = column.name.rfind('_');
  if (bar == std::string::npos || !among(kWords, std::string_view(column.name).substr(0, bar)))
    return std::nullopt;
  const auto to_nm = factor(std::string_view(column.name).substr(bar + 1));
  return to_nm ? std::optional(WavelengthColumn{to_nm}) : std::nullopt;
}

std::optional<ValueName> value_name(std::string_view name) {
  if (name == "value" || name == "values" || name == "val") return ValueName{};
  if (const auto kind = kind_of_name(name)) return ValueName{.kind = kind, .colour = {}, .lambda_nm = {}};
  if (const auto spectral = wavelength_name(name)) return spectral;
  // A colour stands alone or beside a kind's word.
  const auto colour = [](std::string_view word) -> std::optional<std::size_t> {
    for (std::size_t c = 0; c < 3; ++c)
      if (word == std::array{"r", "g", "b"}[c] || word == std::array{"red", "green", "blue"}[c]) return c;
    return std::nullopt;
  };
  if (const auto c = colour(name)) return ValueName{.kind = {}, .colour = c, .lambda_nm = {}};
  for (const std::size_t bar : {name.find('_'), name.rfind('_')}) {
    if (bar == std::string_view::npos) break;
    const std::string_view first = name.substr(0, bar), second = name.substr(bar + 1);
    for (const auto& [word, rest] : {std::pair{first, second}, std::pair{second, first}})
      if (const auto c = colour(word))
        if (const auto kind = kind_of_name(rest))
          return ValueName{.kind = kind, .colour = c, .lambda_nm = {}};
  }
  return std::nullopt;
}

/// Sorts a line's names by their meaning.
class Sorter {
 public:
  Sorter(const TextReader& reader, const CsvHeader& header)
      : reader_(reader), cells_(split_names(header.line, header.separator)) {
    for (const std::string_view cell : cells_) names_.push_back(plain_name(cell));
    columns_.separator = header.separator;
    columns_.count = cells_.size();
    used_.assign(cells_.size(), false);
  }

  CsvColumns sort(bool with_values, std::span<const std::string_view> others) {
    for (const std::string_view other : others) {
      std::optional<std::size_t>& at = columns_.others.emplace_back();
      for (std::size_t k = 0; k < names_.size(); ++k)
        if (names_[k].name == other) take(at, k);
    }
    directions();
    if (with_values) values();
    for (std::size_t k = 0; k < cells_.size(); ++k)
      if (!used_[k]) columns_.unknown.push_back(printable(cells_[k].empty() ? "(no name)" : cells_[k], 40));
    return std::move(columns_);
  }

 private:
  void take(std::optional<std::size_t>& place, std::size_t column) {
    if (place)
      reader_.fail(fmt::format("one column {}", in_quotes(cells_[*place])),
                   fmt::format("{} too", in_quotes(cells_[column])));
    place = column;
    used_[column] = true;
  }

  [[noreturn]] void missing(const char* name) const {
    reader_.fail(fmt::format("a column {}", name), in_quotes(reader_.line()));
  }

  void directions() {
    constexpr std::array kNames = {"wi_x", "wi_y", "wi_z", "wo_x", "wo_y", "wo_z"};
    std::array<std::optional<std::size_t>, 6> vector;
    std::map<Role, std::optional<std::size_t>> found;
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (used_[k]) continue;
      const Role role = role_of(names_[k].name);
      if (role == Role::vector)
        take(vector[*component_of(names_[k].name)], k);
      else if (role != Role::none)
        take(found[role], k);
    }
    columns_.vectors =
        std::any_of(vector.begin(), vector.end(), [](const auto& at) { return at.has_value(); });
    if (columns_.vectors) {
      for (std::size_t k = 0; k < 6; ++k)
        if (!vector[k]) missing(kNames[k]);
      columns_.direction = vector;
      // Angles beside vectors repeat the same directions.
      for (const auto& [role, at] : found)
        if (at) used_[*at] = false;
      return;
    }
    // The letter s is the scattered direction, or the source's beside another outgoing one.
    const bool s_is_source = !found[Role::theta_i] && found[Role::theta_o];
    const auto give = [&](Role from, Role to) {
      if (!found[from]) return;
      if (found[to])
        reader_.fail(fmt::format("one column {}", in_quotes(cells_[*found[to]])),
                     fmt::format("{} too", in_quotes(cells_[*found[from]])));
      found[to] = found[from];
    };
    give(Role::theta_s, s_is_source ? Role::theta_i : Role::theta_o);
    give(Role::phi_s, s_is_source ? Role::phi_i : Role::phi_o);
    give(Role::theta, Role::theta_o);
    if (found[Role::phi]) give(Role::phi, found[Role::phi_i] ? Role::phi_o : Role::turn);
    if (!found[Role::theta_i]) missing("theta_i");
    if (!found[Role::theta_o]) missing("theta_o");
    columns_.relative_azimuth = found[Role::turn] && !found[Role::phi_o];
    if (found[Role::turn] && found[Role::phi_o]) used_[*found[Role::turn]] = false;
    columns_.direction = {found[Role::theta_i],
                          found[Role::phi_i],
                          found[Role::theta_o],
                          columns_.relative_azimuth ? found[Role::turn] : found[Role::phi_o],
                          {},
                          {}};
    if (found[Role::phi_i] && !columns_.direction[3]) missing("phi_o");
    columns_.in_plane = !columns_.direction[1] && !columns_.direction[3];
    for (std::size_t k = 0; k < 4; ++k) {
      if (!columns_.direction[k]) continue;
      const std::string& unit = names_[*columns_.direction[k]].unit;
      const bool is_rad = among(kRadians, unit);
      if (!unit.empty() && !is_rad && !among(kDegrees, unit))
        reader_.fail(
            fmt::format("degrees or radians for the column {}", in_quotes(cells_[*columns_.direction[k]])),
            in_quotes(unit));
      columns_.units_named = columns_.units_named || !unit.empty();
      columns_.to_radians[k] = is_rad ? 1 : radians(1);
    }
  }

  /// Columns of one kind: a single one, three colours, or spectra.
  struct Group {
    std::optional<std::size_t> single;
    std::array<std::optional<std::size_t>, 3> colours;
    std::map<double, std::size_t> spectrum;
  };

  void values() {
    // f_r alone is a value; f_r with f_g and f_b is a colour.
    const bool f_is_colour =
        std::any_of(names_.begin(), names_.end(), [](const auto& n) { return n.name == "f_g"; });
    std::map<int, Group> groups;  // by kind, names without a kind first
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (used_[k]) continue;
      std::string name = names_[k].name;
      if (names_[k].unit == "nm" || names_[k].unit == "um") name += names_[k].unit;
      auto value = f_is_colour && name == "f_r" ? ValueName{ValueKind::f, 0, {}} : value_name(name);
      if (!value) {
        if (name.find("_cos") != std::string::npos || name == "fcos" || name == "brdfcos")
          reader_.fail("the cosine of theta_i or of theta_o in the name of a column", in_quotes(cells_[k]));
        if (const auto wavelength = wavelength_column(names_[k])) {
          take(columns_.wavelength, k);
          columns_.to_nm = wavelength->to_nm;
        }
        continue;
      }
      Group& group = groups[value->kind ? 1 + static_cast<int>(*value->kind) : 0];
      if (value->lambda_nm) {
        if (!group.spectrum.emplace(*value->lambda_nm, k).second)
          reader_.fail("a wavelength once", in_quotes(cells_[k]));
        used_[k] = true;
      } else {
        take(value->colour ? group.colours[*value->colour] : group.single, k);
      }
    }
    for (auto& [kind, group] : groups) {
      const bool colours = group.colours[0] && group.colours[1] && group.colours[2];
      if (columns_.values.empty()) {
        if (group.single)
          columns_.values = {*group.single};
        else if (colours)
          for (const auto& at : group.colours) columns_.values.push_back(*at);
        else
          for (const auto& [lambda, at] : group.spectrum) {
            columns_.values.push_back(at);
            columns_.lambda_nm.push_back(lambda);
          }
        if (!columns_.values.empty() && kind > 0) columns_.kind = static_cast<ValueKind>(kind - 1);
      }
      // Columns that are left over are unknown again.
      const auto leave = [&](std::optional<std::size_t> at) {
        if (at && std::find(columns_.values.begin(), columns_.values.end(), *at) == columns_.values.end())
          used_[*at] = false;
      };
      leave(group.single);
      for (const auto& at : group.colours) leave(at);
      for (const auto& [lambda, at] : group.spectrum) leave(at);
    }
    if (columns_.wavelength && (columns_.values.size() > 1 || !columns_.lambda_nm.empty()))
      reader_.fail(fmt::format("one column of values beside {}", in_quotes(cells_[*columns_.wavelength])),
                   fmt::format("{}", columns_.values.size()));
    if (columns_.values.empty())
      reader_.fail("columns r, g, b or value or value_<nm>", in_quotes(reader_.line()));
    if (columns_.values.size() > kMaxFileChannels)
      reader_.fail(fmt::format("at most {} wavelengths", kMaxFileChannels),
                   fmt::format("{}", columns_.values.size()));
  }

  const TextReader& reader_;
  const std::vector<std::string_view> cells_;
  std::vector<ColumnName> names_;
  std::vector<bool> used_;
  CsvColumns columns_;
};

}  // namespace

void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  std::size_t at = 0;
  for (;;) {
    while (at < line.size() && line[at] != separator && blank(line[at])) ++at;
    if (separator == ' ')
      while (at < line.size() && blank(line[at])) ++at;
    if (at == line.size()) return;
    std::string_view cell;
    if (line[at] == '"') {
      std::size_t close = line.find('"', at + 1);
      while (close != std::string_view::npos && close + 1 < line.size() && line[close + 1] == '"')
        close = line.find('"', close + 2);
      close = std::min(close, line.size());
      const std::size_t end = std::min(line.find(separator, close), line.size());
      // Text behind the quotes belongs to the cell, which then is no number.
      const std::size_t after = std::min(close + 1, end);
      cell = trimmed(line.substr(after, end - after)).empty() ? trimmed(line.substr(at + 1, close - at - 1))
                                                              : trimmed(line.substr(at, end - at));
      at = end;
    } else {
      std::size_t end = at;
      while (end < line.size() && line[end] != separator && !(separator == ' ' && line[end] == '\t')) ++end;
      cell = trimmed(line.substr(at, end - at));
      at = end;
    }
    cells.push_back(cell);
    if (at == line.size()) return;
    ++at;
  }
}

std::vector<std::string_view> split_names(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  split_cells(line, separator, cells);
  if (separator != ' ') return cells;
  // A unit in brackets belongs to the word before it.
  std::vector<std::string_view> names;
  for (const std::string_view cell : cells) {
    if (!names.empty() && (cell.starts_with('[') || cell.starts_with('(')))
      names.back() = {names.back().data(),
                      static_cast<std::size_t>(cell.data() + cell.size() - names.back().data())};
    else
      names.push_back(cell);
  }
  return names;
}

std::optional<CsvHeader> header_of(std::string_view line) {
  CsvHeader header{.line = trimmed(line), .commented = false, .separator = ','};
  if (header.line.size() > kMaxHeader) return std::nullopt;
  while (header.line.starts_with('#') || header.line.starts_with('%')) {
    header.commented = true;
    header.line = trimmed(header.line.substr(1));
  }
  for (const char separator : {';', '\t', ',', ' '}) {
    if (header.line.find(separator) == std::string_view::npos) continue;
    std::size_t directions = 0, polar = 0;
    for (const std::string_view cell : split_names(header.line, separator)) {
      const Role role = role_of(plain_name(cell).name);
      directions += role != Role::none;
      polar +=
          role == Role::theta_i || role == Role::theta_o || role == Role::theta_s || role == Role::vector;
    }
    if (directions < 2 || polar == 0) continue;
    header.separator = separator;
    return header;
  }
  return std::nullopt;
}

CsvColumns read_columns(const TextReader& reader, const CsvHeader& header, bool with_values,
                        std::span<const std::string_view> others) {
  return Sorter(reader, header).sort(with_values, others);
}

double CellNumbers::number(const TextReader& reader, std::string_view cell, std::string_view column) {
  std::string_view word = cell;
  std::array<char, 64> buffer;
  if (const std::size_t comma = cell.find(',');
      comma != std::string_view::npos && cell.size() <= buffer.size()) {
    if (points_ || cell.find('.') != std::string_view::npos)
      reader.fail(fmt::format("one decimal mark, for the column {}", column), in_quotes(cell));
    commas_ = true;
    std::copy(cell.begin(), cell.end(), buffer.begin());
    buffer[comma] = '.';
    word = {buffer.data(), cell.size()};
  } else if (cell.find('.') != std::string_view::npos) {
    if (commas_) reader.fail(fmt::format("one decimal mark, for the column {}", column), in_quotes(cell));
    points_ = true;
  }
  if (const auto value = parse_number(word)) return *value;
  reader.fail(fmt::format("a finite number for {}", column), cell.empty() ? "nothing" : in_quotes(cell));
}

bool is_missing(std::string_view cell) {
  constexpr std::array<std::string_view, 6> kWords = {"nan", "na", "n/a", "null", "none", "#n/a"};
  if (cell.find_first_not_of('-') == std::string_view::npos) return true;
  return cell.size() <= 4 && among(kWords, lower_case(cell));
}

}  // namespace burnish
