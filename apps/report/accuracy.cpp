// burnish_accuracy DOCS_FOLDER [--quick | rgl | merl | others | paints]: how accurate models of a number of
// bytes are, beside others of the same size, printed as Markdown tables; figures go to DOCS_FOLDER/figures.
// Real materials need the folder of measurements in the environment variable BURNISH_DATA and are left out,
// with a message, without it. A section's name prints that one alone.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/error.h>
#include <burnish/fitting/baselines/baselines.h>
#include <burnish/fitting/fit.h>
#include <burnish/image/contact_sheet.h>
#include <burnish/image/png.h>
#include <burnish/io/open_source.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/scattered_brdf.h>

#include "accuracy_table.h"
#include "scattered.h"

namespace burnish {
namespace {

constexpr std::size_t kSheetBudget = 2700;

std::vector<Attempt> attempts(const std::vector<std::size_t>& budgets, bool isotropic, bool quick) {
  std::vector<Attempt> list{{"ours", budgets}, {"svd", budgets}};
  if (quick) return list;
  list.push_back({"nmf", budgets});
  list.push_back({"nd", {kSheetBudget}});
  if (isotropic) list.push_back({"dgf", {kSheetBudget}});
  for (const std::string_view method : baseline_methods())
    if (method.starts_with("analytic:")) list.push_back({method, {}});
  return list;
}

/// A material's pictures: one row of what it looks like, one of four times the difference from the reference.
void add_pictures(const Material& material, const std::vector<Score>& scores, ContactSheet& sheet) {
  const Image8 reference = picture(material.reference, material.scorer.exposure());
  const bool first = sheet.column_labels.empty();
  std::vector<Image8> shown{reference}, differences{Image8{}};
  if (first) sheet.column_labels.push_back("reference");
  for (const Score& score : scores) {
    if (score.budget > kSheetBudget) continue;
    if (first)
      sheet.column_labels.push_back(
          score.method.starts_with("analytic:")
              ? "analytic\n" + score.method.substr(9)
              : fmt::format("{}\n{} bytes", score.method, score.budget > 0 ? score.budget : score.bytes));
    Image8 difference = score.picture;
    const bool alpha = difference.channels == 4;
    for (std::size_t i = 0; i < difference.pixels.size(); ++i)
      if (!alpha || i % 4 < 3)
        difference.pixels[i] = static_cast<std::uint8_t>(
            std::min(255, 4 * std::abs(int{score.picture.pixels[i]} - int{reference.pixels[i]})));
    shown.push_back(score.picture);
    differences.push_back(std::move(difference));
  }
  sheet.row_labels.push_back(material.name);
  sheet.cells.push_back(std::move(shown));
  sheet.row_labels.push_back("4 x difference");
  sheet.cells.push_back(std::move(differences));
}

/// On how many materials ours beats another method at equal bytes.
void print_verdict(const std::vector<std::vector<Score>>& materials, std::string_view other,
                   const std::vector<std::size_t>& budgets) {
  fmt::print(
      "\nMaterials of {} on which ours is better than `{}` at the same budget:\n\n| bytes | psnr | ssim | "
      "relative "
      "| log_cos | rms_log | rms |\n|---|---|---|---|---|---|---|\n",
      materials.size(), other);
  for (const std::size_t budget : budgets) {
    std::array<int, 6> better{};
    for (const std::vector<Score>& scores : materials) {
      const auto find = [&](std::string_view method) -> const ErrorFigures& {
        for (const Score& s : scores)
          if (s.method == method && s.budget == budget) return s.errors;
        throw Error(fmt::format("no score of {} at {} bytes", method, budget));
      };
      const ErrorFigures &a = find("ours"), &b = find(other);
      better[0] += a.psnr > b.psnr;
      better[1] += a.ssim > b.ssim;
      better[2] += a.relative < b.relative;
      better[3] += a.log_cos < b.log_cos;
      better[4] += a.rms_log < b.rms_log;
      better[5] += a.rms < b.rms;
    }
    fmt::print("| {} | {} |\n", budget, fmt::join(better, " | "));
  }
}

void print_verdicts(const std::vector<std::vector<Score>>& materials, bool quick,
                    const std::vector<std::size_t>& budgets) {
  for (const std::string_view other : {"svd", "nmf"})
    if (other == "svd" || !quick) print_verdict(materials, other, budgets);
}

void print_rows(const std::deque<Material>& materials, const std::vector<std::vector<Score>>& scores) {
  print_head();
  for (std::size_t i = 0; i < materials.size(); ++i)
    for (const Score& score : scores[i]) print_row(materials[i].name, score);
}

void print_table(const std::deque<Material>& materials, const std::vector<std::vector<Score>>& scores) {
  Means means;
  for (const std::vector<Score>& row : scores) means.add(row);
  print_head();
  for (const Score& mean : means.means()) print_row("**mean**", mean);
  fmt::print("\nBy material:\n\n");
  print_rows(materials, scores);
}

/// Each method's mean of one figure over its bytes.
void plot_means(const std::vector<Score>& means, const fs::path& docs, const std::string& figure, bool log_y,
                double ErrorFigures::*value) {
  Plot plot{.title = "Mean " + figure + " over the eight RGL materials",
            .x_label = "bytes",
            .y_label = figure,
            .log_x = true,
            .log_y = log_y};
  for (const Score& mean : means) {
    auto series =
        std::ranges::find_if(plot.series, [&](const PlotSeries& s) { return s.label == mean.method; });
    if (series == plot.series.end()) {
      plot.series.push_back({.label = mean.method, .style = PlotStyle::line_and_points});
      series = plot.series.end() - 1;
    }
    series->x.push_back(static_cast<double>(mean.bytes));
    series->y.push_back(mean.errors.*value);
  }
  save(plot, docs, "accuracy-" + figure);
}

void report_rgl(const fs::path& data, const fs::path& docs, bool quick) {
  const std::vector<std::size_t> budgets =
      quick ? std::vector<std::size_t>{1350, 2700} : std::vector<std::size_t>{1350, 2700, 16'384, 65'536};
  fmt::print(
      "## {} RGL materials, symmetrized\n\n`ours`: `burnish fit --budget BYTES --format rgb9e5`. `network`: "
      "the "
      "published encoding of the same material, 675 weights, 1,350 bytes as half floats [Sztrajman2021]. The "
      "others: "
      "`burnish fit --method`, [baselines.md](baselines.md). ![spheres](figures/accuracy-spheres.png)\n\n",
      quick ? "One of eight" : "Eight");
  ContactSheet sheet{.title = "Light at 30 degrees; at most 2,700 bytes"};
  std::deque<Material> materials;
  std::vector<fs::path> files = files_in(data / "rgl");
  if (quick) files.resize(1);
  for (const fs::path& file : files) {
    Material& material = materials.emplace_back(file.stem().string(), file.string());
    material.attempts = attempts(budgets, material.reference.isotropic(), quick);
    material.shown_budget = kSheetBudget;
  }
  std::vector<std::vector<Score>> scores = run(materials);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Material& material = materials[i];
    const Source network =
        open_source(fmt::format("nbrdf:{}#{}", (data / "nbrdf/rgl.csv").string(), material.name), {});
    const SymmetrizedBrdf symmetric(network.ref());
    scores[i].insert(scores[i].begin(), run_network(material, symmetric));
    add_pictures(material, scores[i], sheet);
  }
  print_table(materials, scores);
  print_verdicts(scores, quick, budgets);
  write_then_rename(docs / "figures/accuracy-spheres.png", encode_png(compose(sheet)));

