// SPDX-License-Identifier: Apache-2.0
// Compares the accuracy of models with that of other methods at the same number of bytes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include <burnish/fitting/baselines/baselines.h>
#include <burnish/fitting/fit.h>
#include <burnish/image/contact_sheet.h>
#include <burnish/image/png.h>
#include <burnish/io/convert.h>
#include <burnish/io/open_source.h>
#include <burnish/math/parallel.h>
#include <burnish/metrics/measurement_quality.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/scattered_brdf.h>

#include "accuracy_scores.h"
#include "report.h"
#include "scattered.h"

namespace burnish::reports {

namespace {

constexpr std::size_t kSheetBudget = 2700, kMiddleBudget = 16'384;

std::vector<Attempt> attempts(const std::vector<std::size_t>& budgets, bool isotropic, bool quick) {
  std::vector<Attempt> list{{"ours", budgets}, {"svd", budgets}};
  if (quick) return list;
  std::vector<std::size_t> large = budgets;
  std::erase_if(large, [](std::size_t bytes) { return bytes < kMiddleBudget; });
  if (!large.empty()) {
    list.push_back({"ours, 2 fetches", large});
    list.push_back({"ours, 4 fetches", {kMiddleBudget}});
    if (!isotropic) list.push_back({"ours, 6 fetches", {large.back()}});
  }
  list.push_back({"nmf", budgets});
  list.push_back({"nd", {kSheetBudget}});
  if (isotropic) list.push_back({"dgf", {kSheetBudget}});
  for (const std::string_view method : baseline_methods())
    if (method.starts_with("analytic:")) list.push_back({method, {}});
  return list;
}

// Returns the label above a score's pictures.
std::string label_of(const Score& score) {
  if (score.method.starts_with("analytic:")) return "analytic\n" + score.method.substr(9);
  return fmt::format("{}\n{} bytes", score.method, score.budget > 0 ? score.budget : score.bytes);
}

// Returns four times |shown - reference|. Alpha stays.
Image8 difference_of(const Image8& shown, const Image8& reference) {
  Image8 difference = shown;
  const bool alpha = shown.channels == 4;
  for (std::size_t i = 0; i < shown.pixels.size(); ++i)
    if (!alpha || i % 4 < 3)
      difference.pixels[i] = static_cast<std::uint8_t>(
          std::min(255, 4 * std::abs(int{shown.pixels[i]} - int{reference.pixels[i]})));
  return difference;
}

// Adds two rows of a material's pictures: the appearance, and four times the difference from the reference.
void add_pictures(const Material& material, const std::vector<Score>& scores, ContactSheet& sheet) {
  const Image8 reference = picture(material.reference, material.scorer.exposure());
  const bool first = sheet.column_labels.empty();
  std::vector<Image8> shown{reference}, differences{Image8{}};
  if (first) sheet.column_labels.push_back("reference");
  for (const Score& score : scores) {
    if (score.budget > kSheetBudget) continue;
    if (first) sheet.column_labels.push_back(label_of(score));
    shown.push_back(score.picture);
    differences.push_back(difference_of(score.picture, reference));
  }
  sheet.row_labels.push_back(material.name);
  sheet.cells.push_back(std::move(shown));
  sheet.row_labels.push_back("4 x difference");
  sheet.cells.push_back(std::move(differences));
}

// Plots each method's mean of one figure over its bytes. The measurements' own score is a line across all bytes.
Plot plot_of(const std::vector<MeanScore>& means, const std::string& figure, bool log_y,
             double ErrorFigures::*value) {
  Plot plot{.title = "Mean " + figure + " over the eight RGL materials",
            .x_label = "bytes",
            .y_label = figure,
            .log_x = true,
            .log_y = log_y};
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const auto& [mean, materials] : means) {
    if (mean.method == kMeasurement) continue;
    least = std::min(least, static_cast<double>(mean.bytes));
    most = std::max(most, static_cast<double>(mean.bytes));
    auto series =
        std::ranges::find_if(plot.series, [&](const PlotSeries& s) { return s.label == mean.method; });
    if (series == plot.series.end()) {
      plot.series.push_back({.label = mean.method, .style = PlotStyle::line_and_points});
      series = plot.series.end() - 1;
    }
    series->x.push_back(static_cast<double>(mean.bytes));
    series->y.push_back(mean.errors.*value);
  }
  for (const auto& [mean, materials] : means)
    if (mean.method == kMeasurement)
      plot.series.push_back({.label = mean.method,
                             .x = {least, most},
                             .y = {mean.errors.*value, mean.errors.*value},
                             .style = PlotStyle::dashed});
  return plot;
}

void plot_means(const Page& page, const std::vector<MeanScore>& means) {
  page.write_plot("accuracy-psnr", plot_of(means, "psnr", false, &ErrorFigures::psnr));
  page.write_plot("accuracy-ssim", plot_of(means, "ssim", false, &ErrorFigures::ssim));
  page.write_plot("accuracy-relative", plot_of(means, "relative", true, &ErrorFigures::relative));
  page.write_plot("accuracy-log_cos", plot_of(means, "log_cos", true, &ErrorFigures::log_cos));
  page.write_plot("accuracy-rms_log", plot_of(means, "rms_log", true, &ErrorFigures::rms_log));
}

// Adds the measurement's own score, from its values with directions exchanged, where these differ.
void add_measurement(const Material& material, std::vector<Score>& scores) {
  if (const auto itself = exchanged_figures(material.scorer, material.source.ref()))
    scores.push_back({.method = std::string(kMeasurement), .errors = *itself, .picture = {}});
}

void report_rgl(Page& page, const fs::path& data) {
  const bool quick = page.options().quick;
  const std::vector<std::size_t> budgets =
      quick ? std::vector<std::size_t>{2700} : std::vector<std::size_t>{1350, 2700, 16'384, 65'536};
  std::vector<fs::path> files = files_in(data / "rgl");
  if (quick) files.resize(1);
  std::deque<Material> materials;
  for (const fs::path& file : files) {
    Material& material = materials.emplace_back(file.stem().string(), open_source(file.string(), {}));
    material.attempts = attempts(budgets, material.reference.isotropic(), quick);
    material.shown_budget = kSheetBudget;
  }
  std::vector<std::vector<Score>> scores = run(materials);

  // Published models of the same material come first.
  ContactSheet sheet{.title = "Light at 30 degrees; at most 2,700 bytes"};
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Material& material = materials[i];
    const auto published = [&](std::string_view method, std::string_view spec, const fs::path& place) {
      const Source model = open_source(fmt::format("{}:{}#{}", spec, place.string(), material.name), {});
      return run_published(material, method, model);
    };
    scores[i].insert(scores[i].begin(), {published("network", "nbrdf", data / "nbrdf/rgl.csv"),
                                         published("np", "np", data / "np")});
    add_pictures(material, scores[i], sheet);
    add_measurement(material, scores[i]);
  }

