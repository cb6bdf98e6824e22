// burnish_sampling_report DOCS_FOLDER: compares ways of drawing directions on the RGL materials of the folder
// of measurements in the environment variable BURNISH_DATA and prints Markdown tables; figures go to
// DOCS_FOLDER/figures.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/fitting/fit.h>
#include <burnish/image/contact_sheet.h>
#include <burnish/image/png.h>
#include <burnish/image/svg_plot.h>
#include <burnish/io/open_source.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/reflectance/half_vector_quadrature.h>
#include <burnish/render/light/environment_light.h>

#include "drawers.h"

namespace fs = std::filesystem;

namespace burnish {
namespace {

// Of this process, which others cannot slow down as they do the clock on the wall.
double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

struct Material {
  std::string name;
  RglTable table;
  FactoredBrdf model;
};

constexpr std::size_t kModelBytes = 2700;

std::vector<Material> load_materials(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::ranges::sort(files);
  std::vector<Material> materials;
  for (const fs::path& file : files) {
    Source source = open_source(file.string(), {});
    FactoredBrdf model = fit(source, {.form = Budget{.bytes = kModelBytes}, .score = false}).model();
    materials.push_back({file.stem().string(), std::get<RglTable>(std::move(source.brdf)), std::move(model)});
  }
  return materials;
}

// A table's first line: the ways, and `last` unless it is empty.
void print_header(const char* first, const std::string& last = {}) {
  fmt::print("| {} |", first);
  for (const char* way : kWayNames) fmt::print(" {} |", way);
  if (!last.empty()) fmt::print(" {} |", last);
  fmt::print("\n|---|");
  for (std::size_t i = 0; i < kWays + !last.empty(); ++i) fmt::print("---|");
  fmt::print("\n");
}

// ---- Weights

struct Weights {
  double second_moment = 0, largest = 0, lost = 0;  // relative to the mean, its square; share
};

Weights weights_of(BrdfRef brdf, SamplerRef sampler, Vec3 wo) {
  constexpr int kDraws = 50'000;
  Pcg32 random(3);
  std::vector<double> f(static_cast<std::size_t>(brdf.channels()));
  double sum = 0, squares = 0, largest = 0, lost = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.uniform();
    const DrawnDirection drawn = sampler.sample_wi(wo, {x, random.uniform()});
    const bool useful = drawn.pdf > 0 && drawn.wi.z > 0;
    const double weight = useful ? reflected_size(brdf, drawn.wi, wo, f) / drawn.pdf : 0;
    sum += weight / kDraws;
    squares += weight * weight / kDraws;
    largest = std::max(largest, weight);
    lost += useful ? 0 : 1.0 / kDraws;
  }
  return {squares / (sum * sum), largest / sum, lost};
}

void report_weights(const std::vector<Material>& materials) {
  fmt::print(
      "## Weights\n\nThe weight of a draw is f cos(theta_i) / pdf, f the root mean square of the channels. "
      "Mean over "
      "the materials' models: second moment of the weights over their squared mean (1: drawn in "
      "proportion), "
      "in brackets the share of draws below the horizon; last, the largest weight of all materials over its "
      "mean. "
      "50,000 draws each.\n\n");
  print_header("theta_o");
  Weights worst[kWays];
  for (const int theta_deg : {0, 20, 40, 60, 75, 85, 88, 89}) {
    Weights mean[kWays];
    for (const Material& m : materials) {
      const Drawers drawers(m.model, m.table);
      for (std::size_t k = 0; k < kWays; ++k) {
        const Weights w = weights_of(m.model, drawers.all()[k], spherical_direction(radians(theta_deg), 1));
        const auto share = 1 / static_cast<double>(materials.size());
        mean[k].second_moment += share * w.second_moment;
        mean[k].lost += share * w.lost;
        worst[k].largest = std::max(worst[k].largest, w.largest);
      }
    }
    fmt::print("| {}° |", theta_deg);
    for (const Weights& w : mean) fmt::print(" {:.3f} ({:.1f} %) |", w.second_moment, 100 * w.lost);
    fmt::print("\n");
  }
  fmt::print("| largest |");
  for (const Weights& w : worst) fmt::print(" {:.0f} |", w.largest);
  fmt::print("\n\n");
}

// What a BRDF reflects towards wo, the root mean square of the channels.
double albedo_of(BrdfRef brdf, Vec3 wo) {
  std::vector<double> f(static_cast<std::size_t>(brdf.channels()));
  double sum = 0;
  for (const auto& [wi, weight] : half_vector_quadrature(wo, 64, 1024))
    sum += reflected_size(brdf, wi, wo, f) * weight;
  return sum;
}

void report_horizon(const std::vector<Material>& materials) {
  constexpr int kThetas[] = {75, 85, 88, 89};
  fmt::print(
      "burnish's weights near the horizon, second moment and largest, and what is reflected there (albedo, "
      "root mean square of the channels) by the model and as measured:\n\n| material |");
  for (const int theta_deg : kThetas) fmt::print(" {}° |", theta_deg);
  for (const int theta_deg : kThetas) fmt::print(" albedo {}° |", theta_deg);
  fmt::print("\n|---|");
  for (std::size_t i = 0; i < 2 * std::size(kThetas); ++i) fmt::print("---|");
  fmt::print("\n");
  for (const Material& m : materials) {
    const TabulatedSampler sampler(m.model);
    const Measurement measurement{&m.table};
    fmt::print("| {} |", m.name);
    for (const int theta_deg : kThetas) {
      const Weights w = weights_of(m.model, sampler, spherical_direction(radians(theta_deg), 1));
      fmt::print(" {:.2f}, {:.0f} |", w.second_moment, w.largest);
    }
    for (const int theta_deg : kThetas) {
      const Vec3 wo = spherical_direction(radians(theta_deg), 1);
      fmt::print(" {:.3g}, {:.3g} |", albedo_of(m.model, wo), albedo_of(measurement, wo));
    }
    fmt::print("\n");
  }
  fmt::print("\n");
}

// ---- Variance under environments

constexpr int kTurns = 8, kPictureSize = 24, kSamples = 144;

// Of each density.
struct Variance {
  std::vector<double> of_picture;  // relative to the picture's mean square
  std::vector<double> of_pixels;   // to each pixel's square
};

// Over all turns of an environment; `guide` draws the directions to integrate over.
Variance variance_of(BrdfRef brdf, SamplerRef guide, std::span<const SamplerRef> densities,
                     const Environment& environment) {
  Variance sum{std::vector<double>(densities.size()), std::vector<double>(densities.size())};
  double energy = 0;
  for (int turn = 0; turn < kTurns; ++turn) {
    const auto [mean, variance] =
        moments_in_environment(brdf, guide, densities, turned(environment, kTwoPi * turn / kTurns),
                               {.size = kPictureSize, .samples = kSamples, .seed = 7});
    double total = 0;
    std::size_t lit = 0;
    for (const float value : mean.pixels) {
      total += value;
      lit += value > 0;
    }
    // one tenth of the mean, so that no black pixel decides
    const double floor = 0.1 * total / static_cast<double>(lit);
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
      const double value = mean.pixels[i];
      energy += value * value;
      for (std::size_t k = 0; k < densities.size(); ++k) {
        sum.of_picture[k] += variance[k].pixels[i];
        sum.of_pixels[k] +=
            variance[k].pixels[i] / (value * value + floor * floor) / (static_cast<double>(lit) * kTurns);
      }
    }
  }
  for (double& v : sum.of_picture) v /= energy;
  return sum;
}

