#include <filesystem>
#include <list>
#include <memory>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include <burnish/image/png.h>
#include <burnish/math/angles.h>
#include <burnish/report/compare_report.h>
#include <burnish/report/factor_images.h>

#include "commands.h"
#include "source_arguments.h"

namespace burnish::cli {

namespace {

struct CompareArguments {
  SourceArguments reference;
  std::vector<std::string> models;
  std::string folder;
  FigureOptions figures;
  bool no_symmetrize = false, json = false;
};

/// An opened BRDF, made reciprocal like the others unless it is so by construction.
class Candidate {
 public:
  Candidate(Source source, bool symmetrize) : source_(std::move(source)) {
    if (symmetrize && !(model() && model()->reciprocal())) symmetrized_.emplace(source_.ref());
  }
  Candidate(const Candidate&) = delete;

  BrdfRef ref() const { return symmetrized_ ? BrdfRef(*symmetrized_) : source_.ref(); }
  const Source& source() const { return source_; }
  const FactoredBrdf* model() const { return std::get_if<FactoredBrdf>(&source_.brdf); }

 private:
  Source source_;
  std::optional<SymmetrizedBrdf> symmetrized_;
};

// folder/factors/model_N_TABLE.png for the models that are factored.
void write_factors(const std::filesystem::path& folder, const std::list<Candidate>& candidates) {
  int number = 0;
  for (const Candidate& c : candidates) {
    ++number;
    if (!c.model()) continue;
    std::filesystem::create_directories(folder / "factors");
    for (const Table& table : c.model()->tables())
      write_png(folder / "factors" / fmt::format("model_{}_{}.png", number, table.name), factor_image(table));
  }
}

// One line for the reference and each model, means over the channels.
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

void compare(const CompareArguments& arguments) {
  // a list: models refer to their candidates
  const Candidate reference(arguments.reference.open(), !arguments.no_symmetrize);
  std::list<Candidate> candidates;
  std::vector<ComparedModel> models;
  for (const std::string& spec : arguments.models) {
    const Candidate& c =
        candidates.emplace_back(open_source(spec, arguments.reference.options), !arguments.no_symmetrize);
    ComparedModel model{.name = spec, .brdf = c.ref(), .note = c.source().findings.description};
    model.bytes = c.source().bytes();
    models.push_back(std::move(model));
  }

  const Scorer scorer(reference.ref(), arguments.figures);
  const std::vector<ComparedFigures> figures =
      arguments.folder.empty() ? compare_models(scorer, models)
                               : write_report(arguments.folder, reference.source().name, scorer, models);
  if (!arguments.folder.empty()) write_factors(arguments.folder, candidates);
  if (arguments.json) {
    fmt::print("{}\n", to_json(figures));
    return;
  }

  fmt::print("{:<32} {:>8} {:>8} {:>7} {:>9} {:>8} {:>8}\n", "model", "bytes", "psnr", "ssim", "relative",
             "rms_log", "log_cos");
  for (const ComparedFigures& f : figures)
    fmt::print("{:<32} {:>8} {:>8.2f} {:>7.4f} {:>9.4f} {:>8.4f} {:>8.4f}\n", f.name,
               f.bytes ? fmt::format("{}", *f.bytes) : "-", f.figures.psnr, f.figures.ssim,
               f.figures.relative, f.figures.rms_log, f.figures.log_cos);
  print_albedos(figures);
  const ErrorFigures& first = figures.front().figures;
  if (first.unknown_fraction > 0 || first.unknown_pixels > 0)
    fmt::print("left out: {:.1f} % of the direction pairs and {} pixels, where a side knows nothing\n",
               100 * first.unknown_fraction, first.unknown_pixels);
  if (!arguments.folder.empty()) fmt::print("report: {}/index.html\n", arguments.folder);
}

}  // namespace

void add_compare_command(CLI::App& app) {
  CLI::App* verb =
      app.add_subcommand("compare", "Measure models against a reference: error figures and pictures");
  verb->footer("Example: burnish compare paint.binary paint.exr other.exr -o report");
  auto arguments = std::make_shared<CompareArguments>();
  add_source_arguments(*verb, arguments->reference);
  verb->add_option("models", arguments->models, "BRDFs to compare with it")->required();
  verb->add_option("-o,--output", arguments->folder,
                   "folder for a report with pictures: index.html and its parts");
  verb->add_option("--count", arguments->figures.count, "direction pairs")
      ->check(CLI::Range(1, 100'000'000))
      ->capture_default_str();
  verb->add_option("--seed", arguments->figures.seed, "of the direction pairs")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_flag("--no-symmetrize", arguments->no_symmetrize,
                 "compare f(wi, wo) as it is, not the mean with f(wo, wi)");
  verb->add_flag("--json", arguments->json, "print the figures as JSON");
  verb->callback([arguments] { compare(*arguments); });
}

}  // namespace burnish::cli
