// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/export/export_specular.h>
#include <burnish/export/html_page.h>
#include <burnish/export/manifest.h>
#include <burnish/export/sampler_files.h>
#include <burnish/power/choose.h>
#include <burnish/shaders/specular_shader.h>

namespace burnish {

namespace {

using nlohmann::json;

constexpr double kMaxPowerError = 1.0 / 255;

SpecularModel specular_of(const AnalyticBrdf& brdf, std::optional<PowerMethod> power) {
  std::optional<SpecularModel> model = specular_model(brdf, PowerMethod::exact);
  if (!model)
    throw Error(
        fmt::format("export: expected a factored BRDF (see burnish fit), a surface, openpbr, or phong, "
                    "blinn_phong or their normalized forms, found {}",
                    brdf.model().name));
  model->method =
      power ? *power : choose_power(kMaxPowerError, model->exponent, model->exponent).front().method;
  return *model;
}

}  // namespace

ExportedFiles export_specular(const std::string& spec, std::optional<PowerMethod> power,
                              const ExportOptions& options) {
  const AnalyticBrdf brdf = parse_analytic(spec);
  const SpecularModel model = specular_of(brdf, power);
  const PowerInfo& method = power_info(model.method);
  json manifest{{"generator", "burnish"},
                {"name", options.name},
                {"model", format_analytic(brdf)},
                {"channels", 3},
                {"power",
                 {{"method", method.name},
                  {"formula", method.formula},
                  {"bound", power_bound(model.method, model.exponent)}}}};
  ExportedFiles result;
  for (const ExportTarget target : options.to) {
    if (target == ExportTarget::html) {
      manifest["page"] =
          result.files
              .emplace_back(ExportedFile{options.name + ".html", html_page(model, spec, options.name)})
              .name;
      continue;
    }
    const std::optional<ShaderLanguage> language = language_of(target);
    if (!language)
      throw Error(fmt::format("export: expected a shader language or html for {}, found {}", spec,
                              to_string(target)));
    const Shader shader = generate_shader(model, *language, options.name);
    const std::string file = shader_file(*language, options.name);
    result.files.push_back({file, shader.text});
    result.shaders.push_back({file, std::string(method.name), shader.cost});
    manifest["shaders"].push_back(manifest_entry(*language, options.name, shader));
  }
  if (options.sample) add_sampler(brdf.ref(), options, result, manifest);
  result.files.push_back(manifest_file(manifest, options.name));
  return result;
}

}  // namespace burnish