  const std::vector<MeanScore> means = means_of(scores);
  page["rgl"] = table_of(means).markdown();
  page["rgl_materials"] = std::to_string(materials.size());
  page.write_rows("rgl", table_of(materials, scores));
  page.write_figure("accuracy-spheres.png", encode_png(compose(sheet)));
  plot_means(page, means);
}

// Returns a table of `cells` cells along theta_h, decoded from a published code of the material. 90 is the size of
// MERL.
Source merl_stand_in(const fs::path& codes, const std::string& name, int cells) {
  tell(fmt::format("accuracy: {}, decoded", name));
  const Converted table =
      convert(open_source(fmt::format("np:{}#{}", codes.string(), name), {}), "merl", {.cells = cells});
  const auto* bytes = reinterpret_cast<const std::byte*>(table.bytes.data());
  return parse_source({name, {bytes, bytes + table.bytes.size()}}, {});
}

void report_merl(Page& page, const fs::path& data) {
  const bool quick = page.options().quick;
  std::vector<std::string> names = row_names(data / "np/codes.csv");
  std::erase_if(names,
                [](const std::string& name) { return name.ends_with("_rgb"); });  // are of the RGL database
  const std::size_t every = quick ? 100 : 8;  // a table of MERL's size takes some 20 s to decode
  const int cells = quick ? 45 : 90;
  std::deque<Material> materials;
  for (std::size_t i = 0; i < names.size(); i += every) {
    materials
        .emplace_back(names[i], merl_stand_in(data / "np", names[i], cells),
                      FigureOptions{.count = 50'000, .image_size = 128})
        .attempts = attempts({kSheetBudget}, true, quick);
    if (!quick) materials.back().attempts.push_back({"ours, 2 fetches", {kMiddleBudget}});
  }
  const std::vector<std::vector<Score>> scores = run(materials);
  const auto worst =
      std::ranges::max_element(scores, {}, [](const auto& row) { return row.front().errors.rms_log; });
  page["merl"] = table_of(means_of(scores)).markdown();
  page["merl_materials"] = std::to_string(materials.size());
  page["merl_worst"] = fmt::format("{:.3f}, {}", worst->front().errors.rms_log,
                                   materials[static_cast<std::size_t>(worst - scores.begin())].name);
  page.write_rows("merl", table_of(materials, scores));
}

void report_others(Page& page) {
  const std::optional<fs::path>& data = page.options().data;
  const bool quick = page.options().quick;
  const std::vector<std::size_t> budgets =
      quick ? std::vector<std::size_t>{2700} : std::vector<std::size_t>{2700, 16'384, 65'536};
  std::vector<std::pair<std::string, std::string>> sources{
      {"anisotropic GGX", "ggx:alpha_x=0.1,alpha_y=0.3,f0=0.8,kd=0.3"}};
  if (data && !quick)
    for (const char* file :
         {"mbsdf/carpaint_blue.mbsdf", "klems/mecho_shade_fabric_aniso.xml", "zemax/AnoBlackEC1onAlum.bsdf"})
      sources.emplace_back((*data / file).stem().string(), (*data / file).string());
  std::deque<Material> materials;
  for (const auto& [name, place] : sources) {
    Material& material = materials.emplace_back(name, open_source(place, {}));
    material.attempts = attempts(budgets, material.reference.isotropic(), quick);
    material.shown_budget = kSheetBudget;
  }
  std::vector<std::vector<Score>> scores = run(materials);

  ContactSheet sheet{.title = "Light at 30 degrees; at most 2,700 bytes"};
  for (std::size_t i = 0; i < materials.size(); ++i) {
    std::vector<Score> shown = scores[i];
    std::erase_if(shown, [](const Score& s) { return s.method == "dgf"; });  // not tried on all materials
    add_pictures(materials[i], shown, sheet);
    add_measurement(materials[i], scores[i]);
  }
  page["others"] = table_of(means_of(scores)).markdown();
  page.write_rows("others", table_of(materials, scores));
  if (!quick) page.write_figure("accuracy-others.png", encode_png(compose(sheet)));
}

// Returns each method's errors, ours first, over the rows of one paint that its fits have not seen.
std::vector<FoldErrors> paint_errors(const Samples& samples, const std::vector<std::string>& methods) {
  std::vector<FoldErrors> errors(methods.size());
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const auto [training, test] = split_fold(samples.size(), fold);
    const Source source = source_of(select(samples, training));
    for_each_chunk(methods.size(), 1, [&, &test = test](std::size_t m, std::size_t, std::size_t) {
      std::optional<FactoredBrdf> ours;
      std::optional<Fit> other;
      if (m == 0)
        ours = fit_scattered(source, kScatteredModel);
      else
        other = fit(source, {.form = BaselineMethod{.method = methods[m]}, .score = false});
      const BrdfRef model = ours ? BrdfRef(*ours) : other->ref();
      std::array<double, 3> f;
      for (const std::size_t i : test) {
        model.eval(samples.pairs[i].wi, samples.pairs[i].wo, f);
        errors[m].add(samples.at(i), f);
      }
    });
  }
  return errors;
}

void report_paints(Page& page, const fs::path& data) {
  std::vector<std::string> methods{"ours"};
  for (const std::string_view method : baseline_methods()) methods.emplace_back(method);
  Table rows({"paint", "method", "relative", "rms_log"});
  std::vector<std::array<double, 2>> means(methods.size());
  for (const char* paint : kPaints) {
    tell(fmt::format("accuracy: {}", paint));
    const std::vector<FoldErrors> errors = paint_errors(read_paint(data, paint), methods);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const double relative = errors[m].relative(0), rms_log = errors[m].rms_log(0);
      rows.add({paint, methods[m], fmt::format("{:.3f}", relative), fmt::format("{:.3f}", rms_log)});
      means[m][0] += relative / kPaints.size();
      means[m][1] += rms_log / kPaints.size();
    }
  }
  Table table({"method", "relative", "rms_log"});
  for (std::size_t m = 0; m < methods.size(); ++m)
    table.add({methods[m], fmt::format("{:.3f}", means[m][0]), fmt::format("{:.3f}", means[m][1])});
  page["paints"] = table.markdown();
  page["paints_model"] = kScatteredModel;
  page.write_rows("paints", rows);
}

}  // namespace

void report_accuracy(const ReportOptions& options) {
  Page page(options, "accuracy");
  if (options.data && options.wants("rgl")) report_rgl(page, *options.data);
  if (options.data && options.wants("merl")) report_merl(page, *options.data);
  if (options.wants("others")) report_others(page);
  if (options.data && !options.quick && options.wants("paints")) report_paints(page, *options.data);
  page.write();
}

}  // namespace burnish::reports
