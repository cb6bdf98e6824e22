// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/io/csv.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/kriged_nodes.h>
#include <burnish/reflectance/node_figures.h>

#include "commands.h"
#include "json_output.h"
#include "progress.h"
#include "source_arguments.h"
#include "usage.h"

namespace burnish::cli {

namespace {

std::vector<std::string> value_names(std::size_t channels, const std::vector<double>& lambda_nm) {
  if (lambda_nm.empty())
    return channels == 1 ? std::vector<std::string>{"value"} : std::vector<std::string>{"r", "g", "b"};
  std::vector<std::string> names;
  for (const double l : lambda_nm) names.push_back(fmt::format("value_{}", l));
  return names;
}

/// The function that predicts the error of a measurement's values: that of scattered samples, or one made here.
struct Uncertain {
  const KrigedNodes* function = nullptr;
  std::unique_ptr<const KrigedNodes> own;

  explicit operator bool() const noexcept { return function != nullptr; }
};

Uncertain uncertain_of(const Source& source) {
  const auto* scattered = std::get_if<ScatteredBrdf>(&source.brdf);
  if (const KrigedNodes* function = scattered ? scattered->kriged() : nullptr) return {function, nullptr};
  const MeasuredNodes nodes = measured_nodes(source);
  try {
    Uncertain made{nullptr, std::make_unique<const KrigedNodes>(nodes, choose_covariance(nodes))};
    made.function = made.own.get();
    return made;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", source.name, error.what()));
  }
}

/// Reads the file of directions, or the standard input where its name is "-".
FileBytes read_directions(const std::string& name) {
  if (name != "-") return read_file(name);
  constexpr std::size_t kMost = std::size_t{1} << 30;
  FileBytes file{.name = "standard input", .bytes = {}};
  std::array<std::byte, 1 << 16> part;
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), stdin)) {
    file.bytes.insert(file.bytes.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(count));
    if (file.bytes.size() > kMost)
      throw Error::in_file(file.name, fmt::format("at most {} bytes", kMost), "more");
  }
  if (file.bytes.empty()) throw Error(file.name, 0, "data", "nothing");
  return file;
}

/// Values at pairs. `known` is 0 where the BRDF has no value.
struct Values {
  std::size_t channels = 0;
  std::vector<double> f;            // [pair][channel]
  std::vector<std::uint8_t> known;  // [pair]
  std::vector<double> errors;       // [pair], or nothing
};

/// Returns the pairs in the source's convention. Transmission leaves below the surface: users write its wo with z < 0.
/// The source expects wo mirrored through the surface, with z > 0. A user's wo above the surface therefore gets z < 0.
std::vector<DirectionPair> as_evaluated(const Source& source, std::vector<DirectionPair> pairs) {
  if (source.findings.transmits())
    for (DirectionPair& pair : pairs) pair.wo.z = -pair.wo.z;
  return pairs;
}

Values values_at(const Source& source, std::span<const DirectionPair> pairs, bool with_errors) {
  const Progress progress("evaluating");
  const Uncertain uncertain = with_errors ? uncertain_of(source) : Uncertain{};
  const BrdfRef brdf = source.ref();
  const std::size_t channels = brdf.channels();
  Values values{.channels = channels,
                .f = std::vector<double>(pairs.size() * channels),
                .known = std::vector<std::uint8_t>(pairs.size()),
                .errors = {}};
  for_each_chunk(pairs.size(), 4096, [&](std::size_t, std::size_t begin, std::size_t end) {
    brdf.eval(pairs.subspan(begin, end - begin),
              std::span(values.f).subspan(begin * channels, (end - begin) * channels),
              std::span(values.known).subspan(begin, end - begin));
  });
  if (uncertain)
    for (const DirectionPair& pair : pairs)
      values.errors.push_back(uncertain.function->uncertainty(pair.wi, pair.wo).function);
  return values;
}

/// Names the columns of the output. `directions` are those that stand beside the values.
std::vector<std::string> columns_of(const Source& source, const DirectionTable& directions,
                                    bool with_errors) {
  std::vector<std::string> names = directions.names;
  const auto values = value_names(source.ref().channels(), source.findings.lambda_nm);
  names.insert(names.end(), values.begin(), values.end());
  if (with_errors) names.push_back("error");
  return names;
}

