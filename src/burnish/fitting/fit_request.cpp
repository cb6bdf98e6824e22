// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/error.h>
#include <burnish/fitting/fit_request.h>
#include <burnish/math/closest_name.h>

namespace burnish {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kAuto = "auto";
constexpr double kMostSamples = 100'000'000;

// clang-format off
const std::vector<FitOption>& option_rows() {
  static const std::vector<FitOption> table{
      {.name = "method", .takes = FitValue::text,
       .help = "Fits another kind of model instead of positive factors, at as many bytes.",
       .example = "svd",
       .left_out = "positive factors",
       .excludes = {"model", "tables", "fetches", "lobes", "search", "loss", "smooth", "floor", "reweightings",
                    "format", "book", "conserve_energy"},
       .in_pages = false},
      {.name = "budget", .takes = FitValue::bytes,
       .help = "Fits the best model within this many bytes; auto stops where more bytes would store noise or hardly "
               "help.",
       .example = "16K",
       .least = 1, .most = static_cast<double>(kMaxBudget),
       .left_out = "16K with 2 fetches, 3 for some nodes, 6 for anisotropic sources; 2640 for a method",
       .excludes = {"model", "tables", "book"}},
      {.name = "fetches", .takes = FitValue::whole,
       .help = "Allows at most this many filtered reads of tables in one evaluation.",
       .example = "2",
       .least = 1, .most = 256,
       .left_out = "the fewest tried whose error is within two percent of the least; with auto 2, 3 for some nodes, 6 "
                   "for anisotropic sources",
       .needs = "budget", .excludes = {"lobes", "search"}},
      {.name = "lobes", .takes = FitValue::whole,
       .help = "Uses this many lobes of lines or hemispheres.",
       .example = "3",
       .least = 1, .most = 64,
       .left_out = "as many as serve",
       .needs = "budget"},
      {.name = "loss", .takes = FitValue::choice,
       .help = "Refines several lobes for this error: image (pictures at every exposure, both means), or one mean.",
       .example = "relative",
       .choices = {"image", "relative", "log_cos"},
       .standard = "image",
       .excludes = {"book"}},
      {.name = "search", .takes = FitValue::flag,
       .help = "Searches factors, projections, warps and sizes first, for up to a minute.",
       .example = "",
       .standard = "false",
       .needs = "budget"},
      {.name = "model", .takes = FitValue::text,
       .help = "Fits this product of tables over projections: pqp (the paper's), pqpr, or one of your own.",
       .example = "p(wo) q(h) s(wi+wo+0.5n) p(wi)",
       .left_out = "the best of a budget",
       .excludes = {"book"}},
      {.name = "tables", .takes = FitValue::texts,
       .help = "Sets a table as NAME=SIZE[,warp...][,shared][,format], with a size N, NxN (hemisphere), NxM or NxMxK "
               "and a warp identity, power:P or rational:K.",
       .example = "q=96",
       .left_out = "sizes that serve",
       .excludes = {"book"},
       .word = "--table"},
      {.name = "smooth", .takes = FitValue::smoothness,
       .help = "Weights the smoothness of tables by this number; auto finds it by cross-validation, for volumes by "
               "prediction of measured nodes.",
       .example = "1e-6",
       .least = 0,
       .left_out = "a weight chosen for the tables; auto for scattered samples",
       .excludes = {"book"}},
      {.name = "target", .takes = FitValue::choice,
       .help = "Fits the source's function, which interpolates measured values, or nodes, the measured values alone.",
       .example = "nodes",
       .choices = {"function", "nodes"},
       .left_out = "nodes for isotropic RGL files and for scattered samples (anisotropic: at least 1,000); function "
                   "for other sources, and with one lobe, a smoothness of auto, no symmetry, a method or a book",
       .excludes = {"book"}},
      {.name = "hold_out", .takes = FitValue::node_part,
       .help = "Fits nodes and leaves these out: half of a checkerboard, or the incidence theta_i=K, counted from 0.",
       .example = "half=1",
       .left_out = "none",
       .excludes = {"book"}},
      {.name = "floor", .takes = FitValue::number,
       .help = "Adds this to every value before its logarithm is taken, in 1/sr.",
       .example = "1e-4",
       .least = 0, .most = 1, .above_least = true,
       .standard = "3e-05",
       .excludes = {"book"}},
      {.name = "reweightings", .takes = FitValue::whole,
       .help = "Makes this many passes towards the mean absolute error.",
       .example = "4",
       .least = 0, .most = 100,
       .left_out = "4 for scattered samples, else 0",
       .excludes = {"book"}},
      {.name = "samples", .takes = FitValue::whole,
       .help = "Draws this many pairs from a source that is a function, for one lobe, a method or a book.",
       .example = "50000",
       .least = 1, .most = kMostSamples,
       .left_out = "200000; 500000 for one lobe of an anisotropic source; 1000 for a book",
       .other_word = "--count"},
      {.name = "seed", .takes = FitValue::whole,
       .help = "Chooses the pairs that are drawn.",
       .example = "7",
       .least = 0,
       .standard = "1"},
      {.name = "format", .takes = FitValue::choice,
       .help = "Stores the tables in this format.",
       .example = "half",
       .choices = {"half", "float", "rgb9e5", "unorm8"},
       .left_out = "half; rgb9e5 with a budget and three channels, where shared tables stay half"},
      {.name = "symmetrize", .takes = FitValue::flag,
       .help = "Turned off, fits f as it is, not its reciprocal part; with a budget, isotropic models get tables of "
               "wi alone.",
       .example = "",
       .standard = "true",
       .excludes = {"book"},
       .word = "--no-symmetrize"},
      {.name = "book", .takes = FitValue::file,
       .help = "Completes a few measured pairs by what the materials of this book have in common.",
       .example = "library.burnish",
       .left_out = "none",
       .in_pages = false},
      {.name = "conserve_energy", .takes = FitValue::flag,
       .help = "Damps the model where it reflects more than it receives, and reports the loss of accuracy.",
       .example = "",
       .standard = "false"},
  };
  return table;
}
// clang-format on

bool default_of_flag(const FitOption& option) {
  return option.standard == "true";
}

const FitOption* find_option(std::string_view name) {
  const auto found = std::ranges::find(option_rows(), name, &FitOption::name);
  return found == option_rows().end() ? nullptr : &*found;
}

std::string camel_case(std::string_view name) {
  std::string text;
  for (const char c : name) {
    const bool after_line = !text.empty() && text.back() == '_';
    if (after_line) text.pop_back();
    text += after_line ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return text;
}

// The spelling of an option that was given, in a message about several options.
std::string given(const FitOption& option, FitFront front) {
  const bool turned_off =
      option.takes == FitValue::flag && default_of_flag(option) && front != FitFront::command_line;
  return spelled(option, front) + (turned_off ? "=false" : "");
}

std::string found_text(const Json& value) {
  constexpr std::size_t kLongest = 40;
  if (value.is_string()) return value.get<std::string>();
  return value.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, kLongest);
}

// Returns the kind of value that an option takes, as text after "expected".
std::string expected_value(const FitOption& option) {
  switch (option.takes) {
    case FitValue::flag:
      return "true or false";
    case FitValue::text:
      return "a text";
    case FitValue::texts:
      return "a list of texts";
    case FitValue::choice:
      return fmt::format("one of {}", fmt::join(option.choices, ", "));
    case FitValue::whole:
      return "a whole number " + range_text(option);
    case FitValue::number:
      return "a number " + range_text(option);
    case FitValue::bytes:
      return fmt::format("auto or a number of bytes {}, as 2700, 16K or 1M", range_text(option));
    case FitValue::smoothness:
      return "auto or a number " + range_text(option);
    case FitValue::node_part:
      return "half=0, half=1 or theta_i=K";
    case FitValue::file:
      return "a file";
  }
  return {};
}

Error wrong_value(const FitOption& option, FitFront front, const Json& value) {
  const std::string found = found_text(value);
  return Error(fmt::format("{}: expected {}, found '{}'{}", spelled(option, front), expected_value(option),
                           found, did_you_mean(found, option.choices)));
}

bool in_range(const FitOption& option, double value) {
  const double least = option.least.value_or(-std::numeric_limits<double>::infinity());
  return std::isfinite(value) && (option.above_least ? value > least : value >= least) &&
         value <= option.most.value_or(std::numeric_limits<double>::infinity());
}

template <class T>
std::optional<T> number_of(std::string_view text) {
  T number{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

// Reads "2700", "16K", "1.5 MB" in bytes, rounded to a whole number; K and M count as 1024s.
std::optional<std::uint64_t> bytes_of_text(std::string_view text) {
  const std::size_t digits = std::min(text.find_first_not_of("0123456789."), text.size());
  const std::optional<double> number = number_of<double>(text.substr(0, digits));
  text.remove_prefix(digits);
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  std::string unit(text);
  std::ranges::transform(unit, unit.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; });
  const double power = unit.empty() || unit == "b" ? 1
                       : unit[0] == 'k'            ? 1024
                       : unit[0] == 'm'            ? 1024 * 1024
                                                   : 0;
  const bool known =
      unit.size() <= 1 || unit.substr(1) == "b" || unit.substr(1) == "i" || unit.substr(1) == "ib";
  const double bytes = number.value_or(-1) * power;
  const bool whole = power != 1 || bytes == std::floor(bytes);
  std::optional<std::uint64_t> result;
  if (power > 0 && known && whole && bytes >= 0 && *number <= static_cast<double>(kMaxBudget))
    result = static_cast<std::uint64_t>(std::llround(bytes));
  return result;
}

// Returns the value in the form in which a request keeps it; none if the option does not take it.
std::optional<Json> kept_bytes(const FitOption& option, const Json& value) {
  if (value == kAuto) return value;
  std::optional<std::uint64_t> bytes;
  if (value.is_number_unsigned()) bytes = value.get<std::uint64_t>();
  if (value.is_string()) bytes = bytes_of_text(value.get_ref<const std::string&>());
  if (!bytes || !in_range(option, static_cast<double>(*bytes))) return {};
  return *bytes;
}

std::optional<Json> kept_number(const FitOption& option, const Json& value) {
  if (!value.is_number() || !in_range(option, value.get<double>())) return {};
  return value.get<double>();
}

bool is_node_part(const Json& value) {
  if (!value.is_string()) return false;
  try {
    parse_node_part(value.get_ref<const std::string&>());
    return true;
  } catch (const Error&) {
    return false;
  }
}

std::optional<Json> kept(const FitOption& option, const Json& value) {
  const auto if_that = [&](bool is) { return is ? std::optional(value) : std::nullopt; };
  const auto is_text = [](const Json& each) {
    return each.is_string() && !each.get_ref<const std::string&>().empty();
  };
  switch (option.takes) {
    case FitValue::flag:
      return if_that(value.is_boolean());
    case FitValue::text:
    case FitValue::file:
      return if_that(is_text(value));
    case FitValue::texts:
      return if_that(value.is_array() && std::ranges::all_of(value, is_text));
    case FitValue::choice:
      return if_that(value.is_string() &&
                     std::ranges::find(option.choices, value.get_ref<const std::string&>()) !=
                         option.choices.end());
    case FitValue::whole:
      return if_that(value.is_number_unsigned() && in_range(option, value.get<double>()));
    case FitValue::number:
      return kept_number(option, value);
    case FitValue::bytes:
      return kept_bytes(option, value);
    case FitValue::smoothness:
      return value == kAuto ? std::optional(value) : kept_number(option, value);
    case FitValue::node_part:
      return if_that(is_node_part(value));
  }
  return {};
}

// Returns true if a value means the same as leaving the option out.
bool says_nothing(const FitOption& option, const Json& value) {
  if (value.is_null()) return true;
  if (option.takes == FitValue::flag) return value == default_of_flag(option);
  return option.takes == FitValue::texts && value.is_array() && value.empty();
}

// Checks what the options need and exclude, in the table's order, and the values that do not go together.
void check_together(const Json& values, FitFront front) {
  for (const FitOption& option : option_rows()) {
    if (!values.contains(option.name)) continue;
    if (!option.needs.empty() && !values.contains(option.needs))
      throw Error(
          fmt::format("{} requires {}", given(option, front), spelled(fit_option(option.needs), front)));
    for (const FitOption& other : option_rows())
      if (values.contains(other.name) && excludes(option, other))
        throw Error(fmt::format("{} excludes {}", given(option, front), given(other, front)));
  }
  const auto wrong = [&](std::string_view name, std::string_view expected, std::string_view with) {
    return Error(fmt::format("{}: expected {} with {}, found '{}'", spelled(fit_option(name), front),
                             expected, spelled(fit_option(with), front),
                             found_text(values.at(std::string(name)))));
  };
  if (values.contains("method") && values.value("budget", Json()) == kAuto)
    throw wrong("budget", "a number of bytes", "method");
  if (values.contains("hold_out") && values.value("target", Json()) == "function")
    throw wrong("target", "nodes", "hold_out");
}

// Converts a word to JSON: a number if it can be read as one, else the text, which is refused later.
Json json_of_word(const FitOption& option, const std::string& text) {
  if (option.takes == FitValue::flag) return !default_of_flag(option);
  if (option.takes != FitValue::whole && option.takes != FitValue::number &&
      option.takes != FitValue::smoothness)
    return text;
  if (const auto number = number_of<std::uint64_t>(text)) return *number;
  if (const auto number = number_of<std::int64_t>(text)) return *number;
  if (const auto number = number_of<double>(text); number && std::isfinite(*number)) return *number;
  return text;
}

FitLoss loss_of(const Json& values) {
  return parse_fit_loss(values.value("loss", std::string(fit_option("loss").standard)));
}

LogLinear log_linear_of(const Json& values) {
  LogLinear how;
  how.cross_validate = values.value("smooth", Json()) == kAuto;
  if (values.contains("reweightings")) how.reweightings = values["reweightings"].get<int>();
  if (values.contains("floor")) how.floor = values["floor"].get<double>();
  return how;
}

FitForm form_asked_for(const FitRequest& request, bool isotropic) {
  const Json& values = request.values;
  std::optional<std::uint64_t> bytes;  // none for auto, too
  if (values.contains("budget") && values["budget"].is_number())
    bytes = values["budget"].get<std::uint64_t>();
  if (values.contains("book")) return FromBook{request.book};
  if (values.contains("method"))
    return BaselineMethod{.method = values["method"].get<std::string>(), .bytes = bytes};
  if (!values.contains("budget"))
    return form_of(values.value("model", std::string()), values.value("tables", std::vector<std::string>()),
                   isotropic, log_linear_of(values), loss_of(values));
  Budget budget{.bytes = bytes, .loss = loss_of(values), .scattered = log_linear_of(values)};
  if (values.contains("fetches")) budget.fetches = values["fetches"].get<int>();
  if (values.contains("lobes")) budget.lobes = values["lobes"].get<int>();
  budget.search = values.contains("search");
  return budget;
}

std::string_view name_of(FitValue takes) {
  constexpr std::array<std::string_view, 10> kNames{"flag",         "text",   "texts", "choice",
                                                    "whole number", "number", "bytes", "number or auto",
                                                    "node part",    "file"};
  return kNames[static_cast<std::size_t>(takes)];
}

}  // namespace

std::span<const FitOption> fit_option_table() {
  return option_rows();
}

const FitOption& fit_option(std::string_view name) {
  return *find_option(name);
}

bool excludes(const FitOption& one, const FitOption& other) {
  const auto has = [](const std::vector<std::string_view>& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
  };
  return has(one.excludes, other.name) || has(other.excludes, one.name);
}

std::string spelled(const FitOption& option, FitFront front) {
  if (front == FitFront::python) return std::string(option.name);
  if (front == FitFront::page) return camel_case(option.name);
  if (!option.word.empty()) return std::string(option.word);
  std::string word = fmt::format("--{}", option.name);
  std::replace(word.begin(), word.end(), '_', '-');
  return word;
}

FitRequest request_of_words(std::span<const std::pair<std::string, std::string>> words, FitFront front) {
  Json object = Json::object();
  for (const auto& [name, text] : words) {
    const FitOption* option = find_option(name);
    if (!option) {
      object[name] = text;
      continue;
    }
    Json& value = object[spelled(*option, front)];
    if (option->takes == FitValue::texts)
      value.push_back(text);
    else
      value = json_of_word(*option, text);
  }
  return request_of_json(object, front);
}

FitRequest request_of_json(const Json& object, FitFront front) {
  if (!object.is_object()) throw Error(fmt::format("fit: expected options, found {}", found_text(object)));
  std::vector<std::string> names;
  for (const FitOption& option : option_rows())
    if (front != FitFront::page || option.in_pages) names.push_back(spelled(option, front));
  for (const auto& item : object.items())
    if (std::ranges::find(names, item.key()) == names.end())
      throw Error("fit: " +
                  expected_one_of(std::vector<std::string_view>(names.begin(), names.end()), item.key()));

  FitRequest request{.values = Json::object()};
  for (const FitOption& option : option_rows()) {
    const auto found = object.find(spelled(option, front));
    if (found == object.end() || says_nothing(option, *found)) continue;
    std::optional<Json> value = kept(option, *found);
    if (!value) throw wrong_value(option, front, *found);
    request.values[std::string(option.name)] = std::move(*value);
  }
  check_together(request.values, front);
  return request;
}

FitOptions fit_options(const FitRequest& request, bool isotropic) {
  const Json& values = request.values;
  FitOptions options{.form = form_asked_for(request, isotropic)};
  const auto text = [&](const char* name) { return values.at(name).get_ref<const std::string&>(); };
  if (values.contains("target")) options.target = parse_fit_target(text("target"));
  if (values.contains("hold_out")) options.hold_out = parse_node_part(text("hold_out"));
  if (values.contains("format")) options.format = parse_table_format(text("format"));
  if (values.contains("smooth") && values["smooth"].is_number())
    options.smooth = values["smooth"].get<double>();
  if (values.contains("samples")) options.samples = values["samples"].get<std::size_t>();
  options.seed = values.value("seed", options.seed);
  options.symmetrize = values.value("symmetrize", options.symmetrize);
  options.conserve_energy = values.value("conserve_energy", options.conserve_energy);
  return options;
}

std::string range_text(const FitOption& option) {
  const auto number = [](double value) { return fmt::format("{:.0f}", value); };
  if (!option.least) return {};
  if (!option.most)
    return fmt::format("{} {}", option.above_least ? "above" : "of at least", number(*option.least));
  if (option.above_least)
    return fmt::format("above {} and at most {}", number(*option.least), number(*option.most));
  return fmt::format("from {} to {}", number(*option.least), number(*option.most));
}

Json fit_options_json() {
  Json list = Json::array();
  for (const FitOption& option : option_rows()) {
    Json excluded = Json::array();
    for (const FitOption& other : option_rows())
      if (excludes(option, other)) excluded.push_back(other.name);
    list.push_back({{"name", option.name},
                    {"command_line", spelled(option, FitFront::command_line)},
                    {"python", spelled(option, FitFront::python)},
                    {"package", option.in_pages ? Json(spelled(option, FitFront::page)) : Json()},
                    {"takes", name_of(option.takes)},
                    {"choices", option.choices},
                    {"range", option.least ? Json(range_text(option)) : Json()},
                    {"default", option.standard.empty() ? Json() : Json(option.standard)},
                    {"left_out", option.left_out.empty() ? Json() : Json(option.left_out)},
                    {"needs", option.needs.empty() ? Json() : Json(option.needs)},
                    {"excludes", excluded},
                    {"help", option.help},
                    {"example", option.example}});
  }
  return list;
}

}  // namespace burnish