// CPU time of one draw and evaluation, microseconds; one thread.
double time_of(BrdfRef brdf, SamplerRef sampler) {
  const ThreadLimit one(1);
  double best = 1e9;
  for (int run = 0; run < 3; ++run) {
    const double start = cpu_seconds();
    render_in_environment(brdf, sampler, environments()[0], {.size = 32, .samples = 64});
    best = std::min(best, cpu_seconds() - start);
  }
  return 1e6 * best / (64 * kPi / 4 * 32 * 32);
}

void report_variance(const std::vector<Material>& materials, bool of_models) {
  fmt::print("## Variance, {}\n\n", of_models ? "rendering the models" : "rendering the measurements");
  for (const Environment& environment : environments()) {
    fmt::print("Environment `{}`:\n\n", environment.name);
    print_header("material", kProportional);
    std::array<double, kDensities> ratio{}, worst{}, pixel_ratio{}, best_ratio{};
    std::array<double, kWays> time{}, timed_ratio{};
    for (const Material& m : materials) {
      const Measurement measurement{&m.table};
      const BrdfRef brdf = of_models ? BrdfRef(m.model) : BrdfRef(measurement);
      const Drawers drawers(brdf, m.table);
      const Proportional proportional(brdf);
      std::vector<SamplerRef> densities;
      for (const SamplerRef s : drawers.all()) densities.push_back(s);
      densities.push_back(proportional);
      const Variance variance = variance_of(brdf, drawers.tabulated, densities, environment);
      fmt::print("| {} |", m.name);
      const auto share = 1 / static_cast<double>(materials.size());
      for (std::size_t k = 0; k < kDensities; ++k) {
        fmt::print(" {:.4g} |", variance.of_picture[k]);
        const double r = variance.of_picture[kOurs] / variance.of_picture[k];
        ratio[k] += share * r;
        best_ratio[k] += share * variance.of_picture[kWays] / variance.of_picture[k];
        worst[k] = std::max(worst[k], r);
        pixel_ratio[k] += share * variance.of_pixels[kOurs] / variance.of_pixels[k];
      }
      std::array<double, kWays> once;
      for (std::size_t k = 0; k < kWays; ++k) once[k] = time_of(brdf, drawers.all()[k]);
      for (std::size_t k = 0; k < kWays; ++k) {
        time[k] += share * once[k];
        timed_ratio[k] += share * variance.of_picture[kOurs] / variance.of_picture[k] * once[kOurs] / once[k];
      }
      fmt::print("\n");
    }
    const auto line = [](const char* name, std::span<const double> values) {
      fmt::print("| {} |", name);
      for (const double v : values) fmt::print(" {:.3f} |", v);
      fmt::print("{}\n", values.size() < kDensities ? " |" : "");
    };
    line("**burnish's over this, mean**", ratio);
    line("burnish's over this, worst", worst);
    line("what draws in proportion would have, mean", best_ratio);
    line("the same in equal time, mean", timed_ratio);
    line("the same of pixels, mean", pixel_ratio);
    line("µs for a draw and its value", time);
    fmt::print("\n");
  }
}

