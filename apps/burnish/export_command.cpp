#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/export/export_model.h>
#include <burnish/export/export_specular.h>
#include <burnish/factors/model_file.h>
#include <burnish/file.h>
#include <burnish/reflectance/analytic.h>

#include "commands.h"
#include "environment_argument.h"
#include "usage.h"

namespace burnish::cli {

namespace {

struct ExportArguments {
  std::string model, folder, name, power, environment;
  std::vector<std::string> to;
  bool exact = false, plain = false, mips = false, json = false;
};

ExportOptions options_of(const ExportArguments& arguments) {
  ExportOptions options{.to = {},
                        .name = arguments.name,
                        .exact = arguments.exact,
                        .mips = arguments.mips,
                        .compressed = !arguments.plain};
  for (const std::string& to : arguments.to) options.to.push_back(export_target(to));
  return options;
}

ExportedFiles exported_specular(const ExportArguments& arguments) {
  if (!arguments.environment.empty())
    throw CLI::ValidationError("--environment: expected a factored BRDF with it, found " + arguments.model);
  ExportOptions options = options_of(arguments);
  if (options.name.empty()) options.name = parse_analytic(arguments.model).model().name;
  std::optional<PowerMethod> power;
  if (!arguments.power.empty()) power = usage([&] { return power_method(arguments.power); });
  return export_specular(arguments.model, power, options);
}

ExportedFiles exported_model(const ExportArguments& arguments) {
  if (!arguments.power.empty())
    throw CLI::ValidationError("--power: expected phong or blinn_phong with it, found a file");
  ExportOptions options = options_of(arguments);
  if (!arguments.environment.empty() && std::ranges::none_of(options.to, shows_environment))
    throw CLI::ValidationError("--environment: expected --to glsl, glsl_es or html with it, found others");
  if (options.name.empty())
    options.name = export_name(std::filesystem::path(arguments.model).stem().string());
  const FactoredBrdf brdf = parse_model(read_file(arguments.model)).brdf;
  options.environment = environment_of(arguments.environment);
  return export_model(brdf, options);
}

void run(const ExportArguments& arguments) {
  const ExportedFiles exported =
      is_analytic_spec(arguments.model) ? exported_specular(arguments) : exported_model(arguments);
  write_files(arguments.folder, exported.files);
  if (arguments.json) {
    auto files = nlohmann::ordered_json::array();
    for (const ExportedFile& file : exported.files) files.push_back(file.name);
    auto shaders = nlohmann::ordered_json::array();
    for (const auto& [file, how, cost] : exported.shaders)
      shaders.push_back({{"file", file}, {"how", how}, {"cost", to_string(cost)}});
    fmt::print(
        "{}\n",
        nlohmann::ordered_json{{"output", arguments.folder}, {"files", files}, {"shaders", shaders}}.dump(
            2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return;
  }
  for (const ExportedFile& file : exported.files) fmt::print("{}\n", file.name);
  for (const auto& [file, how, cost] : exported.shaders)
    fmt::print("{}: {}, {}\n", file, how, to_string(cost));
}

}  // namespace

void add_export_command(CLI::App& app) {
  CLI::App* verb =
      app.add_subcommand("export",
                         "Write a factored BRDF as shaders, textures, glTF, a three.js module, "
                         "an RGL table, or a page that shows it; or Phong's and Blinn's models as shaders");
  verb->footer(
      "Every shader comes with its textures but C++, which has them inside; NAME.json says what is in the "
      "folder and what an evaluation costs. See docs/guide/shaders.md.\n"
      "Examples: burnish export paint.exr --to glsl --to html -o paint\n"
      "          burnish export paint.exr --to glsl_es --to html --environment studio -o paint\n"
      "          burnish export blinn_phong:exponent=60,ks=0.8 --to wgsl --power cubic2 -o highlight");
  auto arguments = std::make_shared<ExportArguments>();
  verb->add_option("MODEL", arguments->model,
                   "factored BRDF, as `burnish fit` writes it, or one such as blinn_phong:exponent=60")
      ->required();
  const auto names = export_target_names();
  verb->add_option("--to", arguments->to, "what to write; may be given several times")
      ->required()
      ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())));
  verb->add_option("-o,--output,--out", arguments->folder, "folder, made where it is missing")->required();
  verb->add_option("--name", arguments->name, "of functions and files; by default from MODEL's name");
  verb->add_option(
      "--power", arguments->power,
      "of phong and blinn_phong: how the power is computed, see `burnish specular list`; by default the "
      "cheapest that is never one of 255 levels off");
  add_environment_argument(*verb, arguments->environment);
  verb->add_flag("--exact", arguments->exact, "shaders that weigh texels themselves, in floats");
  verb->add_flag("--mips", arguments->mips, "KTX2 with levels: averages over the directions of a texel");
  verb->add_flag("--plain", arguments->plain, "textures that are not compressed");
  verb->add_flag("--json", arguments->json, "print the files and what shaders cost as JSON");
  verb->callback([arguments] { run(*arguments); });
}

}  // namespace burnish::cli
