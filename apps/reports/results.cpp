// SPDX-License-Identifier: Apache-2.0
// Measures the fit of one lobe: scattered samples of an anisotropic GGX, measurements, and a table of the MERL size.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/fitting/fit_file.h>
#include <burnish/io/merl.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/scattered_brdf.h>

#include "report.h"
#include "scattered.h"

namespace burnish::reports {

namespace {

// ---- Scattered samples of an anisotropic GGX

constexpr std::size_t kHeldOut = 100'000;

// Returns the mean |ln f - ln model| over held-out pairs. With `cap` only pairs with h within `cap` radians of the
// normal count.
double mean_abs_log(BrdfRef truth, const FactoredBrdf& model, std::optional<double> cap = {}) {
  std::vector<double> f(3), g(3);
  double sum = 0;
  std::size_t count = 0;
  for (const auto& [wi, wo] : draw_pairs(kHeldOut, 99, false)) {
    if (cap && theta_of(half_vector(wi, wo)) > *cap) continue;
    truth.eval(wi, wo, f);
    model.eval(wi, wo, g);
    for (std::size_t c = 0; c < 3; ++c) sum += std::abs(std::log(g[c] / f[c]));
    count += 3;
  }
  return sum / static_cast<double>(count);
}

// Returns the largest |f(wi, wo) - f(wo, wi)|.
double asymmetry_of(const FactoredBrdf& model) {
  double asymmetry = 0;
  std::vector<double> f(3), g(3);
  for (const auto& [wi, wo] : draw_pairs(kHeldOut, 5, false)) {
    model.eval(wi, wo, f);
    model.eval(wo, wi, g);
    for (std::size_t c = 0; c < 3; ++c) asymmetry = std::max(asymmetry, std::abs(f[c] - g[c]));
  }
  return asymmetry;
}

Samples without_cap(const Samples& samples, double cap) {
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (theta_of(half_vector(samples.pairs[i].wi, samples.pairs[i].wo)) >= cap) left.push_back(i);
  return select(samples, left);
}

Fit fit_disks(const Source& source, const std::string& warp, double smooth) {
  return fit(source, {.form = OneLobe{.model = "pqp",
                                      .tables = {"p=64x64", "q=64x64," + warp},
                                      .how = {.reweightings = 0, .floor = 1e-6}},
                      .smooth = smooth,
                      .score = false});
}

Table warps_table(BrdfRef truth, const Source& source) {
  Table table({"q's radial warp", "smooth", "mean abs dlog f", "iterations", "seconds", "smallest factor",
               "reciprocity error"});
  for (const char* warp : {"identity", "rational:0.5", "rational:0.25"}) {
    const Fit made = fit_disks(source, warp, 1e-8);
    const FactoredBrdf& model = made.model();
    table.add({warp, "1e-8", fmt::format("{:.4f}", mean_abs_log(truth, model)),
               fmt::format("{}", made.report.summary()->iterations),
               fmt::format("{:.2f}", made.report.seconds), fmt::format("{:.2g}", model.smallest_factor()),
               fmt::format("{}", asymmetry_of(model))});
  }
  return table;
}

// Reports fits over decades of `smooth`, to all samples and to those outside a cap around the normal.
void report_smoothness(Page& page, BrdfRef truth, const Samples& samples) {
  constexpr int kFirstDecade = -11;
  const std::size_t decades = page.options().quick ? 2 : 9;
  const double cap = radians(20);
  const Source source = source_of(samples), holed = source_of(without_cap(samples, cap));
  std::vector<std::array<double, 3>> errors(decades);
  for_each_chunk(decades, 1, [&](std::size_t k, std::size_t, std::size_t) {
    const double smooth = std::pow(10.0, kFirstDecade + static_cast<int>(k));
    const FactoredBrdf whole = fit_disks(source, "rational:0.25", smooth).model();
    const FactoredBrdf with_hole = fit_disks(holed, "rational:0.25", smooth).model();
    errors[k] = {mean_abs_log(truth, whole), mean_abs_log(truth, with_hole, cap),
                 mean_abs_log(truth, with_hole)};
  });

  Table table({"smooth", "all samples", "hole: error inside", "hole: all directions"});
  Plot plot{.title = "Smoothness: error of a fit to 500,000 samples, anisotropic GGX",
            .x_label = "smooth",
            .y_label = "mean |ln f - ln model|",
            .log_x = true,
            .log_y = true};
  plot.series = {{.label = "all samples, all directions"},
                 {.label = "samples within 20 degrees of h removed, error there"},
                 {.label = "the same fit, all directions"}};
  for (std::size_t k = 0; k < decades; ++k) {
    const int decade = kFirstDecade + static_cast<int>(k);
    table.add({fmt::format("1e{}", decade), fmt::format("{:.4f}", errors[k][0]),
               fmt::format("{:.3f}", errors[k][1]), fmt::format("{:.3f}", errors[k][2])});
    for (std::size_t i = 0; i < errors[k].size(); ++i) {
      plot.series[i].x.push_back(std::pow(10.0, decade));
      plot.series[i].y.push_back(errors[k][i]);
    }
  }
  page["smoothness"] = table.markdown();
  page.write_plot("smooth-sweep", plot);
}

void report_ggx(Page& page) {
  const std::size_t count = page.options().quick ? 50'000 : 500'000;
  const AnalyticBrdf ggx = parse_analytic("ggx:alpha_x=0.1,alpha_y=0.3,f0=0.8,kd=0");
  const Samples samples = measure(ggx.ref(), {.count = count, .noise = 0, .seed = 7});
  page["samples"] = std::to_string(count);
  page["held_out"] = std::to_string(kHeldOut);
  page["warps"] = warps_table(ggx.ref(), source_of(samples)).markdown();
  report_smoothness(page, ggx.ref(), samples);
}

// ---- The RGL materials

void report_rgl(Page& page, const fs::path& data) {
  struct Kind {
    const char* model;
    std::vector<std::string> tables;
  };
  const std::array kinds{Kind{"pqp", {"p=32", "q=64"}}, Kind{"pqpr", {"p=32", "q=64", "r=32"}}};
  const std::vector<std::string> figures{"table bytes", "psnr", "ssim", "relative", "log_cos"};
  Table rows(joined({"material", "model"}, figures));
  std::array<ErrorFigures, kinds.size()> mean;
  std::array<std::size_t, kinds.size()> bytes{};
  std::vector<fs::path> files = files_in(data / "rgl");
  if (page.options().quick) files.resize(1);
  const auto figures_of = [](std::size_t table_bytes, const ErrorFigures& e) {
    return std::array{std::to_string(table_bytes), fmt::format("{:.2f}", e.psnr),
                      fmt::format("{:.3f}", e.ssim), fmt::format("{:.3f}", e.relative),
                      fmt::format("{:.4f}", e.log_cos)};
  };
  for (const fs::path& file : files) {
    tell("results: " + file.stem().string());
    const Source source = open_source(file.string(), {});
    const SymmetrizedBrdf reference(source.ref());
    const Scorer scorer(reference);
    for (std::size_t m = 0; m < kinds.size(); ++m) {
      const OneLobe form{.model = kinds[m].model, .tables = kinds[m].tables};
      const FactoredBrdf model = fit(source, {.form = form, .score = false}).model();
      const ErrorFigures e = scorer.score(model);
      rows.add(joined({file.stem().string(), kinds[m].model}, figures_of(model.table_bytes(), e)));
      const double share = 1.0 / static_cast<double>(files.size());
      bytes[m] = model.table_bytes();
      mean[m].psnr += share * e.psnr;
      mean[m].ssim += share * e.ssim;
      mean[m].relative += share * e.relative;
      mean[m].log_cos += share * e.log_cos;
    }
  }
  Table means(joined({"model"}, figures));
  for (std::size_t m = 0; m < kinds.size(); ++m)
    means.add(joined({kinds[m].model}, figures_of(bytes[m], mean[m])));
  page["rgl"] = means.markdown();
  page["rgl_materials"] = std::to_string(files.size());
  page.write_rows("rgl", rows);
}

// ---- The paints of the original paper

struct PaintModel {
  const char *name, *expression;  // expression null: resampled neighbours
};
constexpr std::array kPaintModels{PaintModel{"neighbours, pbrt-v2's space", nullptr},
                                  PaintModel{"neighbours, half/difference space", nullptr},
                                  PaintModel{"`p q p`", "pqp"}, PaintModel{"`p q p r(theta_d)`", "pqpr"},
                                  PaintModel{"`p q p r(theta_d) m(theta_m)`", kScatteredModel}};

std::array<FoldErrors, kPaintModels.size()> paint_errors(const Samples& samples) {
  std::array<FoldErrors, kPaintModels.size()> errors;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const auto [training, test] = split_fold(samples.size(), fold);
    const ScatteredBrdf pbrt(samples, training, SampleRule::mean_in_angles),
        half_diff(samples, training, SampleRule::mean_in_half_difference);
    const Source part = source_of(select(samples, training));
    std::array<std::optional<FactoredBrdf>, kPaintModels.size()> models;
    for_each_chunk(models.size(), 1, [&](std::size_t m, std::size_t, std::size_t) {
      if (const char* expression = kPaintModels[m].expression) models[m] = fit_scattered(part, expression);
    });
    std::vector<double> f(3);
    for (std::size_t m = 0; m < models.size(); ++m) {
      const BrdfRef model = models[m] ? BrdfRef(*models[m]) : m == 0 ? BrdfRef(pbrt) : BrdfRef(half_diff);
      for (const std::size_t i : test) {
        model.eval(samples.pairs[i].wi, samples.pairs[i].wo, f);
        errors[m].add(samples.at(i), f);
      }
    }
  }
  return errors;
}

void report_paints(Page& page, const fs::path& data) {
  Table rows({"paint", "model", "relative, floor 1e-3", "relative, floor 1e-5"});
  std::array<std::array<double, 2>, kPaintModels.size()> mean{};
  for (const char* paint : kPaints) {
    tell(fmt::format("results: {}", paint));
    const auto errors = paint_errors(read_paint(data, paint));
    for (std::size_t m = 0; m < errors.size(); ++m) {
      const std::array relative{errors[m].relative(0), errors[m].relative(1)};
      rows.add({paint, kPaintModels[m].name, fmt::format("{:.3f}", relative[0]),
                fmt::format("{:.3f}", relative[1])});
      for (std::size_t k = 0; k < 2; ++k) mean[m][k] += relative[k] / kPaints.size();
    }
  }
  Table means({"model", "relative, floor 1e-3", "relative, floor 1e-5"});
  for (std::size_t m = 0; m < mean.size(); ++m)
    means.add({kPaintModels[m].name, fmt::format("{:.3f}", mean[m][0]), fmt::format("{:.3f}", mean[m][1])});
  page["paints"] = means.markdown();
  page.write_rows("paints", rows);
}

// ---- A table of the MERL size

template <class Run>
std::string best_seconds(int repetitions, const Run& run) {
  double seconds = 1e9;
  for (int i = 0; i < repetitions; ++i) {
    const Stopwatch watch;
    run();
    seconds = std::min(seconds, watch.seconds());
  }
  return fmt::format("{:.3f}", seconds);
}

void report_merl(Page& page) {
  const int repetitions = page.options().quick ? 1 : 5;
  const fs::path folder = fs::temp_directory_path() / fmt::format("burnish-report-{}", ::getpid());
  fs::create_directories(folder);
  const fs::path table = folder / "table.binary", model = folder / "model.exr";
  write_merl(table, parse_analytic("cook_torrance").ref());
  page["merl_megabytes"] = fmt::format("{:.0f}", static_cast<double>(fs::file_size(table)) / 1e6);

  Table times({"what", "seconds"});
  double checksum = 0;
  times.add({"read, and logarithms", best_seconds(repetitions, [&] {
               const MerlFile merl = parse_merl(read_file(table));
               for (const float v : merl.table.values)
                 if (!std::isnan(v)) checksum += std::log(v + 3e-5F);
             })});
  if (!std::isfinite(checksum)) throw Error("report: expected finite logarithms");
  for (const bool disks : {false, true})
    times.add({fmt::format("fit `pqp`, {}", disks ? "64 x 64 x 2" : "1-D, 32 and 64 nodes"),
               best_seconds(repetitions, [&] {
                 OneLobe form;
                 if (disks) form.tables = {"p=64x64", "q=64x64"};
                 write_then_rename(
                     model, format_fit(fit(open_source(table.string(), {}), {.form = form, .score = false})));
               })});
  page["merl"] = times.markdown();
  fs::remove_all(folder);
}

}  // namespace

void report_results(const ReportOptions& options) {
  Page page(options, "results");
  report_ggx(page);
  if (options.data) report_rgl(page, *options.data);
  if (options.data && !options.quick) report_paints(page, *options.data);
  report_merl(page);
  page.write();
}

}  // namespace burnish::reports
