// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/hardware/generate.h>
#include <burnish/library/folder_file.h>

#include "commands.h"
#include "json_output.h"
#include "usage.h"

namespace burnish::cli {
namespace {

struct UnitArguments {
  std::string method = "exact", input = "cosine", shipped;
  UnitConfig config;
};

std::shared_ptr<UnitArguments> add_unit_options(CLI::App& sub) {
  auto arguments = std::make_shared<UnitArguments>();
  std::string methods, units;
  for (const UnitInfo& info : unit_methods())
    methods +=
        fmt::format("{}{} ({}-{})", methods.empty() ? "" : ", ", info.name, info.min_depth, info.max_depth);
  for (const ShippedUnit& unit : shipped_units())
    units += (units.empty() ? "" : ", ") + std::string(unit.name);
  sub.add_option("--method", arguments->method,
                 "Computes the power by this method (with its clocks): " + methods + ".")
      ->capture_default_str();
  sub.add_option("--cos-bits", arguments->config.cosine_bits, "Gives the input this many fraction bits.")
      ->capture_default_str();
  sub.add_option("--coef-bits", arguments->config.coefficient_bits,
                 "Gives coefficients this many bits; 0 takes the method's own.");
  sub.add_option("--out-bits", arguments->config.output_bits, "Gives the output this many bits.")
      ->capture_default_str();
  sub.add_option("--depth", arguments->config.depth,
                 "Takes this many clocks from input to output; 0 takes the fewest.");
  sub.add_option("--input", arguments->input, "Takes a cosine c, or a versine v = 1 - c.")
      ->check(one_of({"cosine", "versine"}))
      ->capture_default_str();
  sub.add_option("--unit", arguments->shipped, "Takes a unit of hw/ instead of options: " + units + ".");
  return arguments;
}

SpecularUnit make_unit(const UnitArguments& arguments) {
  return usage([&] {
    if (!arguments.shipped.empty()) return SpecularUnit(shipped_unit(arguments.shipped).config);
    UnitConfig config = arguments.config;
    config.method = unit_method(arguments.method);
    config.input = arguments.input == "versine" ? UnitInput::versine : UnitInput::cosine;
    return SpecularUnit(config);
  });
}

std::vector<GeneratedFile> generate(const std::vector<SpecularUnit>& units,
                                    const std::vector<std::string>& names, int vectors, bool blinn,
                                    bool axis) {
  if (axis) return generate_axis(units[0], names[0], vectors);
  if (blinn) return generate_blinn(units[0], names[0], vectors);
  std::vector<GeneratedFile> files;
  for (std::size_t i = 0; i < units.size(); ++i)
    for (GeneratedFile& file : generate_unit(units[i], names[i], vectors)) files.push_back(std::move(file));
  files.push_back(generate_bench(names, units));
  return files;
}

void add_generate(CLI::App& verb) {
  CLI::App* sub =
      verb.add_subcommand("generate", "Write module, table images, test bench and golden vectors");
  sub->footer(
      "Example: burnish hw generate --method exact --out-bits 10 --depth 8 --name highlight -o highlight\n"
      "         cd highlight && iverilog -g2012 -f highlight.f highlight_tb.sv && ./a.out");
  struct Arguments {
    std::string name, out;
    int vectors = 2000;
    bool all = false, blinn = false, axis = false, json = false;
  };
  auto unit_arguments = add_unit_options(*sub);
  auto arguments = std::make_shared<Arguments>();
  sub->add_option("--name", arguments->name, "Names the module (default: as the unit or method is named).");
  sub->add_option("--vectors", arguments->vectors, "Writes this many golden vectors.")
      ->check(in_range(1, 1'000'000))
      ->capture_default_str();
  sub->add_flag("--all", arguments->all,
                "Writes every configuration of hw/, and a module `bench` around them.");
  sub->add_flag("--blinn", arguments->blinn,
                "Adds Blinn's front end, which takes vectors, to --method exact --input versine.");
  CLI::Option* blinn = sub->get_option("--blinn");
  CLI::Option* all = sub->get_option("--all");
  sub->add_flag("--axis", arguments->axis,
                "Puts --method exact between two AXI4-Streams, and writes an IP-XACT description.")
      ->excludes(blinn)
      ->excludes(all);
  sub->add_option("-o,--output,--out", arguments->out,
                  "Names the folder to write to, which is made where it is missing.")
      ->required();
  sub->add_flag("--json", arguments->json, "Prints the files as JSON.");
  sub->callback([unit_arguments, arguments] {
    std::vector<std::string> names, written;
    std::vector<SpecularUnit> units;
    if (arguments->all) {
      for (const ShippedUnit& unit : shipped_units()) {
        names.emplace_back(unit.name);
        units.emplace_back(unit.config);
      }
    } else {
      const std::string kind =
          unit_arguments->shipped.empty() ? unit_arguments->method : unit_arguments->shipped;
      names.push_back(arguments->name.empty() ? kind : arguments->name);
      units.push_back(make_unit(*unit_arguments));
    }
    const auto files =
        usage([&] { return generate(units, names, arguments->vectors, arguments->blinn, arguments->axis); });
    make_folder(arguments->out);
    for (const GeneratedFile& file : files) {
      write_then_rename(std::filesystem::path(arguments->out) / file.name, file.text);
      written.push_back(file.name);
    }
    if (arguments->json) print_as_json({{"output", arguments->out}, {"modules", names}, {"files", written}});
  });
}

void add_model(CLI::App& verb) {
  CLI::App* sub =
      verb.add_subcommand("model", "Answer `exponent input` lines as the hardware does, to the bit");
  sub->footer("Example: printf '50 32700\\n50 32768\\n' | burnish hw model --method exact");
  auto unit_arguments = add_unit_options(*sub);
  auto real = std::make_shared<bool>(false), json = std::make_shared<bool>(false);
  sub->add_flag("--real", *real,
                "Takes cosines in [0, 1], rounded to the input's format, and answers values in [0, 1].");
  sub->add_flag("--json", *json, "Prints questions and answers as JSON.");
  sub->callback([unit_arguments, real, json] {
    auto answers = nlohmann::ordered_json::array();
    const SpecularUnit unit = make_unit(*unit_arguments);
    const double one = static_cast<double>(1U << unit.config().cosine_bits);
    const double full = (1 << unit.config().output_bits) - 1;
    std::string line;
    for (std::uint64_t number = 1; std::getline(std::cin, line); ++number) {
      std::istringstream words(line);
      int exponent = 0;
      double input = -1;
      const bool read = static_cast<bool>(words >> exponent >> input) && (words >> std::ws).eof();
      const bool whole = *real || input == static_cast<double>(static_cast<std::int64_t>(input));
      if (!read || exponent < 1 || exponent > kUnitMaxExponent ||
          !(input >= 0 && input <= (*real ? 1 : one)) || !whole)
        throw Error::in_line(
            "standard input", number,
            fmt::format("an exponent from 1 to {} and {}", kUnitMaxExponent,
                        *real ? "a cosine in [0, 1]" : fmt::format("an input word from 0 to {}", one)),
            "'" + line + "'");
      const std::uint32_t word = *real ? unit.input(input) : static_cast<std::uint32_t>(input);
      const std::uint32_t value = unit.value(static_cast<std::uint32_t>(exponent), word);
      if (*json) {
        nlohmann::ordered_json answer{{"exponent", exponent}, {"input", input}, {"value", value}};
        if (*real) answer["value"] = value / full;
        answers.push_back(answer);
      } else if (*real) {
        fmt::print("{:.6f}\n", value / full);
      } else {
        fmt::print("{}\n", value);
      }
    }
    if (*json) print_as_json(answers);
  });
}

struct ErrorArguments {
  int first = 1, last = 1000, exponent_step = 1;
  std::uint32_t input_step = 1;
  bool json = false, rounded_input = false;
};

void print_rounded_input_error(const SpecularUnit& unit, const ErrorArguments& arguments) {
  const double error = measure_rounded_input_error(unit, arguments.last);
  if (arguments.json)
    fmt::print("{}\n", nlohmann::json{{"max_error_lsb", error}}.dump(2));
  else
    fmt::print("at most {:.4f} of the last place of {} bits at exponent {}\n", error,
               unit.config().output_bits, arguments.last);
}

void print_error(const SpecularUnit& unit, const ErrorArguments& arguments) {
  if (arguments.last < arguments.first)
    throw CLI::ValidationError(fmt::format("--last: expected an exponent of at least --first, {}, found {}",
                                           arguments.first, arguments.last));
  const UnitError e = measure_unit_error(unit, arguments.first, arguments.last, arguments.input_step,
                                         arguments.exponent_step);
  if (arguments.json) {
    nlohmann::json tables = nlohmann::json::array();
    for (const UnitTable& t : unit.tables())
      tables.push_back({{"name", t.name}, {"words", t.words.size()}, {"width", t.width}});
    fmt::print("{}\n", nlohmann::json{{"vectors", e.vectors},
                                      {"max_error_lsb", e.max_error},
                                      {"worst_exponent", e.worst_exponent},
                                      {"worst_input", e.worst_input},
                                      {"correctly_rounded", e.correct},
                                      {"falls", e.falls},
                                      {"tables", tables}}
                           .dump(2));
    return;
  }
  fmt::print(
      "{} vectors: at most {:.4f} of the last place of {} bits (exponent {}, input {}), {:.3f} % correctly "
      "rounded, {} falls\n",
      e.vectors, e.max_error, unit.config().output_bits, e.worst_exponent, e.worst_input, 100 * e.correct,
      e.falls);
}

void add_error(CLI::App& verb) {
  CLI::App* sub = verb.add_subcommand(
      "error", "Measure the largest error against cos^exponent over every exponent and input");
  sub->footer("Example: burnish hw error --method exact --out-bits 10");
  auto unit_arguments = add_unit_options(*sub);
  auto arguments = std::make_shared<ErrorArguments>();
  sub->add_option("--first", arguments->first, "Begins at this exponent.")
      ->check(in_range(1, kUnitMaxExponent))
      ->capture_default_str();
  sub->add_option("--last", arguments->last, "Ends at this exponent.")
      ->check(in_range(1, kUnitMaxExponent))
      ->capture_default_str();
  sub->add_option("--exponent-step", arguments->exponent_step, "Steps through the exponents by this number.")
      ->check(in_range(1, 1000))
      ->capture_default_str();
  sub->add_option("--input-step", arguments->input_step, "Steps through the inputs by this number.")
      ->check(in_range(1, 1 << 20))
      ->capture_default_str();
  sub->add_flag("--json", arguments->json, "Prints the same as JSON.");
  sub->add_flag("--rounded-input", arguments->rounded_input,
                "Measures at --last alone, of 2^20 cosines in the highlight, rounded to the input's format.");
  sub->callback([unit_arguments, arguments] {
    const SpecularUnit unit = make_unit(*unit_arguments);
    if (arguments->rounded_input)
      print_rounded_input_error(unit, *arguments);
    else
      print_error(unit, *arguments);
  });
}

}  // namespace

void add_hw_command(CLI::App& app) {
  CLI::App* verb =
      app.add_subcommand("hw", "The specular unit in hardware: SystemVerilog and its bit-exact model");
  verb->require_subcommand(1);
  verb->footer("Example: burnish hw generate --method exact -o unit");
  add_generate(*verb);
  add_model(*verb);
  add_error(*verb);
}

}  // namespace burnish::cli