// ---- One table or one a lobe

void report_lobe_choice(const std::vector<Material>& materials) {
  fmt::print(
      "## One table or one a lobe\n\nThe models again: burnish's one table over all lobes beside the "
      "customary "
      "mixture, a lobe chosen by its albedo for this wo and drawn from a table of its own, with the density "
      "of "
      "all. Variance of the one table over the mixture's; CPU time of a draw and its value; bytes of "
      "tables.\n\n| material | lobes |");
  for (const Environment& e : environments()) fmt::print(" `{}` |", e.name);
  fmt::print(" µs, one | µs, mixture | bytes, one | bytes, mixture |\n|---|---|");
  for (std::size_t k = 0; k < environments().size() + 4; ++k) fmt::print("---|");
  fmt::print("\n");
  std::vector<double> mean(environments().size() + 2);
  const auto share = 1 / static_cast<double>(materials.size());
  for (const Material& m : materials) {
    const TabulatedSampler one(m.model);
    const LobeChoice mixture(m.model);
    fmt::print("| {} | {} |", m.name, mixture.lobes());
    std::vector<double> row;
    for (const Environment& environment : environments()) {
      const Variance v = variance_of(m.model, one, std::array<SamplerRef, 2>{one, mixture}, environment);
      row.push_back(v.of_picture[0] / v.of_picture[1]);
    }
    row.push_back(time_of(m.model, one));
    row.push_back(time_of(m.model, mixture));
    for (std::size_t k = 0; k < row.size(); ++k) {
      fmt::print(" {:.3f} |", row[k]);
      mean[k] += share * row[k];
    }
    fmt::print(" {} | {} |\n", one.bytes(), mixture.lobes() * one.bytes());
  }
  fmt::print("| **mean** | |");
  for (const double v : mean) fmt::print(" {:.3f} |", v);
  fmt::print(" | |\n\n");
}

// ---- Error against the number of samples

constexpr const char* kPlotted = "chm_mint_rgb";

void report_errors(const Material& m, const fs::path& docs) {
  const Measurement measurement{&m.table};
  const BrdfRef brdf = measurement;
  const Drawers drawers(brdf, m.table);
  const Environment& studio = environments()[1];
  const Image reference =
      moments_in_environment(brdf, drawers.tabulated, {}, studio, {.size = 64, .samples = 4096}).mean;
  double energy = 0;
  for (const float value : reference.pixels) energy += value * value;
  Plot by_count{.title = fmt::format("{} under \"{}\"", m.name, studio.name),
                .x_label = "samples a pixel",
                .y_label = "rms error / rms value",
                .log_x = true,
                .log_y = true};
  Plot by_time = by_count;
  by_time.x_label = "CPU microseconds a pixel";
  fmt::print(
      "## Error against samples and time\n\n{} rendered as measured under `{}`, 64 x 64 pixels "
      "([by count](figures/sampling-error-count.svg), [by time](figures/sampling-error-time.svg)); "
      "root mean square error over root mean square value. The last column draws from points jittered in a "
      "square grid.\n\n",
      m.name, studio.name);
  print_header("samples", "burnish, stratified");
  for (std::size_t k = 0; k <= kWays; ++k) {
    const std::string name = k < kWays ? kWayNames[k] : "burnish, stratified";
    const PlotStyle style = k < kWays ? PlotStyle::line_and_points : PlotStyle::dashed;
    by_count.series.push_back({.label = name, .style = style});
    by_time.series.push_back({.label = name, .style = style});
  }
  for (int samples = 4; samples <= 4096; samples *= 4) {
    fmt::print("| {} |", samples);
    for (std::size_t k = 0; k <= kWays; ++k) {
      const LightOptions options{.size = 64, .samples = samples, .stratified = k == kWays};
      const double start = cpu_seconds();
      const LightRender render =
          render_in_environment(brdf, drawers.all()[std::min(k, kWays - 1)], studio, options);
      const double seconds = cpu_seconds() - start;
      double squares = 0;
      for (std::size_t i = 0; i < reference.pixels.size(); ++i)
        squares += std::pow(render.mean.pixels[i] - reference.pixels[i], 2);
      const double error = std::sqrt(squares / energy);
      fmt::print(" {:.4f} |", error);
      by_count.series[k].x.push_back(samples);
      by_time.series[k].x.push_back(1e6 * seconds / (kPi / 4 * 64 * 64));
      by_count.series[k].y.push_back(error);
      by_time.series[k].y.push_back(error);
    }
    fmt::print("\n");
  }
  fs::create_directories(docs / "figures");
  write_then_rename(docs / "figures/sampling-error-count.svg", to_svg(by_count));
  write_then_rename(docs / "figures/sampling-error-time.svg", to_svg(by_time));
}

