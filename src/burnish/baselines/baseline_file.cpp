// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <burnish/baselines/baseline_file.h>
#include <burnish/error.h>
#include <burnish/json_integer.h>

namespace burnish {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxFile = std::size_t{64} << 20;
constexpr std::array<std::string_view, 3> kSeparableKinds = {"svd", "nd", "nmf"};

bool is_separable(std::string_view kind) {
  return std::find(kSeparableKinds.begin(), kSeparableKinds.end(), kind) != kSeparableKinds.end();
}

// Written: a name, axes and float values, which JSON keeps to the last bit.
Json to_json(const NodeTable& table, const char* name) {
  Json axes = Json::array();
  for (const NodeAxis& axis : table.axes)
    axes.push_back({{"coordinate", to_string(axis.coordinate)}, {"count", axis.count}});
  return {{"name", name},
          {"axes", std::move(axes)},
          {"channels", table.channels},
          {"terms", table.terms},
          {"values", table.values}};
}

// The parts of a file that differ between kinds of baselines.
struct Parts {
  Json parameters, tables = Json::array();
};

Parts parts_of(const SeparableBrdf& brdf) {
  return {{{"scale", std::vector<float>(brdf.scale().begin(), brdf.scale().end())}},
          {to_json(brdf.u(), "u"), to_json(brdf.v(), "v")}};
}

Parts parts_of(const DgfBrdf& brdf) {
  return {{{"diffuse", std::vector<float>(brdf.diffuse().begin(), brdf.diffuse().end())},
           {"scale", std::vector<float>(brdf.scale().begin(), brdf.scale().end())}},
          {to_json(brdf.d(), "d"), to_json(brdf.g(), "g"), to_json(brdf.f(), "f")}};
}

Parts parts_of(const AnalyticBrdf& brdf) {
  Json parameters{{"model", brdf.model().name}};
  for (std::size_t i = 0; i < brdf.values().size(); ++i) {
    const Rgb value = brdf.values()[i];
    const AnalyticParameter& parameter = brdf.model().parameters[i];
    parameters[std::string(parameter.name)] =
        parameter.color ? Json{value.r, value.g, value.b} : Json(value.r);
  }
  return {std::move(parameters), Json::array()};
}

// Said in one line: "u(theta_h 32, phi_d 8) shared".
std::string expression(const NodeTable& table, const char* name) {
  std::vector<std::string> axes;
  for (const NodeAxis& axis : table.axes)
    axes.push_back(fmt::format("{} {}", to_string(axis.coordinate), axis.count));
  return fmt::format("{}({}){}", name, fmt::join(axes, ", "), table.channels == 1 ? " shared" : "");
}

std::string expression_of(const SeparableBrdf& brdf) {
  return fmt::format("{} {}, {} terms", expression(brdf.u(), "u"), expression(brdf.v(), "v"), brdf.u().terms);
}

std::string expression_of(const DgfBrdf& brdf) {
  return fmt::format("diffuse + {} {} {}", expression(brdf.d(), "d"), expression(brdf.g(), "g"),
                     expression(brdf.f(), "f"));
}

std::string expression_of(const AnalyticBrdf& brdf) {
  return format_analytic(brdf);
}

// Read: tables stand in the order of their names; constructors check sizes and values.
NodeTable read_table(const Json& tables, std::size_t index, std::string_view name) {
  const Json& json = tables.at(index);
  if (const auto found = json.at("name").get<std::string>(); found != name)
    throw Error(fmt::format("table {}: expected the name '{}', found '{}'", index + 1, name, found));
  NodeTable table{.axes = {},
                  .channels = static_cast<std::size_t>(integer_at(json, "channels")),
                  .terms = integer_at(json, "terms"),
                  .values = json.at("values").get<std::vector<float>>()};
  for (const Json& axis : json.at("axes")) {
    const auto text = axis.at("coordinate").get<std::string>();
    const auto coordinate = parse_pair_coordinate(text);
    if (!coordinate) throw Error(fmt::format("table '{}': expected a coordinate, found '{}'", name, text));
    table.axes.push_back({*coordinate, integer_at(axis, "count")});
  }
  return table;
}

std::vector<float> read_floats(const Json& json, const char* key) {
  return json.at(key).get<std::vector<float>>();
}

// The model's parameters by name: three numbers for a colour, one for any other.
AnalyticBrdf read_analytic(const Json& parameters) {
  const auto name = parameters.at("model").get<std::string>();
  if (!is_analytic_spec(name) || name.find(':') != std::string::npos)
    throw Error(fmt::format("model: expected the name of an analytic model, found '{}'", name));
  const AnalyticBrdf defaults = parse_analytic(name);
  const AnalyticModel& model = defaults.model();
  std::vector<Rgb> values;
  for (const AnalyticParameter& parameter : model.parameters) {
    const Json& value = parameters.at(std::string(parameter.name));
    if (parameter.color) {
      const auto rgb = value.get<std::array<double, 3>>();
      values.emplace_back(rgb[0], rgb[1], rgb[2]);
    } else {
      values.emplace_back(value.get<double>());
    }
  }
  return AnalyticBrdf(model, std::move(values));
}

BaselineBrdf read_brdf(const std::string& kind, const Json& parameters, const Json& tables) {
  const auto expect_tables = [&](std::size_t count) {
    if (!tables.is_array() || tables.size() != count)
      throw Error(fmt::format("tables: expected {}, found {}", count, tables.size()));
  };
  if (is_separable(kind)) {
    expect_tables(2);
    return SeparableBrdf(read_table(tables, 0, "u"), read_table(tables, 1, "v"),
                         read_floats(parameters, "scale"));
  }
  if (kind == "dgf") {
    expect_tables(3);
    return DgfBrdf(read_floats(parameters, "diffuse"), read_floats(parameters, "scale"),
                   read_table(tables, 0, "d"), read_table(tables, 1, "g"), read_table(tables, 2, "f"));
  }
  if (kind == "analytic") {
    expect_tables(0);
    return read_analytic(parameters);
  }
  throw Error(fmt::format("kind: expected svd, nd, nmf, dgf or analytic, found '{}'", kind));
}

}  // namespace

