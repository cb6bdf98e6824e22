// SPDX-License-Identifier: Apache-2.0
// Compares the OpenPBR fit with the best of many random starts, and reports glTF materials fitted to the same sources.
#include <algorithm>
#include <cstdint>
#include <ctime>
#include <limits>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <burnish/fitting/parametric/gltf_json.h>
#include <burnish/fitting/parametric/grain.h>
#include <burnish/fitting/parametric/material_fit.h>
#include <burnish/fitting/parametric/metallic_roughness_fit.h>
#include <burnish/fitting/parametric/openpbr_fit.h>
#include <burnish/io/open_source.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/brdf.h>

#include "report.h"

namespace burnish::reports {

namespace {

constexpr int kStarts = 200, kQuickStarts = 10;
constexpr std::size_t kPairs = 20'000;
constexpr std::uint64_t kPeersSeed = 2;  // fit_openpbr draws its own starts from 1

// Returns the seconds of the processor, all threads together.
double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// A fitted material, its score and times.
struct Scored {
  OpenPbrParameters parameters;
  double psnr, seconds, wall = 0;
};

/// A material of glTF, and the metallic-roughness core that a viewer without extensions shows.
struct GltfScored {
  ErrorFigures figures, core;
  double wall;
  std::string extensions;
};

struct Row {
  std::string material;
  Scored ours, random;
  GltfScored gltf;
};

const MaterialFitOptions kAlone{.beside = false, .figures = {.count = kPairs}};

// Fits as `burnish fit --to openpbr` does. Scoring is part of the processor's seconds.
Scored fitted(const Source& source) {
  const double start = processor_seconds();
  const MaterialFit fit = fit_material(source, "openpbr", kAlone);
  return {std::get<OpenPbr>(fit.material).parameters(), fit.figures.psnr, processor_seconds() - start,
          fit.seconds};
}

// Returns the best fit from random starts, with the same loss.
Scored fitted_at_random(const Scorer& scorer, const PicturePairs& pairs, int starts,
                        const OpenPbrFitOptions& options) {
  const double start = processor_seconds();
  const OpenPbrFit found = fit_openpbr_at_random(pairs, starts, kPeersSeed, options);
  return {found.parameters, scorer.picture_psnr(scorer.pictures(OpenPbr(found.parameters))),
          processor_seconds() - start};
}

// Returns the asset's extensions without their prefixes: "sheen, clearcoat".
std::string extensions_of(const GltfMaterial& material) {
  const auto json = gltf_json(material);
  std::vector<std::string> names;
  if (json.contains("extensions"))
    for (const auto& [name, inputs] : json["extensions"].items())
      names.push_back(name.substr(name.rfind('_') + 1));
  return fmt::format("{}", fmt::join(names, ", "));
}

// Fits as `burnish fit --to gltf` does.
GltfScored gltf_fitted(const Source& source, const Scorer& scorer) {
  const MaterialFit fit = fit_material(source, "gltf", kAlone);
  const MetallicRoughness core = fit_metallic_roughness(scorer.reference()).material;
  return {fit.figures, scorer.score(core), fit.seconds, extensions_of(std::get<GltfMaterial>(fit.material))};
}

Row row_of(const std::string& material, const std::string& place, int starts) {
  tell(fmt::format("openpbr: {}", material));
  const Source source = open_source(place, {});
  // A fit sees what fit_material fits: a measurement's reciprocal part.
  const SymmetrizedBrdf symmetrized(source.ref());
  const BrdfRef brdf = is_measurement(source) ? BrdfRef(symmetrized) : source.ref();
  const Scorer scorer(brdf, {.count = kPairs});
  const OpenPbrFitOptions options{
      .grey = brdf.channels() == 1, .anisotropic = !brdf.isotropic(), .tangent = grain_direction(brdf)};
  const Row row{.material = material,
                .ours = fitted(source),
                .random = fitted_at_random(scorer, picture_pairs(brdf, scorer.exposure()), starts, options),
                .gltf = gltf_fitted(source, scorer)};
  tell(fmt::format("openpbr: {}: {:.2f} dB in {:.1f} s, at random {:.2f} dB in {:.0f} s, glTF {:.2f} dB",
                   material, row.ours.psnr, row.ours.seconds, row.random.psnr, row.random.seconds,
                   row.gltf.figures.psnr));
  return row;
}

void show(Page& page, const std::string& group, const std::vector<Row>& rows) {
  Table shown(
      {"material", "fit, dB", "at random, dB", "behind, dB", "fit, s", "by the clock, s", "at random, s"});
  Table full({"material", "psnr", "psnr_at_random", "behind", "seconds", "seconds_by_the_clock",
              "seconds_at_random", "spec", "spec_at_random"});
  double worst = -std::numeric_limits<double>::infinity(), slowest = 0, slowest_by_the_clock = 0;
  for (const auto& [material, ours, random, gltf] : rows) {
    const double behind = random.psnr - ours.psnr;
    shown.add({material, fmt::format("{:.2f}", ours.psnr), fmt::format("{:.2f}", random.psnr),
               fmt::format("{:.2f}", behind), fmt::format("{:.1f}", ours.seconds),
               fmt::format("{:.1f}", ours.wall), fmt::format("{:.0f}", random.seconds)});
    full.add({material, fmt::format("{:.4f}", ours.psnr), fmt::format("{:.4f}", random.psnr),
              fmt::format("{:.4f}", behind), fmt::format("{:.2f}", ours.seconds),
              fmt::format("{:.2f}", ours.wall), fmt::format("{:.2f}", random.seconds),
              format_analytic(analytic_openpbr(ours.parameters)),
              format_analytic(analytic_openpbr(random.parameters))});
    worst = std::max(worst, behind);
    slowest = std::max(slowest, ours.seconds);
    slowest_by_the_clock = std::max(slowest_by_the_clock, ours.wall);
  }
  page[group] = shown.markdown();
  page[group + "_worst"] = fmt::format("{:.2f}", worst);
  page[group + "_slowest"] = fmt::format("{:.1f}", slowest);
  page[group + "_slowest_wall"] = fmt::format("{:.1f}", slowest_by_the_clock);
  page.write_rows(group, full);
}

void show_gltf(Page& page, const std::string& group, const std::vector<Row>& rows) {
  Table shown({"material", "OpenPBR, dB", "glTF, dB", "core, dB", "glTF, relative", "core, relative",
               "by the clock, s", "extensions"});
  double lost = 0, gained = 0, slowest = 0;
  for (const Row& row : rows) {
    const auto& [figures, core, wall, extensions] = row.gltf;
    shown.add({row.material, fmt::format("{:.2f}", row.ours.psnr), fmt::format("{:.2f}", figures.psnr),
               fmt::format("{:.2f}", core.psnr), fmt::format("{:.3f}", figures.relative),
               fmt::format("{:.3f}", core.relative), fmt::format("{:.1f}", wall), extensions});
    lost += (row.ours.psnr - figures.psnr) / static_cast<double>(rows.size());
    gained += (figures.psnr - core.psnr) / static_cast<double>(rows.size());
    slowest = std::max(slowest, wall);
  }
  page[group + "_gltf"] = shown.markdown();
  page[group + "_gltf_lost"] = fmt::format("{:.1f}", lost);
  page[group + "_gltf_gained"] = fmt::format("{:.1f}", gained);
  page[group + "_gltf_slowest"] = fmt::format("{:.1f}", slowest);
  page.write_rows("gltf-" + group, shown);
}

}  // namespace

void report_openpbr(const ReportOptions& options) {
  Page page(options, "openpbr");
  const int starts = options.quick ? kQuickStarts : kStarts;
  page["starts"] = std::to_string(starts);
  if (options.data && options.wants("rgl")) {
    std::vector<fs::path> files = files_in(*options.data / "rgl");
    if (options.quick) files.resize(1);
    std::vector<Row> rows;
    for (const fs::path& file : files) rows.push_back(row_of(file.stem().string(), file.string(), starts));
    show(page, "rgl", rows);
    show_gltf(page, "rgl", rows);
  }
  if (options.data && options.wants("merl")) {
    std::vector<std::string> names = row_names(*options.data / "np/codes.csv");
    std::erase_if(names,
                  [](const std::string& name) { return name.ends_with("_rgb"); });  // are of the RGL database
    const std::size_t every = options.quick ? 50 : 5;
    std::vector<Row> rows;
    for (std::size_t i = 0; i < names.size(); i += every)
      rows.push_back(
          row_of(names[i], fmt::format("np:{}#{}", (*options.data / "np").string(), names[i]), starts));
    show(page, "merl", rows);
    show_gltf(page, "merl", rows);
  }
  page.write();
}

}  // namespace burnish::reports
