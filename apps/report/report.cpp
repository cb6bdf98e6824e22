// burnish_report DOCS_FOLDER: measures what docs/factorization.md states and prints it as Markdown tables;
// figures go to DOCS_FOLDER/figures. Tables of real materials need the folder of measurements in the
// environment variable BURNISH_DATA and are left out, with a message, without it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/fitting/fit_file.h>
#include <burnish/image/png.h>
#include <burnish/image/svg_plot.h>
#include <burnish/io/cornell.h>
#include <burnish/io/merl.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/scattered_brdf.h>

#include "report_tools.h"
#include "scattered.h"

namespace burnish {
namespace {

// ---- Scattered samples of an anisotropic GGX

constexpr std::size_t kGgxSamples = 500'000, kGgxHeldOut = 100'000;

/// Mean |ln f - ln model| over held-out pairs, all of them, or those with h within `cap` radians of the
/// normal.
double mean_abs_log(BrdfRef truth, const FactoredBrdf& model, std::optional<double> cap = {}) {
  std::vector<double> f(3), g(3);
  double sum = 0;
  std::size_t count = 0;
  for (const auto& [wi, wo] : draw_pairs(kGgxHeldOut, 99, false)) {
    if (cap && theta_of(half_vector(wi, wo)) > *cap) continue;
    truth.eval(wi, wo, f);
    model.eval(wi, wo, g);
    for (std::size_t c = 0; c < 3; ++c) sum += std::abs(std::log(g[c] / f[c]));
    count += 3;
  }
  return sum / static_cast<double>(count);
}

Samples without_cap(const Samples& samples, double cap) {
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (theta_of(half_vector(samples.pairs[i].wi, samples.pairs[i].wo)) >= cap) left.push_back(i);
  return select(samples, left);
}

void report_ggx(const fs::path& docs) {
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.1,alpha_y=0.3,f0=0.8,kd=0");
  const Samples samples = measure(ggx.ref(), {.count = kGgxSamples, .noise = 0, .seed = 7});
  const double cap = radians(20);
  const Source source = source_of(samples), holed = source_of(without_cap(samples, cap));

  fmt::print("## Anisotropic GGX (alpha 0.1 x 0.3, f0 0.8), {} scattered samples\n\n", kGgxSamples);
  fmt::print("`pqp`, two 64 x 64 tables, half floats; errors on {} held-out pairs.\n\n", kGgxHeldOut);
  fmt::print(
      "| q's radial warp | smooth | mean abs dlog f | iterations | seconds | smallest factor | reciprocity "
      "error |\n"
      "|---|---|---|---|---|---|---|\n");
  const auto fit_to = [&](const Source& input, const std::string& warp, double smooth) {
    return fit(input, {.form = OneLobe{.model = "pqp",
                                       .tables = {"p=64x64", "q=64x64," + warp},
                                       .how = {.reweightings = 0, .floor = 1e-6}},
                       .smooth = smooth,
                       .score = false});
  };
  for (const char* warp : {"identity", "rational:0.5", "rational:0.25"}) {
    const Fit result = fit_to(source, warp, 1e-8);
    const FactoredBrdf& model = result.model();
    double asymmetry = 0;
    std::vector<double> f(3), g(3);
    for (const auto& [wi, wo] : draw_pairs(kGgxHeldOut, 5, false)) {
      model.eval(wi, wo, f);
      model.eval(wo, wi, g);
      for (std::size_t c = 0; c < 3; ++c) asymmetry = std::max(asymmetry, std::abs(f[c] - g[c]));
    }
    fmt::print("| {} | 1e-8 | {:.4f} | {} | {:.2f} | {:.2g} | {} |\n", warp, mean_abs_log(ggx.ref(), model),
               result.report.summary()->iterations, result.report.seconds, model.smallest_factor(),
               asymmetry);
  }

  Plot plot{.title = "Smoothness: error of a fit to 500,000 samples, anisotropic GGX",
            .x_label = "smooth",
            .y_label = "mean |ln f - ln model|",
            .log_x = true,
            .log_y = true};
  PlotSeries all{.label = "all samples, all directions"},
      hole{.label = "samples within 20 degrees of h removed, error there"},
      rest{.label = "the same fit, all directions"};
  fmt::print(
      "\nSmoothness, and a fit without the samples whose half vector lies within 20 degrees of the normal "
      "([figure](figures/smooth-sweep.svg)):\n\n| smooth | all samples | hole: error inside | hole: all "
      "directions |\n"
      "|---|---|---|---|\n");
  constexpr int kFirstDecade = -11, kDecades = 9;
  std::array<std::array<double, 3>, kDecades> errors;
  for_each_chunk(kDecades, 1, [&](std::size_t k, std::size_t, std::size_t) {
    const double smooth = std::pow(10.0, kFirstDecade + static_cast<int>(k));
    const FactoredBrdf whole = fit_to(source, "rational:0.25", smooth).model();
    const FactoredBrdf with_hole = fit_to(holed, "rational:0.25", smooth).model();
    errors[k] = {mean_abs_log(ggx.ref(), whole), mean_abs_log(ggx.ref(), with_hole, cap),
                 mean_abs_log(ggx.ref(), with_hole)};
  });
  for (int k = 0; k < kDecades; ++k) {
    const auto [a, b, c] = errors[static_cast<std::size_t>(k)];
    fmt::print("| 1e{} | {:.4f} | {:.3f} | {:.3f} |\n", kFirstDecade + k, a, b, c);
    for (auto [series, y] : {std::pair{&all, a}, {&hole, b}, {&rest, c}}) {
      series->x.push_back(std::pow(10.0, kFirstDecade + k));
      series->y.push_back(y);
    }
  }
  plot.series = {all, hole, rest};
  save(plot, docs, "smooth-sweep");
}

// ---- The RGL materials

void report_rgl(const fs::path& data) {
  struct Row {
    const char* model;
    std::vector<std::string> tables;
  };
  const Row rows[] = {{"pqp", {"p=32", "q=64"}}, {"pqpr", {"p=32", "q=64", "r=32"}}};
  fmt::print(
      "\n## Eight RGL materials, symmetrized, log-linear fit only\n\n1-D tables, three channels, half "
      "floats, "
      "`fit` with its defaults.\n\n| material | model | table bytes | psnr | ssim | relative | log_cos |\n"
      "|---|---|---|---|---|---|---|\n");
  std::array<ErrorFigures, 2> mean;
  const std::vector<fs::path> files = files_in(data / "rgl");
  for (const fs::path& file : files) {
    const Source source = open_source(file.string(), {});
    const SymmetrizedBrdf reference(source.ref());
    const Scorer scorer(reference);
    for (std::size_t m = 0; m < 2; ++m) {
      const FactoredBrdf model =
          fit(source, {.form = OneLobe{.model = rows[m].model, .tables = rows[m].tables}, .score = false})
              .model();
      const ErrorFigures e = scorer.score(model);
      fmt::print("| {} | {} | {} | {:.2f} | {:.3f} | {:.3f} | {:.4f} |\n", file.stem().string(),
                 rows[m].model, model.table_bytes(), e.psnr, e.ssim, e.relative, e.log_cos);
      const double share = 1.0 / static_cast<double>(files.size());
      mean[m].psnr += share * e.psnr;
      mean[m].ssim += share * e.ssim;
      mean[m].relative += share * e.relative;
      mean[m].log_cos += share * e.log_cos;
    }
  }
  for (std::size_t m = 0; m < 2; ++m)
    fmt::print("| **mean** | {} | | {:.2f} | {:.3f} | {:.3f} | {:.4f} |\n", rows[m].model, mean[m].psnr,
               mean[m].ssim, mean[m].relative, mean[m].log_cos);
}

// ---- The paints of the original paper

void report_cornell(const fs::path& data) {
  fmt::print(
      "\n## The paints of the original paper, from their 1439 scattered directions\n\nFive-fold "
      "cross-validated "
      "`relative` error (fold = row mod 5), floor 1e-3, in brackets 1e-5. Smoothness of every fold is chosen "
      "by cross-validation among its training rows alone (`--smooth auto`), four reweightings; tables "
      "`p=48`, `q=64,rational:0.2`, `r=32`, `m=48,power:0.5`.\n\n| material | neighbours, pbrt-v2's space | "
      "neighbours, "
      "half/difference space | `p q p` | `p q p r(theta_d)` | `p q p r(theta_d) m(theta_m)` "
      "|\n|---|---|---|---|---|---|\n");
  for (const char* name : kPaints) {
    const Samples samples = read_paint(data, name);
    FoldErrors pbrt_errors, half_diff_errors;
    std::array<FoldErrors, 3> factored;
    for (std::size_t fold = 0; fold < kFolds; ++fold) {
      const auto [training, test] = split_fold(samples.size(), fold);
      const ScatteredBrdf pbrt(samples, training, SampleSpace::angles), half_diff(samples, training);
      const Source part = source_of(select(samples, training));
      std::array<std::optional<FactoredBrdf>, 3> models;
      for_each_chunk(models.size(), 1, [&](std::size_t m, std::size_t, std::size_t) {
        models[m] = fit_scattered(part, std::array{"pqp", "pqpr", kScatteredModel}[m]);
      });
      std::vector<double> f(3);
      for (const std::size_t i : test) {
        const auto [wi, wo] = samples.pairs[i];
        pbrt.eval(wi, wo, f);
        pbrt_errors.add(samples.at(i), f);
        half_diff.eval(wi, wo, f);
        half_diff_errors.add(samples.at(i), f);
        for (std::size_t m = 0; m < models.size(); ++m) {
          models[m]->eval(wi, wo, f);
          factored[m].add(samples.at(i), f);
        }
      }
    }
    fmt::print("| {} |", name);
    for (const FoldErrors& e : {pbrt_errors, half_diff_errors, factored[0], factored[1], factored[2]})
      fmt::print(" {:.3f} ({:.3f}) |", e.relative(0), e.relative(1));
    fmt::print("\n");
  }
}

// ---- A table of the MERL size

void report_merl() {
  const fs::path folder = fs::temp_directory_path() / fmt::format("burnish-report-{}", ::getpid());
  fs::create_directories(folder);
  const fs::path table = folder / "table.binary", model = folder / "model.exr";
  const AnalyticBrdf brdf = parse_analytic("cook_torrance");
  write_merl(table, brdf.ref());
  fmt::print(
      "\n## A table of the MERL size (90 x 90 x 180 entries, three channels, {:.0f} MB)\n\nFrom file to "
      "file, "
      "best of five; the floor is reading the file and taking every logarithm.\n\n| what | seconds "
      "|\n|---|---|\n",
      static_cast<double>(fs::file_size(table)) / 1e6);
  const auto best = [](const auto& run) {
    double seconds = 1e9;
    for (int i = 0; i < 5; ++i) {
      const Stopwatch watch;
      run();
      seconds = std::min(seconds, watch.seconds());
    }
    return seconds;
  };
  double checksum = 0;
  fmt::print("| read, and logarithms | {:.3f} |\n", best([&] {
               const MerlFile merl = parse_merl(read_file(table), {});
               for (const float v : merl.table.values)
                 if (!std::isnan(v)) checksum += std::log(v + 3e-5F);
             }));
  for (const bool disks : {false, true})
    fmt::print("| fit `pqp`, {} | {:.3f} |\n", disks ? "64 x 64 x 2" : "1-D, 32 and 64 nodes", best([&] {
                 OneLobe form;
                 if (disks) form.tables = {"p=64x64", "q=64x64"};
                 write_then_rename(
                     model, format_fit(fit(open_source(table.string(), {}), {.form = form, .score = false})));
               }));
  fs::remove_all(folder);
  if (!std::isfinite(checksum)) throw Error("report: expected finite logarithms");
}

}  // namespace
}  // namespace burnish

int main(int argc, char** argv) {
  if (argc != 2 || !std::filesystem::is_directory(argv[1])) {
    fmt::print(stderr, "usage: burnish_report DOCS_FOLDER\n");
    return 2;
  }
  try {
    fmt::print(
        "# Factorization: what was measured\n\nMade by `make report` on {}, {} threads. What the numbers "
        "mean and "
        "how they came about is in [factorization.md](factorization.md).\n\n",
        burnish::processor(), std::thread::hardware_concurrency());
    burnish::report_ggx(argv[1]);
    if (const char* data = std::getenv("BURNISH_DATA")) {
      burnish::report_rgl(data);
      burnish::report_cornell(data);
    } else {
      fmt::print("\nBURNISH_DATA is not set: no real materials.\n");
    }
    burnish::report_merl();
  } catch (const std::exception& error) {
    fmt::print(stderr, "burnish_report: {}\n", error.what());
    return 1;
  }
  return 0;
}
