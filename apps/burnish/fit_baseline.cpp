#include "fit_baseline.h"

#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <burnish/file.h>
#include <burnish/fitting/baselines/baselines.h>
#include <burnish/fitting/baselines/separable_fit.h>

#include "progress.h"

namespace burnish::cli {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kDrawnPairs = 200'000, kHeldOutPairs = 20'000;

Json figures_json(const ErrorFigures& f) {
  return {{"psnr", f.psnr},
          {"ssim", f.ssim},
          {"relative", f.relative},
          {"rms_log", f.rms_log},
          {"log_cos", f.log_cos}};
}

// What it costs to be rid of an SVD's negative values, in each of the usual ways.
Json negative_lobes_json(const SeparableBrdf& brdf, const Scorer& scorer) {
  const NegativeLobes lobes = negative_lobes(brdf, scorer);
  return {{"negative_share", lobes.negative_share},
          {"bias", lobes.bias},
          {"sum_clamped", figures_json(lobes.sum_clamped)},
          {"tables_clamped", figures_json(lobes.tables_clamped)},
          {"biased", figures_json(lobes.biased)}};
}

}  // namespace

void add_method_argument(CLI::App& verb, std::string& method) {
  verb.add_option("--method", method,
                  fmt::format("fit what others would instead of positive factors, at --budget bytes (default "
                              "{}): {}",
                              BaselineOptions{}.budget, fmt::join(baseline_methods(), ", ")));
}

Json fit_baseline(const Source& source, const BaselineArguments& arguments) {
  std::optional<SymmetrizedBrdf> symmetrized;
  if (arguments.symmetrize) symmetrized.emplace(source.ref());
  const BrdfRef brdf = symmetrized ? BrdfRef(*symmetrized) : source.ref();
  const SampleSource samples =
      source.samples()
          ? from_samples(*source.samples(), arguments.symmetrize)
          : from_brdf(brdf, arguments.samples > 0 ? arguments.samples : kDrawnPairs, arguments.seed, false);
  const std::size_t budget = arguments.budget > 0 ? arguments.budget : BaselineOptions{}.budget;
  BaselineFit fit = burnish::fit_baseline(
      brdf, samples, arguments.method,
      {.budget = budget, .seed = arguments.seed, .progress = progress_bar(arguments.method)});

  Json notes{{"source", source.name},
             {"source_format", source.findings.format},
             {"symmetrized", arguments.symmetrize},
             {"method", fit.method},
             {"budget", budget}};
  notes.update(Json::parse(fit.baseline.notes));
  const BrdfRef model = baseline_ref(fit.baseline.brdf);
  const Scorer scorer(brdf, {.count = kHeldOutPairs, .seed = arguments.seed + 1});
  notes.update(figures_json(scorer.score(model)));
  if (fit.method == "svd")
    notes["negative_lobes"] = negative_lobes_json(std::get<SeparableBrdf>(fit.baseline.brdf), scorer);
  // File names need not be UTF-8.
  fit.baseline.notes = notes.dump(-1, ' ', false, Json::error_handler_t::replace);
  write_then_rename(arguments.out, format_baseline(fit.baseline));

  notes["output"] = arguments.out;
  notes["model"] = baseline_expression(fit.baseline.brdf);
  notes["bytes"] = fit.bytes;
  if (fit.cost) {
    notes["table_reads"] = fit.cost->table_reads;
    notes["multiplies"] = fit.cost->multiplies;
  }
  notes["seconds"] = fit.seconds;
  return notes;
}

void print_baseline(const Json& notes) {
  const auto figures = [](const Json& f) {
    const auto number = [&](const char* key) { return f.at(key).get<double>(); };
    return fmt::format("psnr {:.2f}, ssim {:.4f}, relative {:.4f}, rms_log {:.4f}, log_cos {:.4f}",
                       number("psnr"), number("ssim"), number("relative"), number("rms_log"),
                       number("log_cos"));
  };
  fmt::print("{}: {}\n", notes.at("source").get<std::string>(), notes.at("source_format").get<std::string>());
  fmt::print("model      {}, {}, {} bytes\n", notes.at("method").get<std::string>(),
             notes.at("model").get<std::string>(), notes.at("bytes").get<std::size_t>());
  if (notes.contains("table_reads"))
    fmt::print("evaluation {} table reads, {} multiplies\n", notes.at("table_reads").get<std::size_t>(),
               notes.at("multiplies").get<std::size_t>());
  fmt::print("held out   {}\n", figures(notes));
  if (notes.contains("negative_lobes")) {
    const Json& lobes = notes.at("negative_lobes");
    fmt::print("negative   {:.2f} % of the values before they are clamped\n",
               100 * lobes.at("negative_share").get<double>());
    fmt::print("  tables clamped instead: {}\n", figures(lobes.at("tables_clamped")));
    fmt::print("  lifted by {:.3g} instead: {}\n", lobes.at("bias").get<double>(),
               figures(lobes.at("biased")));
  }
  fmt::print("written    {} in {:.2f} s\n", notes.at("output").get<std::string>(),
             notes.at("seconds").get<double>());
}

}  // namespace burnish::cli
