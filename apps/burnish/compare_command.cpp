// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <list>
#include <memory>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include <burnish/math/angles.h>
#include <burnish/report/compare_report.h>

#include "commands.h"
#include "comparison.h"
#include "progress.h"
#include "source_arguments.h"
#include "usage.h"

namespace burnish::cli {

namespace {

struct CompareArguments {
  SourceArguments reference;
  std::vector<std::string> models;
  std::string folder, target, repeat, only;
  FigureOptions figures;
  bool no_symmetrize = false, json = false;
};

// Prints a line for the reference and one for each model: albedos, averaged over the channels.
void print_albedos(std::span<const ComparedFigures> figures) {
  const auto row = [&](const std::string& name, const ComparedFigures& c, const auto& number) {
    fmt::print("{:<32}", name);
    for (const ComparedAlbedo& at : c.albedos) fmt::print(" {:>8}", number(at));
    fmt::print("\n");
  };
  const auto mean = [](const DirectionalAlbedo& a) {
    return fmt::format("{:.4f}", std::accumulate(a.albedo.begin(), a.albedo.end(), 0.0) /
                                     static_cast<double>(a.albedo.size()));
  };
  row("albedo at theta_i[,phi_i]", figures.front(), [](const ComparedAlbedo& at) {
    return fmt::format("{:.0f}{}", degrees(at.theta_i),
                       at.phi_i > 0 ? fmt::format(",{:.0f}", degrees(at.phi_i)) : "");
  });
  row("  reference", figures.front(), [&](const ComparedAlbedo& at) { return mean(at.reference); });
  for (const ComparedFigures& c : figures)
    row("  " + c.name, c, [&](const ComparedAlbedo& at) { return mean(at.model); });
}

// Prints the scores of a second measurement of the same surface, or their estimate.
void print_quality(const MeasurementQuality& quality) {
  const ErrorFigures& f = quality.figures;
  fmt::print("{:<32} {:>8} {:>8.2f} {:>8.2f} {:>7.4f} {:>9.4f} {:>8.4f} {:>8.4f}\n",
             quality.repeated ? "the measurement, repeated" : "the measurement, estimated", "-", f.psnr,
             psnr_of_disc(f.psnr), f.ssim, f.relative, f.rms_log, f.log_cos);
}

void add_quality(Measurement& measurement, const Candidate& reference, const Scorer& scorer,
                 const CompareArguments& arguments) {
  if (arguments.repeat.empty()) {
    if (reference.source().findings.transmits()) return;  // light would come from the other side
    measurement.quality = quality_by_exchange(scorer, reference.source().ref(), measurement.nodes);
    return;
  }
  const Source repeat = open_source(arguments.repeat, arguments.reference.options);
  const Candidate second(repeat, !arguments.no_symmetrize);
  measurement.quality = quality_by_repeat(scorer, second.ref(), measurement.nodes);
}

// Computes the figures at the nodes alone.
std::vector<ComparedFigures> at_nodes(const Measurement& measurement, std::span<const ComparedModel> models) {
  std::vector<ComparedFigures> figures;
  for (const ComparedModel& model : models)
    figures.push_back({.name = model.name,
                       .bytes = model.bytes,
                       .note = {},
                       .figures = {},
                       .albedos = {},
                       .nodes = node_figures(measurement.nodes, model.brdf)});
  return figures;
}

// Prints the figures at the nodes. Each model must have them.
void print_nodes(const Measurement& measurement, std::span<const ComparedFigures> models) {
  fmt::print("{:<32} {:>8} {:>9} {:>8} {:>8} {:>9}\n", "at the measured nodes", "bytes", "relative",
             "rms_log", "log_cos", "rms 1/sr");
  const auto row = [](const std::string& name, std::optional<std::uint64_t> bytes, const NodeFigures& f) {
    fmt::print("{:<32} {:>8} {:>9.4f} {:>8.4f} {:>8.4f} {:>9.4g}\n", name,
               bytes ? fmt::format("{}", *bytes) : "-", f.relative, f.rms_log, f.log_cos, f.rms);
  };
  row("the reference itself", {}, measurement.itself);
  for (const ComparedFigures& model : models) row(model.name, model.bytes, model.nodes.value());
  fmt::print("{} nodes with both cosines above 0.15\n", measurement.itself.count);
}

// Prints the expected errors between samples: those of the models, and those of the function between the samples.
void print_expected(const Measurement& measurement, std::span<const ComparedFigures> models) {
  if (!measurement.expected) return;
  fmt::print("{:<32} {:>9}", "expected, measured or not", "relative");
  for (std::size_t band = 0; band < measurement.expected->by_theta_i.size(); ++band)
    fmt::print(" {:>7.0f}+", ExpectedError::begin_degrees(band));
  fmt::print("  degrees of theta_i\n");
  const auto row = [](const std::string& name, const ExpectedError& expected) {
    fmt::print("{:<32} {:>9.4f}", name, expected.relative);
    for (const auto& relative : expected.by_theta_i)
      fmt::print(" {:>8}", relative ? fmt::format("{:.4f}", *relative) : "-");
    fmt::print("\n");
  };
  row("the function between the samples", *measurement.expected);
  for (const ComparedFigures& model : models)
    if (model.expected) row(model.name, *model.expected);
}

void print_compared(std::span<const ComparedFigures> figures, const Measurement* measured,
                    bool asked_quality) {
  fmt::print("{:<32} {:>8} {:>8} {:>8} {:>7} {:>9} {:>8} {:>8}\n", "model", "bytes", "psnr dB", "disc dB",
             "ssim", "relative", "rms_log", "log_cos");
  for (const ComparedFigures& f : figures)
    fmt::print("{:<32} {:>8} {:>8.2f} {:>8.2f} {:>7.4f} {:>9.4f} {:>8.4f} {:>8.4f}\n", f.name,
               f.bytes ? fmt::format("{}", *f.bytes) : "-", f.figures.psnr, psnr_of_disc(f.figures.psnr),
               f.figures.ssim, f.figures.relative, f.figures.rms_log, f.figures.log_cos);
  if (measured && measured->quality)
    print_quality(*measured->quality);
  else if (measured && asked_quality)
    fmt::print("{:<32} {}\n", "the measurement itself", kCannotBeTold);
  print_albedos(figures);
  const ErrorFigures& first = figures.front().figures;
  if (first.unknown_fraction > 0 || first.unknown_pixels > 0)
    fmt::print(
        "left out: {:.1f} % of the direction pairs and {} pixels, where the reference or a model has no "
        "value\n",
        100 * first.unknown_fraction, first.unknown_pixels);
}

// Throws Error where one is reflection and the other transmission. Formulas are compared with both.
void check_same_kind(const Source& reference, const Source& model) {
  const auto kind = [](const Source& source) {
    return source.findings.transmits() ? "transmission" : "reflection";
  };
  if (!std::holds_alternative<AnalyticBrdf>(model.brdf) &&
      model.findings.transmits() != reference.findings.transmits())
    throw Error::in_file(model.name, fmt::format("{} as in {}", kind(reference), reference.name),
                         kind(model));
}

void compare(const CompareArguments& arguments) {
  if (!arguments.folder.empty()) {
    check_folder_name(arguments.folder);
    check_folder(arguments.folder);
  }
  const Source opened = arguments.reference.open();
  const Candidate reference(opened, !arguments.no_symmetrize);
  // The containers are lists, since models refer to their candidates and candidates to their sources.
  std::list<Source> sources;
  std::list<Candidate> candidates;
  std::vector<ComparedModel> models;
  for (const std::string& spec : arguments.models) {
    sources.push_back(open_source(spec, arguments.reference.options));
    check_same_kind(opened, sources.back());
    models.push_back(candidates.emplace_back(sources.back(), !arguments.no_symmetrize).compared(spec));
  }

  std::optional<Measurement> measurement =
      measurement_of(reference, arguments.target == "nodes", arguments.only);
  if (arguments.target == "nodes" && arguments.folder.empty()) {
    // Figures at the nodes need no picture.
    if (arguments.json)
      fmt::print("{}\n", nodes_json(*measurement, models));
    else
      print_nodes(*measurement, at_nodes(*measurement, models));
    return;
  }
  const Scorer scorer(reference.ref(), arguments.figures);
  const bool asked_quality = !arguments.folder.empty() || !arguments.repeat.empty();
  if (measurement && asked_quality) add_quality(*measurement, reference, scorer, arguments);
  const Measurement* const measured = measurement ? &*measurement : nullptr;
  std::optional<Progress> progress(std::in_place, "comparing");
  const std::vector<ComparedFigures> figures =
      arguments.folder.empty()
          ? compare_models(scorer, models, measured)
          : write_report(arguments.folder, reference.source().name, scorer, models, measured);
  progress.reset();
  if (arguments.json) {
    fmt::print("{}\n", to_json(figures, measured));
    return;
  }

  print_compared(figures, measured, asked_quality);
  if (measured && arguments.target != "function") print_nodes(*measured, figures);
  if (measured) print_expected(*measured, figures);
  if (!arguments.folder.empty()) fmt::print("report: {}/index.html\n", arguments.folder);
}

}  // namespace

void add_compare_command(CLI::App& app) {
  CLI::App* verb =
      app.add_subcommand("compare", "Measure models against a reference: error figures and pictures");
  verb->footer("Example: burnish compare paint.binary paint.exr other.exr -o report");
  auto arguments = std::make_shared<CompareArguments>();
  add_source_arguments(*verb, arguments->reference);
  verb->add_option("MODELS", arguments->models, "Names the BRDFs to compare with it.")->required();
  verb->add_option("-o,--output,--out", arguments->folder,
                   "Writes a report with pictures into this folder: index.html and its parts.");
  verb->add_option("--count", arguments->figures.count, "Compares at this many direction pairs.")
      ->check(in_range(1, 100'000'000))
      ->capture_default_str();
  verb->add_option("--seed", arguments->figures.seed, "Chooses the direction pairs.")
      ->check(at_least_zero())
      ->capture_default_str();
  verb->add_option("--target", arguments->target,
                   "Scores the function between the nodes too, or the measured nodes alone (default: the "
                   "function; for measurements both).")
      ->check(one_of({"function", "nodes"}));
  verb->add_option(
      "--only", arguments->only,
      "Scores these nodes alone: half=0, half=1 (of a checkerboard) or theta_i=K, counted from 0.");
  verb->add_option("--repeat", arguments->repeat,
                   "Also scores a second measurement of the same surface, whose error is the one to reach.");
  verb->add_flag("--no-symmetrize", arguments->no_symmetrize,
                 "Compares f(wi, wo) as it is, not its mean with f(wo, wi).");
  verb->add_flag("--json", arguments->json, "Prints the figures as JSON.");
  verb->callback([arguments] { compare(*arguments); });
}

}  // namespace burnish::cli