/// Quotes a name where CSV needs it.
std::string as_cell(const std::string& name) {
  if (name.find_first_of(",\"") == std::string::npos) return name;
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string csv_of(const std::vector<std::string>& columns, const DirectionTable& directions,
                   const Values& values) {
  std::string text;
  for (const std::string& name : columns) text += (text.empty() ? "" : ",") + as_cell(name);
  text += '\n';
  const std::size_t width = directions.names.size();
  for (std::size_t i = 0; i < values.known.size(); ++i) {
    for (std::size_t k = 0; k < width; ++k) text += fmt::format("{},", directions.numbers[i * width + k]);
    for (std::size_t c = 0; c < values.channels; ++c)
      text += (c ? "," : "") +
              (values.known[i] ? fmt::format("{}", values.f[i * values.channels + c]) : std::string("nan"));
    if (!values.errors.empty()) text += fmt::format(",{:.4g}", values.errors[i]);
    text += '\n';
  }
  return text;
}

nlohmann::ordered_json rows_of(const DirectionTable& directions, const Values& values) {
  auto rows = nlohmann::ordered_json::array();
  const std::size_t width = directions.names.size();
  for (std::size_t i = 0; i < values.known.size(); ++i) {
    auto row = nlohmann::ordered_json::array();
    for (std::size_t k = 0; k < width; ++k) row.push_back(directions.numbers[i * width + k]);
    for (std::size_t c = 0; c < values.channels; ++c)
      row.push_back(values.known[i] ? nlohmann::ordered_json(values.f[i * values.channels + c]) : nullptr);
    if (!values.errors.empty()) row.push_back(values.errors[i]);
    rows.push_back(std::move(row));
  }
  return rows;
}

struct EvalArguments {
  SourceArguments source;
  std::string directions, out;
  bool json = false, error = false, with_directions = false;
};

void evaluate(const EvalArguments& arguments) {
  if (!arguments.out.empty()) {
    check_ending(arguments.out, {".csv", ".txt"});
    check_writable(arguments.out);
  }
  const Source source = arguments.source.open();
  DirectionTable directions = parse_directions(read_directions(arguments.directions));
  const Values values = values_at(source, as_evaluated(source, directions.pairs), arguments.error);
  const std::size_t pairs = directions.pairs.size();
  if (!arguments.out.empty() && !arguments.with_directions) directions = {};
  const std::vector<std::string> columns = columns_of(source, directions, arguments.error);
  if (!arguments.out.empty()) write_then_rename(arguments.out, csv_of(columns, directions, values));
  if (!arguments.json) {
    if (arguments.out.empty()) fmt::print("{}", csv_of(columns, directions, values));
    return;
  }
  nlohmann::ordered_json json{{"output", arguments.out},
                              {"pairs", pairs},
                              {"known", std::count(values.known.begin(), values.known.end(), 1)},
                              {"channels", values.channels}};
  if (arguments.out.empty()) {
    json["output"] = nullptr;
    json["columns"] = columns;
    json["rows"] = rows_of(directions, values);
  }
  print_as_json(json);
}

}  // namespace

void add_eval_command(CLI::App& app) {
  CLI::App* verb =
      app.add_subcommand("eval", "Evaluate a BRDF at direction pairs: f_r in 1/sr, without the cosine");
  verb->footer(
      "The header of DIRECTIONS is wi_x,wi_y,wi_z,wo_x,wo_y,wo_z or theta_i,phi_i,theta_o,phi_o (degrees). "
      "wo of a transmission lies below the surface: wo_z < 0, theta_o from 90 to 180. The terminal shows "
      "directions beside the values, a file only with --with-directions. The value is nan where a "
      "measurement has none.\n"
      "Examples: burnish eval paint.exr directions.csv -o values.csv --with-directions\n"
      "          printf 'theta_i,theta_o\\\n"
      "30,-30\\\n"
      "' | burnish eval paint.exr -");
  auto arguments = std::make_shared<EvalArguments>();
  add_source_arguments(*verb, arguments->source);
  verb->add_option("DIRECTIONS", arguments->directions,
                   "Names a CSV file of direction pairs, or - for the standard input.")
      ->required();
  verb->add_option("-o,--output,--out", arguments->out,
                   "Writes the values to this CSV file, not to the terminal.");
  verb->add_flag("--with-directions", arguments->with_directions,
                 "Writes the directions beside the values into the file too.");
  verb->add_flag("--error", arguments->error,
                 "Adds a column that says how far a measurement's value may be off: the standard deviation "
                 "of ln(f + 0.001).");
  verb->add_flag("--json", arguments->json,
                 "Prints how many values there are as JSON, and without -o the values too.");
  verb->callback([arguments] { evaluate(*arguments); });
}

}  // namespace burnish::cli