// Sixteen samples a pixel, all ways, beside the picture they approach.
void draw_noise(const std::vector<Material>& materials, const fs::path& docs) {
  ContactSheet sheet{.title = "16 samples a pixel, environment \"studio\"", .column_labels = {"reference"}};
  for (const char* way : kWayNames) sheet.column_labels.push_back(way);
  const Environment& studio = environments()[1];
  for (const char* name : {"acrylic_felt_green_rgb", "cc_ibiza_sunset_rgb", "chm_mint_rgb"}) {
    const auto m = std::ranges::find(materials, name, &Material::name);
    if (m == materials.end()) continue;
    const Measurement measurement{&m->table};
    const Drawers drawers(measurement, m->table);
    constexpr int kSize = 128;
    const Image reference =
        moments_in_environment(measurement, drawers.tabulated, {}, studio, {.size = kSize, .samples = 576})
            .mean;
    std::vector<float> values;
    for (int i = 0; i < kSize * kSize; ++i)
      if (sphere_normal(kSize, i % kSize + 0.5, i / kSize + 0.5))
        for (const float v : reference.at(i % kSize, i / kSize)) values.push_back(v);
    const double exposure = 1 / percentile(values, 0.95);
    sheet.row_labels.push_back(m->name);
    std::vector<Image8>& row = sheet.cells.emplace_back();
    row.push_back(to_image8(tone_map(reference, exposure)));
    for (const SamplerRef sampler : drawers.all())
      row.push_back(to_image8(
          tone_map(render_in_environment(measurement, sampler, studio, {.size = kSize, .samples = 16}).mean,
                   exposure)));
  }
  write_png(docs / "figures/sampling-noise.png", compose(sheet));
}

void report(const fs::path& docs) {
  const char* data = std::getenv("BURNISH_DATA");
  if (!data) throw Error("BURNISH_DATA: expected the folder of measurements, found nothing");
  const std::vector<Material> materials = load_materials(fs::path(data) / "rgl");
  fmt::print(
      "# Sampling: what was measured\n\nMade by `make sampling-report` on {}. What it means is in "
      "[sampling.md](sampling.md). Models are those of `burnish fit --budget {}`; tables of a sampler take "
      "{} "
      "bytes.\n\n",
      processor(), kModelBytes, TabulatedSampler(materials.front().model).bytes());
  report_weights(materials);
  report_horizon(materials);
  fmt::print(
      "Variances below are of one sample, summed over the picture of a sphere ({} pixels wide) and its "
      "channels, over "
      "the sum of the picture's squares; each environment turned to {} azimuths. \"The same of pixels\" "
      "relates the "
      "variance of each pixel to its own value instead.\n\n",
      kPictureSize, kTurns);
  report_variance(materials, false);
  report_variance(materials, true);
  report_lobe_choice(materials);
  if (const auto m = std::ranges::find(materials, kPlotted, &Material::name); m != materials.end())
    report_errors(*m, docs);
  draw_noise(materials, docs);
}

}  // namespace
}  // namespace burnish

int main(int argc, char** argv) {
  if (argc != 2 || !std::filesystem::is_directory(argv[1])) {
    fmt::print(stderr, "usage: burnish_sampling_report DOCS_FOLDER\n");
    return 2;
  }
  try {
    burnish::report(argv[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "burnish_sampling_report: {}\n", error.what());
    return 1;
  }
}
