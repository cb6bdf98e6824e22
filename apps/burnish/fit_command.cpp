#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/factors/model_file.h>
#include <burnish/file.h>
#include <burnish/fitting/cross_validation.h>
#include <burnish/fitting/energy.h>
#include <burnish/fitting/log_error.h>
#include <burnish/math/parallel.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/sample_source.h>

#include "commands.h"
#include "fit_baseline.h"
#include "fit_lobes.h"
#include "progress.h"
#include "source_arguments.h"
#include "usage.h"

namespace burnish::cli {

namespace {

// Scattered samples are few and noisy: they are fitted robustly, with the smoothness that predicts best.
constexpr int kScatteredReweightings = 4;

// Pairs drawn from a source that is a function.
constexpr std::size_t kIsotropicSamples = 200'000, kAnisotropicSamples = 500'000;

// Pairs that the fit did not see, for the error that is printed.
constexpr std::size_t kHeldOutPairs = 20'000;

struct Arguments {
  SourceArguments source;
  std::string out, method, model = "pqp", smooth = "default", format;
  LobesArguments lobes;
  std::vector<std::string> tables;
  std::size_t samples = 0;
  std::uint64_t seed = 1;
  int reweightings = -1, threads = 0;
  double floor = HomomorphicOptions{}.floor;
  bool conserve_energy = false, json = false;
};

// File names need not be UTF-8.
std::string dump(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

bool has_disk(const ModelSpec& spec) {
  for (const ModelSpec::TableSpec& table : spec.tables)
    if (table.layout.shape == TableShape::disk) return true;
  return false;
}

/// What is fitted: the source's own samples where it has some, else pairs drawn from it. The samples may
/// refer to the symmetrized source beside them: it stays where it was made.
struct FitInput {
  FitInput() = default;
  FitInput(const FitInput&) = delete;

  std::optional<SymmetrizedBrdf> symmetrized;
  SampleSource samples;
};

void make_input(const Source& source, const Arguments& arguments, const ModelSpec& spec, FitInput& input) {
  const bool symmetrize = !arguments.lobes.no_symmetrize;
  if (const Samples* samples = source.samples()) {
    input.samples = from_samples(*samples, symmetrize);
  } else if (const auto* table = std::get_if<HalfDiffTable>(&source.brdf)) {
    input.samples = from_table(*table, symmetrize, has_disk(spec));
  } else {
    const BrdfRef brdf = source.ref();
    const std::size_t count = arguments.samples > 0 ? arguments.samples
                              : brdf.isotropic()    ? kIsotropicSamples
                                                    : kAnisotropicSamples;
    if (symmetrize) input.symmetrized.emplace(brdf);
    input.samples =
        from_brdf(symmetrize ? BrdfRef(*input.symmetrized) : brdf, count, arguments.seed, has_disk(spec));
  }
}

HomomorphicOptions make_options(const Source& source, const Arguments& arguments) {
  HomomorphicOptions options;
  options.floor = arguments.floor;
  if (!arguments.format.empty()) options.format = parse_table_format(arguments.format);
  options.reweightings = arguments.reweightings >= 0 ? arguments.reweightings
                         : source.samples()          ? kScatteredReweightings
                                                     : 0;
  options.progress = progress_bar("fitting");
  return options;
}

double parse_smooth(const std::string& text) {
  double smooth = -1;
  if (!CLI::detail::lexical_cast(text, smooth) || !(smooth >= 0))
    throw CLI::ValidationError(fmt::format("--smooth: expected auto or a number >= 0, found '{}'", text));
  return smooth;
}

/// The paper's fit: one lobe, log-linear.
FactoredBrdf fit_one(const Source& source, ModelSpec spec, const Arguments& arguments,
                     nlohmann::ordered_json& notes) {
  FitInput input;
  make_input(source, arguments, spec, input);
  HomomorphicOptions options = make_options(source, arguments);
  std::optional<double> cross_validated;
  if (arguments.smooth == "auto" || (arguments.smooth == "default" && source.samples())) {
    const std::vector<SmoothTrial> trials = choose_smoothness(input.samples, spec, options);
    options.smooth = trials.front().smooth;
    for (std::size_t t = 0; t < spec.tables.size(); ++t)
      spec.tables[t].smooth_share = trials.front().shares[t];
    if (input.samples.distinct <= kManySamples) cross_validated = trials.front().error;
  } else if (arguments.smooth != "default") {
    options.smooth = parse_smooth(arguments.smooth);
  }
  HomomorphicFit result = fit_homomorphic(input.samples, spec, options);
  const HomomorphicSummary& summary = result.summary;
  notes["samples"] = summary.samples;
  notes["smooth"] = options.smooth;
  notes["floor"] = options.floor;
  notes["reweightings"] = summary.reweightings;
  notes["rms_log_before"] = summary.error_before;
  notes["rms_log_after"] = summary.error_after;
  notes["iterations"] = summary.iterations;
  notes["stop_reason"] = summary.stop_reason;
  for (const ModelSpec::TableSpec& table : spec.tables)
    if (table.smooth_share != 1) notes["smooth_shares"][table.name] = table.smooth_share;
  if (source.samples())
    notes["relative"] = std::expm1(log_error(input.samples, result.brdf, options.error_floor).mean());
  if (cross_validated) notes["relative_cross_validated"] = std::expm1(*cross_validated);
  return std::move(result.brdf);
}

FactoredBrdf fit_model(const Source& source, const Arguments& arguments, nlohmann::ordered_json& notes) {
  const bool isotropic = source.ref().isotropic();
  LobesArguments lobes = arguments.lobes;
  lobes.seed = arguments.seed;
  lobes.format = arguments.format;
  if (arguments.smooth != "default" && arguments.smooth != "auto")
    lobes.smooth = parse_smooth(arguments.smooth);
  if (lobes.budget > 0) {
    // few scattered samples do not carry several lobes
    if (source.samples()) return fit_one(source, one_lobe_spec(source, lobes), arguments, notes);
    return fit_to_budget(source, lobes, notes);
  }
  ModelSpec spec = usage([&] { return parse_model_spec(arguments.model, arguments.tables, isotropic); });
  if (spec.lobes.size() == 1) return fit_one(source, std::move(spec), arguments, notes);
  return fit_several_lobes(source, spec, lobes, notes);
}

// Takes out of the model what it reflects too much; `notes` says what that cost.
void conserve(BrdfRef reference, const FigureOptions& figures, FactoredBrdf& brdf,
              nlohmann::ordered_json& notes) {
  EnergyConservation kept = conserve_energy(brdf);
  nlohmann::ordered_json& note = notes["conserve_energy"];
  note = {{"largest_albedo_before", std::ranges::max(kept.largest_before)},
          {"largest_albedo_after", std::ranges::max(kept.largest_after)},
          {"iterations", kept.iterations}};
  const Scorer scorer(reference, figures);
  for (const auto& [when, model] : {std::pair("before", &brdf), std::pair("after", &kept.brdf)}) {
    const ErrorFigures error = scorer.score(*model);
    note[fmt::format("psnr_{}", when)] = error.psnr;
    note[fmt::format("relative_{}", when)] = error.relative;
  }
  brdf = std::move(kept.brdf);
}

nlohmann::ordered_json fit(const Arguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  const ThreadLimit limit(arguments.threads);
  const Source source = arguments.source.open();
  nlohmann::ordered_json notes{{"source", source.name},
                               {"source_format", source.findings.format},
                               {"symmetrized", !arguments.lobes.no_symmetrize}};
  FactoredBrdf brdf = fit_model(source, arguments, notes);
  // After rounding to the table format, on pairs that were not fitted.
  std::optional<SymmetrizedBrdf> symmetrized;
  if (!arguments.lobes.no_symmetrize) symmetrized.emplace(source.ref());
  const BrdfRef reference = symmetrized ? BrdfRef(*symmetrized) : source.ref();
  const FigureOptions figures{.count = kHeldOutPairs, .seed = arguments.seed + 1, .image_size = 128};
  if (arguments.conserve_energy) conserve(reference, figures, brdf, notes);
  if (!source.samples()) {
    const ErrorFigures error = error_figures(reference, brdf, figures);
    notes["psnr"] = std::isfinite(error.psnr) ? nlohmann::ordered_json(error.psnr) : nlohmann::ordered_json();
    notes["ssim"] = error.ssim;
    notes["relative"] = error.relative;
    notes["rms_log"] = error.rms_log;
    notes["log_cos"] = error.log_cos;
  }
  write_then_rename(
      arguments.out,
      format_model({.brdf = brdf, .lambda_nm = source.findings.lambda_nm, .notes = dump(notes, -1)}));
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

nlohmann::ordered_json fit_by_method(const Arguments& arguments) {
  const ThreadLimit limit(arguments.threads);
  return fit_baseline(arguments.source.open(), {.method = arguments.method,
                                                .out = arguments.out,
                                                .budget = arguments.lobes.budget,
                                                .samples = arguments.samples,
                                                .seed = arguments.seed,
                                                .symmetrize = !arguments.lobes.no_symmetrize});
}

}  // namespace

void add_fit_command(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("fit", "Factor a BRDF into a product of small positive tables");
  verb->footer(
      "Examples: burnish fit paint.binary -o paint.exr --budget 2700\n"
      "          burnish fit paint.binary -o paint.exr --model \"p(wo) q(h) r(theta_d) p(wi)\" --table q=96\n"
      "          burnish fit paint.binary -o paint.json --method svd --budget 2700");
  auto arguments = std::make_shared<Arguments>();
  add_source_arguments(*verb, arguments->source);
  add_lobes_arguments(*verb, arguments->lobes);
  verb->add_option("-o,--output", arguments->out, "model file to write (OpenEXR; JSON with --method)")
      ->required();
  add_method_argument(*verb, arguments->method);
  verb->add_option(
          "--model", arguments->model,
          "product of tables over projections: pqp, pqpr, or such as \"p(wo) q(h) s(wi+wo+0.5n) p(wi)\"")
      ->capture_default_str();
  verb->add_option("--table", arguments->tables,
                   "size and spacing of a table: NAME=SIZE[,warp][,shared][,format], SIZE N (1-D), NxN "
                   "(hemisphere) or "
                   "NxM; warp identity, power:P or rational:K; format as --format")
      ->allow_extra_args(false);
  verb->add_option(
      "--smooth", arguments->smooth,
      "smoothness of the tables: a number >= 0, or auto (cross-validation; the default for scattered "
      "samples)");
  verb->add_option("--floor", arguments->floor, "added to every value before its logarithm is taken, 1/sr")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--reweightings", arguments->reweightings,
                   "passes towards the mean absolute error (default: 4 for scattered samples, else 0)")
      ->check(CLI::Range(0, 100));
  verb->add_option("--samples", arguments->samples, "pairs drawn from a source that is a function")
      ->check(CLI::Range(std::size_t{1}, std::size_t{100'000'000}));
  verb->add_option("--seed", arguments->seed, "of the drawn pairs")->capture_default_str();
  verb->add_option(
          "--format", arguments->format,
          "of the stored tables (default: half; with --budget and three channels rgb9e5, which leaves shared "
          "tables half)")
      ->check(CLI::IsMember({"half", "float", "rgb9e5", "unorm8"}));
  verb->add_option("--threads", arguments->threads, "at most this many; 0: all")->check(CLI::Range(0, 1024));
  verb->add_flag("--no-symmetrize", arguments->lobes.no_symmetrize,
                 "fit f(wi, wo) as it is, not its reciprocal part");
  verb->add_flag("--conserve-energy", arguments->conserve_energy,
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
