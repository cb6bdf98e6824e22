// burnish_accuracy DOCS_FOLDER [--quick]: how accurate models of a number of bytes are, beside others of the
// same size, printed as Markdown tables; figures go to DOCS_FOLDER/figures. Real materials need the folder of
// measurements in the environment variable BURNISH_DATA and are left out, with a message, without it.
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <string_view>
#include <thread>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/table_format.h>
#include <burnish/fitting/budget.h>
#include <burnish/io/source.h>
#include <burnish/metrics/contact_sheet.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/metrics/png.h>
#include <burnish/reflectance/analytic.h>

#include "report_tools.h"

namespace burnish {
namespace {

struct Score {
  ErrorFigures errors;
  std::size_t bytes = 0;
  double seconds = 0;
  int reads = 0, multiplies = 0;  ///< of one evaluation, all channels of a texel read together
};

struct Fitted {
  FactoredBrdf brdf;
  double seconds = 0;
};

Fitted fit(BrdfRef reference, std::size_t bytes) {
  const Stopwatch watch;
  const int channels = reference.channels();
  const TableFormat format = channels == 3 ? TableFormat::rgb9e5 : TableFormat::half;
  const std::size_t texel = texel_bytes(format, channels);
  const TrainingSet set =
      draw_training_set(reference, {.directions = reference.isotropic() ? 60'000u : 200'000u});
  const LobesFit result =
      fit_plan(set, default_plan(bytes, 0, reference.isotropic(), texel), bytes, texel, {.format = format});
  return {to_brdf(result.model, format), watch.seconds()};
}

Score score(const Scorer& scorer, const Fitted& fitted) {
  Score s{.errors = scorer.score(fitted.brdf), .bytes = fitted.brdf.bytes(), .seconds = fitted.seconds};
  for (const Lobe& lobe : fitted.brdf.lobes())
    for (const FactorUse& use : lobe.factors) {
      const bool line =
          fitted.brdf.tables()[static_cast<std::size_t>(use.table)].layout.shape == TableShape::line;
      s.reads += line ? 2 : 4;
      s.multiplies += fitted.brdf.channels() * (line ? 2 : 4);  // interpolation, and the product
    }
  return s;
}

constexpr const char* kHead =
    "| material | representation | bytes | psnr | ssim | relative | log_cos | rms_log | table reads | "
    "multiplies | fit seconds |\n|---|---|---|---|---|---|---|---|---|---|---|\n";

void print_row(const std::string& material, const std::string& name, const Score& s) {
  const ErrorFigures& e = s.errors;
  fmt::print("| {} | {} | {} | {:.2f} | {:.3f} | {:.4f} | {:.4f} | {:.3f} | {} | {} | {} |\n", material, name,
             s.bytes, e.psnr, e.ssim, e.relative, e.log_cos, e.rms_log,
             s.reads > 0 ? std::to_string(s.reads) : "", s.multiplies > 0 ? std::to_string(s.multiplies) : "",
             s.seconds > 0 ? fmt::format("{:.1f}", s.seconds) : "");
}

/// Means of scores under a name, in the order they came.
class Means {
 public:
  void add(const std::string& name, const Score& s) {
    auto& [sum, count] = sums_[name];
    if (count == 0) order_.push_back(name);
    sum.bytes += s.bytes;
    sum.seconds += s.seconds;
    sum.errors.psnr += s.errors.psnr;
    sum.errors.ssim += s.errors.ssim;
    sum.errors.relative += s.errors.relative;
    sum.errors.log_cos += s.errors.log_cos;
    sum.errors.rms_log += s.errors.rms_log;
    ++count;
  }
  Score mean(const std::string& name) const {
    auto [sum, count] = sums_.at(name);
    const double n = static_cast<double>(count);
    sum.bytes /= count;
    sum.seconds /= n;
    for (double* e :
         {&sum.errors.psnr, &sum.errors.ssim, &sum.errors.relative, &sum.errors.log_cos, &sum.errors.rms_log})
      *e /= n;
    return sum;
  }
  void print() const {
    for (const std::string& name : order_) print_row("**mean**", name, mean(name));
  }