  Means means;
  for (const std::vector<Score>& row : scores) means.add(row);
  const std::vector<Score> all = means.means();
  plot_means(all, docs, "psnr", false, &ErrorFigures::psnr);
  plot_means(all, docs, "ssim", false, &ErrorFigures::ssim);
  plot_means(all, docs, "relative", true, &ErrorFigures::relative);
  plot_means(all, docs, "log_cos", true, &ErrorFigures::log_cos);
  plot_means(all, docs, "rms_log", true, &ErrorFigures::rms_log);
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
  constexpr std::size_t kEvery = 10;
  fmt::print(
      "\n## Stand-ins for the MERL materials\n\nThe published encodings of {}, evaluated, are the reference; "
      "at most 2,700 bytes.\n\n",
      quick ? "every tenth material" : "all 100 materials");
  std::deque<Material> materials;
  for (std::size_t i = 0; i < names.size(); i += quick ? kEvery : 1) {
    const std::string place = fmt::format("nbrdf:{}#{}", (data / "nbrdf/merl.csv").string(), names[i]);
    materials.emplace_back(names[i], place, FigureOptions{.count = 50'000, .image_size = 128}).attempts =
        attempts({kSheetBudget}, true, quick);
  }
  const std::vector<std::vector<Score>> scores = run(materials);
  Means means;
  for (const std::vector<Score>& row : scores) means.add(row);
  print_head();
  for (const Score& mean : means.means()) print_row(fmt::format("**mean of {}**", materials.size()), mean);
  const auto worst =
      std::ranges::max_element(scores, {}, [](const auto& row) { return row.front().errors.rms_log; });
  fmt::print("\nLargest rms_log of `ours`: {:.3f}, {}.\n", worst->front().errors.rms_log,
             materials[static_cast<std::size_t>(worst - scores.begin())].name);
  print_verdicts(scores, quick, {kSheetBudget});
  if (quick) return;
  fmt::print("\nBy material:\n\n");
  print_rows(materials, scores);
}

void report_others(const std::optional<fs::path>& data, const fs::path& docs, bool quick) {
  fmt::print(
      "\n## Other materials\n\nAn anisotropic GGX (alpha 0.1 and 0.3, f0 0.8, k_d 0.3), and measurements: a "
      "car paint "
      "(MBSDF), a shade fabric (Klems), a black anodized aluminium (Zemax).{}\n\n",
      quick ? "" : " ![spheres](figures/accuracy-others.png)");
  const std::vector<std::size_t> budgets =
      quick ? std::vector<std::size_t>{2700} : std::vector<std::size_t>{2700, 16'384, 65'536};
  std::vector<std::pair<std::string, std::string>> sources{
      {"anisotropic GGX", "ggx:alpha_x=0.1,alpha_y=0.3,f0=0.8,kd=0.3"}};
  if (data && !quick)
    for (const char* file :
         {"mbsdf/carpaint_blue.mbsdf", "klems/mecho_shade_fabric_aniso.xml", "zemax/AnoBlackEC1onAlum.bsdf"})
      sources.emplace_back((*data / file).stem().string(), (*data / file).string());
  ContactSheet sheet{.title = "Light at 30 degrees; at most 2,700 bytes"};
  std::deque<Material> materials;
  for (const auto& [name, place] : sources) {
    Material& material = materials.emplace_back(name, place);
    material.attempts = attempts(budgets, material.reference.isotropic(), quick);
    material.shown_budget = kSheetBudget;
  }
  const std::vector<std::vector<Score>> scores = run(materials);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    std::vector<Score> shown = scores[i];
    std::erase_if(shown, [](const Score& s) { return s.method == "dgf"; });  // a column for every material
    add_pictures(materials[i], shown, sheet);
  }
  print_rows(materials, scores);
  print_verdicts(scores, quick, budgets);
  if (!quick) write_then_rename(docs / "figures/accuracy-others.png", encode_png(compose(sheet)));
}

void report_paints(const fs::path& data) {
  fmt::print(
      "\n## The paints of the original paper, from their 1439 scattered directions\n\nFive-fold "
      "cross-validated "
      "(fold = row mod 5), `relative` and `rms_log`. `ours` is one lobe, `{}`, its smoothness chosen among "
      "the "
      "training rows of each fold; `svd`, `nd` and `nmf` resample their neighbours' values in "
      "half/difference space. "
      "More models, and another floor: [results.md](results.md).\n\n| method |",
      kScatteredModel);
  for (const char* name : kPaints) fmt::print(" {} |", name);
  fmt::print("\n|---|---|---|---|\n");
  std::vector<std::string> methods{"ours"};
  for (const std::string_view method : baseline_methods()) methods.emplace_back(method);
  std::vector<std::array<FoldErrors, kPaints.size()>> errors(methods.size());
  for (std::size_t paint = 0; paint < kPaints.size(); ++paint) {
    fmt::print(stderr, "accuracy: {}\n", kPaints[paint]);
    const Samples samples = read_paint(data, kPaints[paint]);
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
          errors[m][paint].add(samples.at(i), f);
        }
      });
    }
  }
  for (std::size_t m = 0; m < methods.size(); ++m) {
    fmt::print("| {} |", methods[m]);
    for (const FoldErrors& e : errors[m]) fmt::print(" {:.3f}, {:.3f} |", e.relative(0), e.rms_log(0));
    fmt::print("\n");
  }
}

}  // namespace
}  // namespace burnish

