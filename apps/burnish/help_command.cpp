// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <burnish/fitting/numerics/linear_algebra.h>
#include <burnish/io/formats.h>
#include <burnish/math/build_info.h>
#include <burnish/reflectance/analytic.h>

#include "command_description.h"
#include "commands.h"
#include "json_output.h"
#include "usage.h"

namespace burnish::cli {

namespace {

nlohmann::ordered_json formats_json() {
  auto list = nlohmann::ordered_json::array();
  for (const Format& f : formats())
    list.push_back({{"name", f.title},
                    {"to", f.to},
                    {"extension", f.endings},
                    {"read", f.is_read()},
                    {"written", f.is_written()},
                    {"holds", f.holds}});
  return list;
}

void print_formats() {
  fmt::print(
      "Files are recognized by their content. `burnish convert IN OUT --to NAME` writes the formats with a "
      "name below --to.\n"
      "\n");
  fmt::print("{:23} {:13} {:24} {:6} {}\n", "format", "--to", "usual ending", "", "holds");
  for (const Format& f : formats())
    fmt::print("{:23} {:13} {:24} {:6} {}\n", f.title, f.to, f.endings,
               f.is_read() && f.is_written() ? "both" : (f.is_read() ? "read" : "write"), f.holds);
}

nlohmann::ordered_json models_json() {
  auto list = nlohmann::ordered_json::array();
  for (const AnalyticModel& model : analytic_models()) {
    auto parameters = nlohmann::ordered_json::array();
    for (const AnalyticParameter& p : model.parameters)
      parameters.push_back({{"name", p.name},
                            {"min", p.min},
                            {"max", p.max},
                            {"default", p.default_value},
                            {"color", p.color},
                            {"description", p.description}});
    list.push_back(
        {{"name", model.name}, {"description", model.description}, {"parameters", std::move(parameters)}});
  }
  return list;
}

void print_models() {
  fmt::print(
      "An analytic BRDF is MODEL or MODEL:NAME=VALUE,NAME=VALUE; other parameters have their defaults. "
      "Colours may\n"
      "be three numbers, RED/GREEN/BLUE: openpbr:base_color=0.5/0.1/0.05,coat_weight=1\n");
  for (const AnalyticModel& model : analytic_models()) {
    fmt::print("\n{}: {}\n", model.name, model.description);
    for (const AnalyticParameter& p : model.parameters)
      fmt::print("  {:31} {:>5g} to {:<6g} default {:<6g} {}{}\n", p.name, p.min, p.max, p.default_value,
                 p.description, p.color ? " (colour)" : "");
  }
}

/// Returns the verb of these names, each name below the one before. An unknown name is a misuse.
const CLI::App& verb_of_names(const CLI::App& app, const std::vector<std::string>& names) {
  const CLI::App* verb = &app;
  if (names.size() > 1 && (names.front() == "formats" || names.front() == "models"))
    throw CLI::ValidationError("help",
                               fmt::format("expected nothing after {}, found '{}'", names.front(), names[1]));
  for (const std::string& name : names) {
    std::vector<std::string> known;
    for (const CLI::App* each : verb->get_subcommands([](const CLI::App*) { return true; }))
      if (!each->get_name().empty()) known.push_back(each->get_name());  // without a name: a group of options
    if (known.empty())
      throw CLI::ValidationError("help",
                                 fmt::format("expected nothing after {}, which has no verbs below it, "
                                             "found '{}'",
                                             verb->get_name(), name));
    if (std::ranges::find(known, name) == known.end()) {
      std::string expected = fmt::format("one of {}", fmt::join(known, ", "));
      if (verb == &app) {
        expected = "formats, models or a verb";
        known.insert(known.end(), {"formats", "models"});
      }
      throw CLI::ValidationError(
          "help", fmt::format("expected {}, found '{}'{}", expected, name, suggestion(name, known)));
    }
    verb = verb->get_subcommand(name);
  }
  return *verb;
}

}  // namespace

std::string version_text(bool as_json) {
  const BuildInfo info = build_info();
  auto libraries = nlohmann::ordered_json{{"CLI11", CLI11_VERSION}};
  for (const auto& [name, version] : info.libraries) libraries[name] = version;
  if (as_json)
    return nlohmann::ordered_json{{"burnish", BURNISH_VERSION},
                                  {"instruction_sets", info.instruction_sets},
                                  {"threads", info.threads},
                                  {"compiled_with", libraries},
                                  {"linear_algebra", linear_algebra()}}
        .dump(2);
  std::string compiled;
  for (const auto& [name, version] : libraries.items())
    compiled += fmt::format("{}{} {}", compiled.empty() ? "" : ", ", name, version.get<std::string>());
  return fmt::format(
      "burnish {}\ninstruction sets  {}\nthreads           {}\ncompiled with     {}\nlinear algebra    {}",
      BURNISH_VERSION, fmt::join(info.instruction_sets, ", "), info.threads, compiled, linear_algebra());
}

void add_help_command(CLI::App& app) {
  struct Arguments {
    std::vector<std::string> topic;
    bool json = false;
  };
  CLI::App* verb =
      app.add_subcommand("help", "Say what formats and analytic models there are, or how a verb is used");
  verb->footer(
      "Examples: burnish help formats\n          burnish help models\n          burnish help specular code\n"
      "          burnish help fit --json");
  auto arguments = std::make_shared<Arguments>();
  verb->add_option("TOPIC", arguments->topic,
                   "Explains formats, models, or a verb and verbs below it; without it all verbs.");
  verb->add_flag("--json", arguments->json,
                 "Prints the same as JSON, of a verb its options, defaults and examples.");
  verb->callback([arguments, &app] {
    if (arguments->topic == std::vector<std::string>{"formats"})
      return arguments->json ? print_as_json(formats_json()) : print_formats();
    if (arguments->topic == std::vector<std::string>{"models"})
      return arguments->json ? print_as_json(models_json()) : print_models();
    const CLI::App& topic = verb_of_names(app, arguments->topic);
    if (arguments->json) return print_as_json(description_json(topic));
    // app.help() does not serve: where a verb was chosen, as here, it prints the help of that verb.
    std::string path = "burnish";
    for (const std::string& name : arguments->topic) path += " " + name;
    fmt::print("{}", topic.get_formatter()->make_help(&topic, path, CLI::AppFormatMode::Normal));
  });
}

}  // namespace burnish::cli