BrdfRef baseline_ref(const BaselineBrdf& brdf) noexcept {
  if (const auto* analytic = std::get_if<AnalyticBrdf>(&brdf)) return analytic->ref();
  return std::visit([](const auto& any) -> BrdfRef { return any; }, brdf);
}

std::size_t baseline_bytes(const BaselineBrdf& brdf) noexcept {
  return std::visit([](const auto& any) { return any.bytes(); }, brdf);
}

std::string baseline_expression(const BaselineBrdf& brdf) {
  return std::visit([](const auto& any) { return expression_of(any); }, brdf);
}

std::string format_baseline(const Baseline& baseline) {
  Parts parts = std::visit([](const auto& brdf) { return parts_of(brdf); }, baseline.brdf);
  const Json json{{"kind", baseline.kind},
                  {"parameters", std::move(parts.parameters)},
                  {"tables", std::move(parts.tables)},
                  {"notes", Json::parse(baseline.notes)}};
  return json.dump() + "\n";
}

bool looks_like_baseline(std::string_view text) noexcept {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{';
}

Baseline parse_baseline(const FileBytes& file) {
  if (file.bytes.size() > kMaxFile)
    throw Error::in_file(file.name, fmt::format("a baseline of at most {} bytes", kMaxFile),
                         fmt::format("{}", file.bytes.size()));
  // whatever goes wrong inside, the message names the file
  try {
    const Json json = Json::parse(file.text());
    if (json.contains("asset") && json.contains("materials"))
      throw Error(
          "expected a measurement, baseline or model, found a material of glTF, "
          "which only programs that read glTF take");
    if (json.contains("metadata") && !json.contains("kind"))
      throw Error(
          "expected a measurement, baseline or model, found an OpenMATERIAL file without the lookupTable of "
          "a BRDF");
    if (!json.contains("kind"))
      throw Error("expected the JSON of a baseline, with its 'kind', found another one");
    Baseline baseline{
        .kind = json.at("kind").get<std::string>(),
        .brdf = read_brdf(json.at("kind").get<std::string>(), json.at("parameters"), json.at("tables")),
        .notes = json.at("notes").dump()};
    if (!json.at("notes").is_object()) throw Error("notes: expected an object, found another value");
    return baseline;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file.name, error.what()));
  } catch (const Json::parse_error& error) {  // whose message repeats what it read
    throw Error(
        fmt::format("{}: expected a baseline in JSON, found: an error at byte {}", file.name, error.byte));
  } catch (const std::exception& error) {  // the JSON library's own, which begins with its name in brackets
    std::string_view why = error.what();
    if (const std::size_t end = why.find("] "); end != why.npos) why.remove_prefix(end + 2);
    throw Error(fmt::format("{}: expected a baseline in JSON, found: {:.120}", file.name, why));
  }
}

}  // namespace burnish
