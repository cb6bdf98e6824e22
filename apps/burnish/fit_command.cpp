// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>

#include <fmt/format.h>

#include <burnish/baselines/evaluation_cost.h>
#include <burnish/factors/fetches.h>
#include <burnish/file.h>
#include <burnish/fitting/choosing/tournament.h>
#include <burnish/fitting/fit_file.h>
#include <burnish/fitting/parametric/material_fit.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/shaders/cost_json.h>

#include "commands.h"
#include "counted.h"
#include "fit_arguments.h"
#include "notes_text.h"
#include "progress.h"
#include "source_arguments.h"
#include "usage.h"

namespace burnish::cli {

namespace {

struct FitCommand {
  SourceArguments source;
  FitArguments how;
  std::string out, to;
  int threads = 0;
  bool json = false, alone = false, simple = false;
};

std::string figures(const ErrorFigures& e) {
  return fmt::format("psnr {:.2f}, ssim {:.4f}, relative {:.4f}, rms_log {:.4f}, log_cos {:.4f}", e.psnr,
                     e.ssim, e.relative, e.rms_log, e.log_cos);
}

std::string ending_of(const FitSummary& summary) {
  return ending_text(std::string(to_string(summary.stop_reason)));
}

void print(const OneLobeReport& report) {
  fmt::print("fitted     {} samples, {} iterations ({}), smooth {:.3g}\n", report.samples,
             report.summary.iterations, ending_of(report.summary), report.smooth);
  fmt::print("rms log f  {:.4f} before, {:.4f} after\n", report.summary.error_before,
             report.summary.error_after);
}

void print(const LobesReport& report) {
  if (const auto& trials = report.fetch_trials; !trials.empty())
    fmt::print("fetches    {} of {} to {} tried, within {:.0f} % of the least error\n",
               trial_at_knee(trials).fetches, trials.front().fetches, trials.back().fetches,
               100 * (kKneeFactor - 1));
  fmt::print("fitted     {} samples, {} lobe{}, {} steps ({}){}\n", report.samples, report.lobes,
             report.lobes == 1 ? "" : "s", report.summary.iterations, ending_of(report.summary),
             report.smooth ? fmt::format(", smooth {:.3g}", *report.smooth) : "");
  if (report.search)
    fmt::print("searched   {} changes, {} kept\n", report.search->trials, report.search->kept.size());
}

std::string text_of(const ErrorLevel& level) {
  std::string text = fmt::format("relative {:.4f}", level.relative);
  if (level.log_cos) text += fmt::format(", log_cos {:.4f}", *level.log_cos);
  if (level.rms) text += fmt::format(", rms {:.3g}", *level.rms);
  if (level.psnr) text += fmt::format(", psnr {:.2f}", *level.psnr);
  return text;
}

void print(const CompletionReport& report) {
  const auto prior = [](const CompletionPrior& p) {
    return fmt::format("{} of the book's spread, {} of its residual, noise {:.0f} %", p.spread, p.residual,
                       100 * std::sqrt(p.noise));
  };
  fmt::print("completed  {} by a book of {}{}\n", counted(report.used, "pair"),
             counted(report.materials, "material"),
             report.nearest.empty() ? "" : fmt::format(", near {}", report.nearest));
  fmt::print("prior      brightness {}; colour {}\n", prior(report.brightness), prior(report.colour));
  fmt::print("relative   {:.4f} at the pairs, {:.4f} left out in turn\n", report.relative,
             report.relative_left_out);
}

// Prints a line: the number of bytes, and the reason for it.
void print(const BudgetChoice& choice) {
  const auto last = [&] { return choice.trials.back(); };
  const std::string why = [&] {
    switch (choice.stop) {
      case BudgetStop::noise:
        return fmt::format("no worse than the measurement itself ({}; itself {})", text_of(last().error),
                           text_of(*choice.noise));
      case BudgetStop::floor:
        return fmt::format("relative {:.4f} is small enough", last().error.relative);
      case BudgetStop::gain:
        return fmt::format("{} bytes would hardly help: relative {:.4f} instead of {:.4f}", last().bytes,
                           last().error.relative, choice.trials[choice.trials.size() - 2].error.relative);
      case BudgetStop::largest:
        return std::string("the largest budget that is tried");
      case BudgetStop::cross_validation:
        return std::string("the best prediction of held-out samples");
    }
    return std::string();
  }();
  fmt::print("budget     {} bytes: {}\n", choice.bytes, why);
}

void print(const EnergyReport& report) {
  const auto finite = [](double psnr) { return std::isfinite(psnr) ? psnr : 0; };
  fmt::print(
      "energy     albedo at most {:.4f} before, {:.4f} after; psnr {:.2f} -> {:.2f} dB, relative {:.4f} -> "
      "{:.4f}\n",
      report.largest_albedo_before, report.largest_albedo_after, finite(report.before.psnr),
      finite(report.after.psnr), report.before.relative, report.after.relative);
}

void print(const NodesReport& report) {
  const auto line = [](std::string_view name, const NodeFigures& f) {
    fmt::print("{:<10} relative {:.4f}, rms_log {:.4f}, log_cos {:.4f} at {} nodes\n", name, f.relative,
               f.rms_log, f.log_cos, f.count);
  };
  fmt::print("target     the measured nodes (--target function fits the function that interpolates them)\n");
  if (report.outliers > 0)
    fmt::print("outliers   {} left out: samples around {} contradict {}\n",
               counted(report.outliers, "sample"), report.outliers == 1 ? "it" : "them",
               report.outliers == 1 ? "it" : "them");
  line("nodes", report.at_fitted);
  if (report.held_out) line("unseen", *report.held_out);
  if (report.at_held_out) line("held out", *report.at_held_out);
  if (!report.expected) return;
  fmt::print("expected   relative {:.4f}, measured or not", report.expected->relative);
  std::string bands, values;
  for (std::size_t band = 0; band < report.expected->by_theta_i.size(); ++band)
    if (const auto& relative = report.expected->by_theta_i[band]) {
      values += fmt::format("{}{:.3f}", values.empty() ? "" : " ", *relative);
      bands += fmt::format("{}{:.0f}", bands.empty() ? "" : " ", ExpectedError::begin_degrees(band));
    }
  fmt::print("; {} from theta_i = {} degrees on\n", values, bands);
}

void print_model(const FactoredBrdf& model, const FitReport& report) {
  fmt::print("model      {}, {} bytes ({} of them tables), {} fetches\n", model_expression(model),
             model.bytes(), model.table_bytes(), fetch_count(model));
  if (const auto cost = shader_cost(model)) fmt::print("shader     {}\n", to_string(*cost));
  const auto* one_lobe = std::get_if<OneLobeReport>(&report.how);
  const auto* completion = std::get_if<CompletionReport>(&report.how);
  if (one_lobe)
    print(*one_lobe);
  else if (completion)
    print(*completion);
  else
    print(std::get<LobesReport>(report.how));
  if (report.budget_choice) print(*report.budget_choice);
  if (report.nodes) print(*report.nodes);
  if (report.energy) print(*report.energy);
  if (report.held_out) {
    const ErrorFigures& e = *report.held_out;
    if (std::isfinite(e.psnr)) fmt::print("held out   psnr {:.2f} dB, ssim {:.4f}\n", e.psnr, e.ssim);
    fmt::print("held out   relative {:.4f}, rms_log {:.4f}, log_cos {:.4f}\n", e.relative, e.rms_log,
               e.log_cos);
  } else if (one_lobe) {
    fmt::print("relative   {:.4f} at the samples", one_lobe->relative.value());
    if (one_lobe->relative_cross_validated)
      fmt::print(", {:.4f} cross-validated", *one_lobe->relative_cross_validated);
    fmt::print("\n");
  }
}

void print_baseline(const BaselineBrdf& brdf, const FitReport& fit) {
  const auto& report = std::get<BaselineReport>(fit.how);
  fmt::print("model      {}, {}, {} bytes\n", report.method, baseline_expression(brdf), baseline_bytes(brdf));
  if (const auto cost = evaluation_cost(brdf))
    fmt::print("evaluation {} table reads, {} multiplies\n", cost->table_reads, cost->multiplies);
  fmt::print("held out   {}\n", figures(fit.held_out.value()));
  if (const auto& lobes = report.negative_lobes) {
    fmt::print("negative   {:.2f} % of the values before they are clamped\n", 100 * lobes->negative_share);
    fmt::print("  tables clamped instead: {}\n", figures(lobes->tables_clamped));
    fmt::print("  lifted by {:.3g} instead: {}\n", lobes->bias, figures(lobes->biased));
  }
  if (fit.nodes) print(*fit.nodes);
}

void print_figures(std::string_view name, const ErrorFigures& e, const std::string& size) {
  if (std::isfinite(e.psnr))
    fmt::print("{:<10} psnr {:.2f} dB, relative {:.4f}{}\n", name, e.psnr, e.relative, size);
  else
    fmt::print("{:<10} the same pictures, relative {:.4f}{}\n", name, e.relative, size);
}

// Prints the inputs that differ from their defaults, a line for each layer.
void print(const OpenPbr& material) {
  const OpenPbrParameters p = material.parameters(), defaults;
  for (const std::string_view layer : {"base", "specular", "coat", "fuzz", "thin_film", "geometry"}) {
    std::string text;
    for (const OpenPbrInput& input : kOpenPbrInputs) {
      if (!input.name.starts_with(layer)) continue;
      const auto value = [&](const OpenPbrParameters& of) {
        const Rgb v = std::visit([&](auto member) { return Rgb(of.*member); }, input.member);
        const std::array<std::string, 3> rgb = {fmt::format("{:.4g}", v.r), fmt::format("{:.4g}", v.g),
                                                fmt::format("{:.4g}", v.b)};
        return rgb[0] == rgb[1] && rgb[0] == rgb[2] ? rgb[0] : fmt::format("{}", fmt::join(rgb, "/"));
      };
      if (const std::string shown = value(p); shown != value(defaults))
        text += fmt::format("{}{}={}", text.empty() ? "" : ", ", input.name, shown);
    }
    if (!text.empty()) fmt::print("{:<10} {}\n", layer, text);
  }
}

void print(const GltfMaterial& m) {
  const auto color = [](Rgb c) {
    return c.r == c.g && c.g == c.b ? fmt::format("{:.4g}", c.r)
                                    : fmt::format("{:.4g}/{:.4g}/{:.4g}", c.r, c.g, c.b);
  };
  const GltfMaterial neutral;
  fmt::print("material   base colour {}, metallic {:.4g}, roughness {:.4g}\n", color(m.base_color),
             m.metallic, m.roughness);
  if (m.ior != neutral.ior) fmt::print("ior        {:.4g}\n", m.ior);
  if (m.specular != neutral.specular || m.specular_color != neutral.specular_color)
    fmt::print("specular   {:.4g}, colour {}\n", m.specular, color(m.specular_color));
  if (m.anisotropy > 0)
    fmt::print("anisotropy {:.4g}, {:.4g} degrees from the tangent\n", m.anisotropy, degrees(m.rotation));
  if (m.iridescence > 0)
    fmt::print("film       {:.4g}, index {:.4g}, {:.4g} nm\n", m.iridescence, m.iridescence_ior,
               m.iridescence_thickness);
  if (m.sheen_color != neutral.sheen_color)
    fmt::print("sheen      {}, roughness {:.4g}\n", color(m.sheen_color), m.sheen_roughness);
  if (m.clearcoat > 0)
    fmt::print("clearcoat  {:.4g}, roughness {:.4g}\n", m.clearcoat, m.clearcoat_roughness);
}

// Prints the effects that the material cannot express, a line each. Effects too small to be seen, or not known, are
// left out.
void print(const Unexplained& beyond) {
  constexpr double kSeenFactor = 1.25, kSeenShift = 0.05;
  if (const double back = beyond.backscatter.value_or(1); back > kSeenFactor || back < 1 / kSeenFactor)
    fmt::print("beyond     backscatter: {:.2f} times the material's where wi = wo\n", back);
  if (const double rings = beyond.rings.value_or(1); rings > kSeenFactor)
    fmt::print("beyond     rings: values rise again by {:.2f} times as much away from the highlight\n",
               rings);
  if (const double shift = beyond.colour_shift.value_or(0); shift > kSeenShift)
    fmt::print("beyond     colour shift: the highlight's chromaticity differs by up to {:.3f}\n", shift);
  if (const double grain = beyond.grain.value_or(1); grain > kSeenFactor || grain < 1 / kSeenFactor)
    fmt::print("beyond     grain: {:.3g} times the material's across the tangent, by what is along it\n",
               grain);
}

// Refuses an output name that ends otherwise than .json, since JSON is written. JSON of glTF may end in .gltf.
void check_name_of_json(const FitCommand& arguments) {
  const std::string ending = std::filesystem::path(arguments.out).extension().string();
  const bool gltf = arguments.to == "gltf";
  if (ending.empty() || ending == ".json" || (gltf && ending == ".gltf")) return;
  throw CLI::ValidationError(
      fmt::format("--output: expected a name such as paint.json{}, for JSON is written{}, found '{}'",
                  gltf ? " or paint.gltf" : "",
                  ending == ".glb" || ending == ".gltf" ? " (`burnish export --to gltf` writes a GLB)" : "",
                  arguments.out));
}

void fit_to_material(const FitCommand& arguments) {
  if (arguments.simple && arguments.to != "openpbr")
    throw CLI::ValidationError("--simple: expected --to openpbr with it, found --to " + arguments.to);
  for (const FitOption& of_factors : fit_option_table())
    if (arguments.how.given(std::string(of_factors.name)))
      throw CLI::ExcludesError("--to", spelled(of_factors, FitFront::command_line));
  check_name_of_json(arguments);
  if (!arguments.out.empty()) check_writable(arguments.out);
  const ThreadLimit limit(arguments.threads);
  const Source source = arguments.source.open();
  const MaterialFit fit = [&] {
    Progress progress("fitting");
    return fit_material(
        source, arguments.to,
        {.beside = !arguments.alone, .simple = arguments.simple, .progress = progress.stages()});
  }();
  if (!arguments.out.empty()) write_then_rename(arguments.out, format_material(fit));
  if (arguments.json) {
    fmt::print("{}\n", summary_json(fit, arguments.out));
    return;
  }
  fmt::print("{}: {}\n", fit.source, source.findings.format);
  std::visit([](const auto& material) { print(material); }, fit.material);
  print_figures(fit.target, fit.figures, "");
  if (fit.layered) print_figures("layered", *fit.layered, ", with coat, fuzz and film");
  if (fit.factored)
    print_figures("factored", fit.factored->figures, fmt::format(", {} bytes", fit.factored->bytes));
  print(fit.beyond);
  fmt::print("fitted     in {:.2f} s{}\n", fit.seconds,
             arguments.out.empty() ? std::string() : fmt::format(", written {}", arguments.out));
}

void fit(const FitCommand& arguments) {
  if (!arguments.to.empty()) {
    fit_to_material(arguments);
    return;
  }
  const FitRequest request = request_of(arguments.how);
  if (arguments.out.empty()) throw CLI::RequiredError("--output");
  if (arguments.how.given("method"))
    check_name_of_json(arguments);
  else
    check_ending(arguments.out, {".exr", ".burnish"});
  check_writable(arguments.out);
  const auto start = std::chrono::steady_clock::now();
  const ThreadLimit limit(arguments.threads);
  const Source source = arguments.source.open();
  FitOptions options = usage([&] { return fit_options(request, source.ref().isotropic()); });
  const Fit fit = [&] {
    Progress progress("fitting");
    options.progress = progress.stages();
    return burnish::fit(source, options);
  }();
  const std::string bytes = format_fit(fit, arguments.out);
  write_then_rename(arguments.out, bytes);

  const auto* model = std::get_if<FactoredBrdf>(&fit.brdf);
  // Times of baselines are those of their fits alone.
  const double seconds = model
                             ? std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()
                             : fit.report.seconds;
  if (arguments.json) {
    fmt::print("{}\n", summary_json(fit, arguments.out, seconds, bytes.size()));
    return;
  }
  fmt::print("{}: {}\n", fit.report.source, fit.report.source_format);
  if (model)
    print_model(*model, fit.report);
  else
    print_baseline(std::get<BaselineBrdf>(fit.brdf), fit.report);
  fmt::print("written    {}, a file of {} bytes, in {:.2f} s\n", arguments.out, bytes.size(), seconds);
}

// Adds the options for fitting a renderer's material instead of factors.
void add_material_arguments(CLI::App& verb, FitCommand& arguments) {
  const auto targets = material_targets();
  CLI::Option* const to = verb.add_option(
      "--to", arguments.to, "Fits a renderer's material instead, and writes its parameters as JSON.");
  to->check(one_of({targets.begin(), targets.end()}));
  verb.add_flag("--simple", arguments.simple,
                "Fits OpenPBR's base and specular inputs alone, and also prints the errors with layers.")
      ->needs(to);
  verb.add_flag("--alone", arguments.alone,
                "Fits the material of --to alone, without a factored model to compare.")
      ->needs(to);
}

}  // namespace

void add_fit_command(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("fit", "Factor a BRDF into a product of small positive tables");
  verb->footer(
      "Examples: burnish fit paint.binary -o paint.exr\n"
      "          burnish fit paint.binary -o paint.exr --budget 2700\n"
      "          burnish fit paint.binary -o paint.exr --budget 16K --fetches 2\n"
      "          burnish fit paint.binary -o paint.exr --budget auto\n"
      "          burnish fit paint.binary -o paint.exr --model \"p(wo) q(h) r(theta_d) p(wi)\" --table q=96\n"
      "          burnish fit paint.binary -o paint.json --method svd --budget 2700\n"
      "          burnish fit pairs.csv -o paint.burnish --book library.burnish\n"
      "          burnish fit paint.binary --to openpbr -o paint.json");
  auto arguments = std::make_shared<FitCommand>();
  add_source_arguments(*verb, arguments->source);
  verb->add_option("-o,--output,--out", arguments->out,
                   "Names the model's file: compact where it ends in .burnish, else OpenEXR, and JSON with "
                   "--method or --to.");
  add_fit_arguments(*verb, arguments->how);
  verb->add_option("--threads", arguments->threads, "Uses at most this many threads; 0 uses all.")
      ->check(in_range(0, 1024));
  verb->add_flag("--json", arguments->json, "Prints the summary as JSON.");
  add_material_arguments(*verb, *arguments);
  verb->callback([arguments] { fit(*arguments); });
}

}  // namespace burnish::cli
