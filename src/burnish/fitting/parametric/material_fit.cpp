// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <chrono>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <burnish/baselines/baseline_file.h>
#include <burnish/error.h>
#include <burnish/fitting/fit.h>
#include <burnish/fitting/fit_report_json.h>
#include <burnish/fitting/parametric/gltf_fit.h>
#include <burnish/fitting/parametric/gltf_json.h>
#include <burnish/fitting/parametric/grain.h>
#include <burnish/fitting/parametric/material_fit.h>
#include <burnish/fitting/parametric/openpbr_fit.h>
#include <burnish/math/closest_name.h>
#include <burnish/metrics/figures_json.h>

namespace burnish {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 2> kTargets = {"openpbr", "gltf"};

void fit_material_of(BrdfRef source, const Scorer& scorer, const MaterialFitOptions& options,
                     MaterialFit& fit) {
  const PicturePairs pairs = picture_pairs(source, scorer.exposure());
  const bool grey = pairs.grey(), anisotropic = !source.isotropic();
  const double tangent = grain_direction(source);
  std::function<void(double)> progress;
  if (options.progress)
    progress = [&](double fraction) { options.progress("fitting " + fit.target, fraction); };
  const auto take = [&](const auto& found) {
    fit.summary = found.summary;
    fit.starts = found.starts;
  };
  if (fit.target == "gltf") {
    const GltfFit found =
        fit_gltf(pairs, {.grey = grey, .anisotropic = anisotropic, .tangent = tangent, .progress = progress});
    fit.material = found.material;
    take(found);
  } else {
    OpenPbrFitOptions how{.grey = grey,
                          .anisotropic = anisotropic,
                          .simple = options.simple,
                          .tangent = tangent,
                          .progress = progress};
    const OpenPbrFit found = fit_openpbr(pairs, how);
    fit.material = OpenPbr(found.parameters);
    take(found);
    if (!options.simple || !options.beside) return;
    how.simple = false;
    how.progress = {};
    fit.layered = scorer.score(OpenPbr(fit_openpbr(pairs, how).parameters));
  }
}

Json json_of_rgb(Rgb color) {
  return {color.r, color.g, color.b};
}

/// Inputs by name, colours as three numbers.
Json json_of(const OpenPbrParameters& p) {
  Json json = Json::object();
  for (const OpenPbrInput& input : kOpenPbrInputs) {
    if (const auto* number = std::get_if<double OpenPbrParameters::*>(&input.member))
      json[std::string(input.name)] = p.*(*number);
    else
      json[std::string(input.name)] = json_of_rgb(p.*std::get<Rgb OpenPbrParameters::*>(input.member));
  }
  return json;
}

/// Returns the report of a fit.
Json report_of(const MaterialFit& fit) {
  Json json{{"target", fit.target}, {"source", fit.source}};
  json.update(json_of(fit.figures));
  if (fit.layered) json["layered"] = json_of(*fit.layered);
  const auto or_null = [](std::optional<double> figure) { return figure ? Json(*figure) : Json(); };
  json["beyond"] = {{"backscatter", or_null(fit.beyond.backscatter)},
                    {"rings", or_null(fit.beyond.rings)},
                    {"colour_shift", or_null(fit.beyond.colour_shift)},
                    {"grain", or_null(fit.beyond.grain)}};
  if (fit.factored) {
    json["factored"] = json_of(fit.factored->figures);
    json["factored"]["bytes"] = fit.factored->bytes;
  }
  if (const auto* openpbr = std::get_if<OpenPbr>(&fit.material))
    json["spec"] = format_analytic(analytic_openpbr(openpbr->parameters()));
  json["starts"] = fit.starts;
  json["iterations"] = fit.summary.iterations;
  return json;
}

}  // namespace

BrdfRef MaterialFit::ref() const noexcept {
  return std::visit([](const auto& any) -> BrdfRef { return any; }, material);
}

std::span<const std::string_view> material_targets() {
  return kTargets;
}

MaterialFit fit_material(const Source& source, std::string_view target, const MaterialFitOptions& options) {
  if (std::ranges::find(kTargets, target) == kTargets.end())
    throw Error(fmt::format("material: expected {}, found '{}'{}", fmt::join(kTargets, " or "), target,
                            did_you_mean(target, kTargets)));
  if (options.simple && target != "openpbr")
    throw Error(fmt::format("material: expected openpbr with simple, found {}", target));
  if (source.ref().channels() != 1 && source.ref().channels() != 3)
    throw Error(fmt::format("{}: expected 1 or 3 channels for {}, found {}", source.name, target,
                            source.ref().channels()));
  if (source.findings.transmits())
    throw Error::in_file(source.name, fmt::format("a reflection for {}", target),
                         to_string(*source.findings.block));
  const SymmetrizedBrdf symmetrized(source.ref());
  const BrdfRef brdf = is_measurement(source) ? BrdfRef(symmetrized) : source.ref();
  const Scorer scorer(brdf, options.figures);
  MaterialFit fit{.target = std::string(target), .source = source.name};
  const auto start = std::chrono::steady_clock::now();
  fit_material_of(brdf, scorer, options, fit);
  fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  fit.figures = scorer.score(fit.ref());
  fit.beyond = unexplained(brdf, fit.ref());
  if (options.beside) {
    const Fit factored =
        burnish::fit(source, {.target = FitTarget::function, .score = false, .progress = options.progress});
    fit.factored = {.bytes = factored.bytes(), .figures = scorer.score(factored.ref())};
  }
  return fit;
}

std::string format_material(const MaterialFit& fit) {
  if (const auto* openpbr = std::get_if<OpenPbr>(&fit.material))
    return format_baseline({.kind = "analytic",
                            .brdf = analytic_openpbr(openpbr->parameters()),
                            .notes = to_text(report_of(fit), -1)});
  Json material = gltf_json(std::get<GltfMaterial>(fit.material));
  Json asset{{"asset", {{"version", "2.0"}, {"generator", "burnish"}}}};
  if (material.contains("extensions"))
    for (const auto& [name, extension] : material["extensions"].items())
      asset["extensionsUsed"].push_back(name);
  material["extras"] = report_of(fit);
  asset["materials"] = Json::array({material});
  return to_text(asset, 2) + "\n";
}

std::string summary_json(const MaterialFit& fit, const std::string& output) {
  Json json = report_of(fit);
  json["parameters"] = std::visit(
      [](const auto& any) {
        if constexpr (requires { any.parameters(); })
          return json_of(any.parameters());
        else
          return gltf_json(any);
      },
      fit.material);
  json["output"] = output;
  json["seconds"] = fit.seconds;
  return to_text(json, 2);
}

}  // namespace burnish