int main(int argc, char** argv) {
  const std::string_view option = argc == 3 ? argv[2] : "";
  const bool quick = option == "--quick";
  const std::array<std::string_view, 4> sections{"rgl", "merl", "others", "paints"};
  if (argc < 2 || argc > 3 || !std::filesystem::is_directory(argv[1]) ||
      (argc == 3 && !quick && std::ranges::find(sections, option) == sections.end())) {
    fmt::print(stderr, "usage: burnish_accuracy DOCS_FOLDER [--quick | {}]\n", fmt::join(sections, " | "));
    return 2;
  }
  const auto wanted = [&](std::string_view section) { return argc == 2 || quick || option == section; };
  try {
    const burnish::Stopwatch watch;
    if (argc == 2 || quick)
      fmt::print(
          "# Accuracy: what a number of bytes buys\n\nMade by `make report` on {}, {} threads. The error "
          "figures are "
          "defined in [notation.md](notation.md); all are of the models as stored, on directions that were "
          "not "
          "fitted. `rms` is absolute, in 1/sr. Table reads and multiplies are those of one evaluation, all "
          "channels. "
          "How the models are fitted: [lobes.md](lobes.md). Seconds of other methods than `ours` are of fits "
          "that ran side by side.\n\n",
          burnish::processor(), std::thread::hardware_concurrency());
    const char* data = std::getenv("BURNISH_DATA");
    if (!data) fmt::print("BURNISH_DATA is not set: no real materials.\n");
    burnish::fs::create_directories(burnish::fs::path(argv[1]) / "figures");
    if (data && wanted("rgl")) burnish::report_rgl(data, argv[1], quick);
    if (data && wanted("merl")) burnish::report_merl(data, quick);
    if (wanted("others"))
      burnish::report_others(data ? std::optional<burnish::fs::path>(data) : std::nullopt, argv[1], quick);
    if (data && !quick && wanted("paints")) burnish::report_paints(data);
    fmt::print("\nMade in {:.0f} s.\n", watch.seconds());
  } catch (const std::exception& error) {
    fmt::print(stderr, "burnish_accuracy: {}\n", error.what());
    return 1;
  }
  return 0;
}