 private:
  std::map<std::string, std::pair<Score, std::size_t>> sums_;
  std::vector<std::string> order_;
};

Image8 picture(BrdfRef brdf, double exposure) {
  return lit_sphere(brdf,
                    {.size = 160, .light_angle = kSphereLights[1], .exposure = exposure, .supersampling = 2});
}

/// Multiply-adds of the 6-21-21-3 network.
constexpr int kNetworkMultiplies = 6 * 21 + 21 * 21 + 21 * 3;

void report_rgl(const fs::path& data, const fs::path& docs, bool quick) {
  const std::vector<std::size_t> budgets =
      quick ? std::vector<std::size_t>{1350} : std::vector<std::size_t>{1350, 2700, 16'384, 65'536};
  fmt::print(
      "## Eight RGL materials, symmetrized\n\nOurs: `burnish fit --budget BYTES`. The network: the published "
      "encoding of the same material, 675 weights, 1,350 bytes as half floats [Sztrajman2021]. "
      "Spheres ([picture](figures/accuracy-spheres.png)): reference, network, ours at rising bytes.\n\n{}",
      kHead);
  Means means;
  ContactSheet sheet{.title = "Reference, network, ours; light at 30 degrees"};
  sheet.column_labels = {"reference", "network\n1,350 bytes"};
  for (const std::size_t b : budgets) sheet.column_labels.push_back(fmt::format("ours\n{} bytes", b));
  std::vector<fs::path> files = files_in(data / "rgl");
  if (quick) files.resize(1);
  for (const fs::path& file : files) {
    const std::string name = file.stem().string();
    const Source source = open_source(file.string(), {});
    const SymmetrizedBrdf reference(source.ref());
    const Scorer scorer(reference);
    std::vector<Image8>& row = sheet.cells.emplace_back();
    sheet.row_labels.push_back(name);
    row.push_back(picture(reference, scorer.exposure()));
    const Source network =
        open_source(fmt::format("nbrdf:{}#{}", (data / "nbrdf/rgl.csv").string(), name), {});
    const SymmetrizedBrdf symmetric(network.ref());
    const Score neural{.errors = scorer.score(symmetric), .bytes = 1350, .multiplies = kNetworkMultiplies};
    print_row(name, "network", neural);
    means.add("network", neural);
    row.push_back(picture(symmetric, scorer.exposure()));
    for (const std::size_t bytes : budgets) {
      const Fitted fitted = fit(reference, bytes);
      const Score s = score(scorer, fitted);
      const std::string label = fmt::format("ours, {}", bytes);
      print_row(name, label, s);
      std::fflush(stdout);
      means.add(label, s);
      row.push_back(picture(fitted.brdf, scorer.exposure()));
    }
  }
  means.print();
  fmt::print("\n");
  fs::create_directories(docs / "figures");
  write_then_rename(docs / "figures/accuracy-spheres.png", encode_png(compose(sheet)));

  const auto plot = [&](const char* title, const char* file, auto value, bool log_y) {
    Plot p{.title = title, .x_label = "bytes", .y_label = file, .log_x = true, .log_y = log_y};
    PlotSeries ours{.label = "ours", .style = PlotStyle::line_and_points},
        network{.label = "network", .style = PlotStyle::points};
    for (const std::size_t b : budgets) {
      ours.x.push_back(static_cast<double>(b));
      ours.y.push_back(value(means.mean(fmt::format("ours, {}", b)).errors));
    }
    network.x = {1350};
    network.y = {value(means.mean("network").errors)};
    p.series = {ours, network};
    save(p, docs, fmt::format("accuracy-{}", file));
  };
  plot(
      "Mean psnr over the RGL materials", "psnr", [](const ErrorFigures& e) { return e.psnr; }, false);
  plot(
      "Mean relative error over the RGL materials", "relative",
      [](const ErrorFigures& e) { return e.relative; }, true);
  plot(
      "Mean log_cos over the RGL materials", "log_cos", [](const ErrorFigures& e) { return e.log_cos; },
      true);
}

/// The first column of a CSV file.
std::vector<std::string> row_names(const fs::path& file) {
  std::vector<std::string> names;
  std::ifstream rows(file);
  for (std::string row; std::getline(rows, row);)
    if (const auto comma = row.find(','); comma != row.npos) names.push_back(row.substr(0, comma));
  return names;
}

void report_merl(const fs::path& data, bool quick) {
  const std::vector<std::string> names = row_names(data / "nbrdf/merl.csv");
  fmt::print("\n## Stand-ins for the MERL materials, 2,700 bytes\n\nThe published encodings of {}.\n\n{}",
             quick ? "every tenth material" : "all 100 materials", kHead);
  Means means;
  double worst = 0;
  for (std::size_t i = 0; i < names.size(); i += quick ? 50 : 1) {
    const Source source =
        open_source(fmt::format("nbrdf:{}#{}", (data / "nbrdf/merl.csv").string(), names[i]), {});
    const SymmetrizedBrdf reference(source.ref());
    const Score s = score(Scorer(reference, {.count = 50'000}), fit(reference, 2700));
    means.add("ours, 2700", s);
    worst = std::max(worst, s.errors.rms_log);
  }
  means.print();
  fmt::print("\nLargest rms_log of a material: {:.3f}.\n", worst);
}

void report_single(const std::string& title, BrdfRef reference, const std::vector<std::size_t>& budgets) {
  const Scorer scorer(reference);
  for (const std::size_t bytes : budgets)
    print_row(title, fmt::format("ours, {}", bytes), score(scorer, fit(reference, bytes)));
}

void report_others(const std::optional<fs::path>& data, bool quick) {
  fmt::print("\n## Other materials\n\n{}", kHead);
  const std::vector<std::size_t> budgets =
      quick ? std::vector<std::size_t>{3000} : std::vector<std::size_t>{2700, 16'384, 65'536};
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.1,alpha_y=0.3,f0=0.8,kd=0.3");
  report_single("anisotropic GGX 0.1 x 0.3, k_d 0.3, f0 0.8", ggx.ref(), budgets);
  if (!data || quick) return;
  for (const char* file :
       {"mbsdf/carpaint_blue.mbsdf", "klems/mecho_shade_fabric_aniso.xml", "zemax/AnoBlackEC1onAlum.bsdf"}) {
    const Source source = open_source((*data / file).string(), {});
    const SymmetrizedBrdf reference(source.ref());
    report_single(file, reference, budgets);
  }
}

}  // namespace
}  // namespace burnish

int main(int argc, char** argv) {
  const bool quick = argc == 3 && std::string_view(argv[2]) == "--quick";
  if (argc != 2 && !quick) {
    fmt::print(stderr, "usage: burnish_accuracy DOCS_FOLDER [--quick]\n");
    return 2;
  }
  try {
    fmt::print(
        "# Accuracy: what a number of bytes buys\n\nMade by `make report` on {}, {} threads. The error "
        "figures "
        "are defined in [factorization.md](factorization.md); all are of the models as stored, on directions "
        "that were not fitted. How the models are fitted: [lobes.md](lobes.md).\n\n",
        burnish::processor(), std::thread::hardware_concurrency());
    const char* data = std::getenv("BURNISH_DATA");
    if (data) {
      burnish::report_rgl(data, argv[1], quick);
      burnish::report_merl(data, quick);
    } else {
      fmt::print("BURNISH_DATA is not set: no real materials.\n");
    }
    burnish::report_others(data ? std::optional<burnish::fs::path>(data) : std::nullopt, quick);
  } catch (const std::exception& error) {
    fmt::print(stderr, "burnish_accuracy: {}\n", error.what());
    return 1;
  }
  return 0;
}
