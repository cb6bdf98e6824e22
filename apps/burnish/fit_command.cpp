#include <chrono>
#include <functional>
#include <map>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/file.h>
#include <burnish/fitting/fit.h>
#include <burnish/math/parallel.h>

#include "commands.h"
#include "fit_baseline.h"
#include "progress.h"
#include "source_arguments.h"
#include "usage.h"

namespace burnish::cli {

namespace {

struct FitArguments {
  SourceArguments source;
  FitOptions options;
  std::string out, method, loss = "image", smooth = "default", format;
  int threads = 0;
  bool no_symmetrize = false, json = false;
};

// File names need not be UTF-8.
std::string dump(const nlohmann::ordered_json& notes, int indent) {
  return notes.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

double parse_smooth(const std::string& text) {
  double smooth = -1;
  if (!CLI::detail::lexical_cast(text, smooth) || !(smooth >= 0))
    throw CLI::ValidationError(fmt::format("--smooth: expected auto or a number >= 0, found '{}'", text));
  return smooth;
}

// One bar a stage; nothing where standard error is no terminal.
std::function<void(std::string_view, double)> progress_bars() {
  if (!progress_bar("")) return nullptr;
  return [bars = std::map<std::string, std::function<void(double)>, std::less<>>()](std::string_view stage,
                                                                                    double fraction) mutable {
    auto bar = bars.find(stage);
    if (bar == bars.end()) bar = bars.emplace(stage, progress_bar(std::string(stage))).first;
    bar->second(fraction);
  };
}

FitOptions fit_options(const FitArguments& arguments, bool isotropic) {
  FitOptions options = arguments.options;
  options.symmetrize = !arguments.no_symmetrize;
  options.loss = arguments.loss == "relative"  ? FitLoss::relative
                 : arguments.loss == "log_cos" ? FitLoss::log_cos
                                               : FitLoss::image;
  if (!arguments.format.empty()) options.format = parse_table_format(arguments.format);
  options.cross_validate = arguments.smooth == "auto";
  if (arguments.smooth != "auto" && arguments.smooth != "default")
    options.smooth = parse_smooth(arguments.smooth);
  if (options.budget == 0) usage([&] { return parse_model_spec(options.model, options.tables, isotropic); });
  options.progress = progress_bars();
  return options;
}

nlohmann::ordered_json fit(const FitArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  const ThreadLimit limit(arguments.threads);
  const Source source = arguments.source.open();
  const Model model = burnish::fit({.brdf = source.ref(),
                                    .name = source.name,
                                    .format = source.findings.format,
                                    .lambda_nm = source.findings.lambda_nm,
                                    .samples = source.samples(),
                                    .table = std::get_if<HalfDiffTable>(&source.brdf)},
                                   fit_options(arguments, source.ref().isotropic()));
  write_then_rename(arguments.out, format_model(model));
  const FactoredBrdf& brdf = model.brdf;
  auto notes = nlohmann::ordered_json::parse(model.notes);
  notes["output"] = arguments.out;
  notes["model"] = model_expression(brdf);
  notes["bytes"] = brdf.bytes();
  notes["table_bytes"] = brdf.table_bytes();
  notes["smallest_factor"] = brdf.smallest_factor();
  notes["reciprocal"] = brdf.reciprocal();
  notes["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return notes;
}

void print(const nlohmann::ordered_json& notes) {
  const auto number = [&](const char* key) { return notes.at(key).get<double>(); };
  fmt::print("{}: {}\n", notes.at("source").get<std::string>(), notes.at("source_format").get<std::string>());
  fmt::print("model      {}, {} bytes ({} of them tables)\n", notes.at("model").get<std::string>(),
             notes.at("bytes").get<std::size_t>(), notes.at("table_bytes").get<std::size_t>());
  if (notes.contains("lobes")) {
    fmt::print("fitted     {} samples, {} lobes, {} steps ({})\n", notes.at("samples").get<std::size_t>(),
               notes.at("lobes").get<int>(), notes.at("iterations").get<int>(),
               notes.at("stop_reason").get<std::string>());
    if (notes.contains("search"))
      fmt::print("searched   {} changes, {} kept\n", notes.at("search").at("trials").get<std::size_t>(),
                 notes.at("search").at("kept").size());
  } else {
    fmt::print("fitted     {} samples, {} iterations ({}), smooth {:.3g}\n",
               notes.at("samples").get<std::size_t>(), notes.at("iterations").get<int>(),
               notes.at("stop_reason").get<std::string>(), number("smooth"));
    fmt::print("rms log f  {:.4f} before, {:.4f} after\n", number("rms_log_before"), number("rms_log_after"));
  }
  if (notes.contains("conserve_energy")) {
    const auto& note = notes.at("conserve_energy");
    const auto was = [&](const char* key) {
      return note.at(key).is_number() ? note.at(key).get<double>() : 0;
    };
    fmt::print(
        "energy     albedo at most {:.4f} before, {:.4f} after; psnr {:.2f} -> {:.2f} dB, relative {:.4f} -> "
        "{:.4f}\n",
        was("largest_albedo_before"), was("largest_albedo_after"), was("psnr_before"), was("psnr_after"),
        was("relative_before"), was("relative_after"));
  }
  if (notes.contains("log_cos")) {
    if (notes.at("psnr").is_number())
      fmt::print("held out   psnr {:.2f} dB, ssim {:.4f}\n", number("psnr"), number("ssim"));
    fmt::print("held out   relative {:.4f}, rms_log {:.4f}, log_cos {:.4f}\n", number("relative"),
               number("rms_log"), number("log_cos"));
  } else if (notes.contains("relative_cross_validated"))
    fmt::print("relative   {:.4f} at the samples, {:.4f} cross-validated\n", number("relative"),
               number("relative_cross_validated"));
  else
    fmt::print("relative   {:.4f} at the samples\n", number("relative"));
  fmt::print("written    {} in {:.2f} s\n", notes.at("output").get<std::string>(), number("seconds"));
}

nlohmann::ordered_json fit_by_method(const FitArguments& arguments) {
  const ThreadLimit limit(arguments.threads);
  return fit_baseline(arguments.source.open(), {.method = arguments.method,
                                                .out = arguments.out,
                                                .budget = arguments.options.budget,
                                                .samples = arguments.options.samples,
                                                .seed = arguments.options.seed,
                                                .symmetrize = !arguments.no_symmetrize});
}

void add_lobes_arguments(CLI::App& verb, FitArguments& arguments) {
  FitOptions& options = arguments.options;
  verb.add_option("--budget", options.budget,
                  "bytes: fits the best model of several lobes that this many hold; K and M count as 1024s")
      ->transform(CLI::AsSizeValue(false));
  verb.add_option("--lobes", options.lobes, "of --budget (default: as many as serve it best)")
      ->check(CLI::Range(1, 64))
      ->needs("--budget");
  verb.add_option(
          "--loss", arguments.loss,
          "what several lobes are refined for: pictures at every exposure beside both means, or one mean")
      ->check(CLI::IsMember({"image", "relative", "log_cos"}))
      ->capture_default_str();
  verb.add_flag("--search", options.search,
                "of --budget: search factors, projections, warps and sizes first (up to a minute)")
      ->needs("--budget");
}

}  // namespace

void add_fit_command(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("fit", "Factor a BRDF into a product of small positive tables");
  verb->footer(
      "Examples: burnish fit paint.binary -o paint.exr --budget 2700\n"
      "          burnish fit paint.binary -o paint.exr --model \"p(wo) q(h) r(theta_d) p(wi)\" --table q=96\n"
      "          burnish fit paint.binary -o paint.json --method svd --budget 2700");
  auto arguments = std::make_shared<FitArguments>();
  add_source_arguments(*verb, arguments->source);
  FitOptions& options = arguments->options;
  add_lobes_arguments(*verb, *arguments);
  verb->add_option("-o,--output", arguments->out, "model file to write (OpenEXR; JSON with --method)")
      ->required();
  add_method_argument(*verb, arguments->method);
  verb->add_option(
          "--model", options.model,
          "product of tables over projections: pqp, pqpr, or such as \"p(wo) q(h) s(wi+wo+0.5n) p(wi)\"")
      ->capture_default_str();
  verb->add_option("--table", options.tables,
                   "size and spacing of a table: NAME=SIZE[,warp][,shared][,format], SIZE N (1-D), NxN "
                   "(hemisphere) or "
                   "NxM; warp identity, power:P or rational:K; format as --format")
      ->allow_extra_args(false);
  verb->add_option(
      "--smooth", arguments->smooth,
      "smoothness of the tables: a number >= 0, or auto (cross-validation; the default for scattered "
      "samples)");
  verb->add_option("--floor", options.floor,
                   "added to every value before its logarithm is taken, 1/sr, at most 1")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--reweightings", options.reweightings,
                   "passes towards the mean absolute error (default: 4 for scattered samples, else 0)")
      ->check(CLI::Range(0, 100));
  verb->add_option("--samples", options.samples, "pairs drawn from a source that is a function")
      ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}));
  verb->add_option("--seed", options.seed, "of the drawn pairs")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option(
          "--format", arguments->format,
          "of the stored tables (default: half; with --budget and three channels rgb9e5, which leaves shared "
          "tables half)")
      ->check(CLI::IsMember({"half", "float", "rgb9e5", "unorm8"}));
  verb->add_option("--threads", arguments->threads, "at most this many; 0: all")->check(CLI::Range(0, 1024));
  verb->add_flag("--no-symmetrize", arguments->no_symmetrize,
                 "fit f(wi, wo) as it is, not its reciprocal part");
  verb->add_flag("--conserve-energy", options.conserve_energy,
                 "damp the model where it reflects more than it receives, and say what that cost");
  verb->add_flag("--json", arguments->json, "print the summary as JSON");
  verb->callback([arguments] {
    const bool baseline = !arguments->method.empty();
    const nlohmann::ordered_json notes = baseline ? fit_by_method(*arguments) : fit(*arguments);
    if (arguments->json)
      fmt::print("{}\n", dump(notes, 2));
    else if (baseline)
      print_baseline(notes);
    else
      print(notes);
  });
}

}  // namespace burnish::cli
