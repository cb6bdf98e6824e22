// SPDX-License-Identifier: Apache-2.0
// Compares ways of drawing directions on the RGL materials: weights, variance under environments, time.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <deque>
#include <optional>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/eval/factored_eval.h>
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
#include "report.h"

namespace burnish::reports {

namespace {

// Returns the seconds of this process. Other processes do not slow them down, unlike the clock on the wall.
double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// A form of fit: the best one of few bytes, and one that a shader reads twice.
struct Form {
  const char *name, *command;  // the name in marks and files, and the command line
  Budget budget;
};
const std::array kForms{Form{"models", "burnish fit --target function --budget 2700", {.bytes = 2700}},
                        Form{"volumes",
                             "burnish fit --target function --budget 16384 --fetches 2",
                             {.bytes = 16'384, .fetches = 2}}};

// A BRDF with every way to draw directions for it.
struct Drawn {
  BrdfRef brdf;
  Drawers drawers;
  Proportional proportional;

  Drawn(BrdfRef of, const RglTable& table) : brdf(of), drawers(of, table), proportional(of) {}
};

// A model, evaluated as in a renderer.
struct Model {
  FactoredBrdf factors;
  FactoredEvaluator evaluator;
  Drawn drawn;

  Model(FactoredBrdf fitted, const RglTable& table)
      : factors(std::move(fitted)), evaluator(factors), drawn(evaluator, table) {}
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;
};

struct Material {
  std::string name;
  RglTable table;
  Measurement measurement;
  Drawn measured;
  std::deque<Model> models;  // one for each form

  Material(std::string called, RglTable of)
      : name(std::move(called)), table(std::move(of)), measurement{&table}, measured(measurement, table) {}
  Material(const Material&) = delete;
  Material& operator=(const Material&) = delete;
};
using Materials = std::deque<Material>;

constexpr const char* kPlotted = "chm_mint_rgb";

Materials load_materials(const fs::path& folder, bool quick) {
  Materials materials;
  for (const fs::path& file : files_in(folder)) {
    const std::string name = file.stem().string();
    if (quick && name != kPlotted) continue;
    tell("sampling: " + name);
    Source source = open_source(file.string(), {});
    std::vector<FactoredBrdf> fits;
    for (const Form& form : kForms)
      fits.push_back(
          fit(source, {.form = form.budget, .target = FitTarget::function, .score = false}).model());
    Material& material = materials.emplace_back(name, std::get<RglTable>(std::move(source.brdf)));
    for (FactoredBrdf& model : fits) material.models.emplace_back(std::move(model), material.table);
  }
  return materials;
}

// The numbers of draws, turns, samples and runs.
struct Effort {
  int draws = 50'000, turns = 8, samples = 144, timed_runs = 3;
  int max_samples = 4096, reference_samples = 4096;  // for the error against samples
};
constexpr Effort kQuick{
    .draws = 1000, .turns = 1, .samples = 16, .timed_runs = 1, .max_samples = 64, .reference_samples = 256};

// ---- Weights

struct Weights {
  double second_moment = 0, largest = 0, lost = 0;  // relative to the mean, the moment to its square; a share
};

Weights weights_of(BrdfRef brdf, SamplerRef sampler, Vec3 wo, int draws) {
  Pcg32 random(3);
  std::vector<double> f(brdf.channels());
  double sum = 0, squares = 0, largest = 0, lost = 0;
  for (int i = 0; i < draws; ++i) {
    const double x = random.uniform();
    const DrawnDirection drawn = sampler.sample_wi(wo, {x, random.uniform()});
    const bool useful = drawn.pdf > 0 && drawn.wi.z > 0;
    const double weight = useful ? reflected_size(brdf, drawn.wi, wo, f) / drawn.pdf : 0;
    sum += weight / draws;
    squares += weight * weight / draws;
    largest = std::max(largest, weight);
    lost += useful ? 0 : 1.0 / draws;
  }
  return {squares / (sum * sum), largest / sum, lost};
}

Table weights_table(const Materials& materials, std::size_t form, const Effort& effort) {
  Table table(joined({"theta_o"}, kWayNames));
  const auto share = 1 / static_cast<double>(materials.size());
  std::array<double, kWays> largest{};
  for (const int theta_deg : {0, 20, 40, 60, 75, 85, 88, 89}) {
    std::array<Weights, kWays> mean;
    for (const Material& m : materials) {
      const Drawn& drawn = m.models[form].drawn;
      for (std::size_t k = 0; k < kWays; ++k) {
        const Weights w = weights_of(drawn.brdf, drawn.drawers.all()[k],
                                     spherical_direction(radians(theta_deg), 1), effort.draws);
        mean[k].second_moment += share * w.second_moment;
        mean[k].lost += share * w.lost;
        largest[k] = std::max(largest[k], w.largest);
      }
    }
    std::vector<std::string> line{fmt::format("{}°", theta_deg)};
    for (const Weights& w : mean)
      line.push_back(fmt::format("{:.3f} ({:.1f} %)", w.second_moment, 100 * w.lost));
    table.add(line);
  }
  table.add(joined({"largest"}, cells("{:.0f}", largest)));
  return table;
}

// Returns the albedo of a BRDF towards wo, as the root mean square of the channels.
double albedo_of(BrdfRef brdf, Vec3 wo) {
  std::vector<double> f(brdf.channels());
  double sum = 0;
  for (const auto& [wi, weight] : half_vector_quadrature(wo, 64, 1024))
    sum += reflected_size(brdf, wi, wo, f) * weight;
  return sum;
}

// Returns the name of a mark or file of a form. Names of the first form have no suffix.
std::string mark_of(const std::string& what, std::size_t form, char between) {
  return form == 0 ? what : fmt::format("{}{}{}", what, between, kForms[form].name);
}

void report_horizon(Page& page, const Materials& materials, std::size_t form, const Effort& effort) {
  const std::vector<std::string> head{"second moment", "largest weight", "albedo of the model",
                                      "albedo as measured"};
  Table rows(joined({"material", "theta_o"}, head)), means(joined({"theta_o"}, head));
  for (const int theta_deg : {75, 85, 88, 89}) {
    const Vec3 wo = spherical_direction(radians(theta_deg), 1);
    const std::string theta = fmt::format("{}°", theta_deg);
    std::array<double, 4> mean{};
    for (const Material& m : materials) {
      const Drawn& drawn = m.models[form].drawn;
      const Weights w = weights_of(drawn.brdf, drawn.drawers.tabulated, wo, effort.draws);
      const std::array figures{w.second_moment, w.largest, albedo_of(drawn.brdf, wo),
                               albedo_of(m.measurement, wo)};
      rows.add(joined({m.name, theta}, cells("{:.3g}", figures)));
      for (std::size_t k = 0; k < mean.size(); ++k)
        mean[k] += figures[k] / static_cast<double>(materials.size());
    }
    means.add(joined({theta}, cells("{:.3g}", mean)));
  }
  page[mark_of("horizon", form, '_')] = means.markdown();
  page.write_rows(mark_of("horizon", form, '-'), rows);
}

// ---- Variance under environments

constexpr int kPictureSize = 24;

// The variance by each density.
struct Variance {
  std::vector<double> of_picture;  // relative to the picture's mean square
  std::vector<double> of_pixels;   // relative to each pixel's square
};

// Returns the variance over all turns of an environment. `guide` draws the directions to integrate over.
Variance variance_of(BrdfRef brdf, SamplerRef guide, std::span<const SamplerRef> densities,
                     const Environment& environment, const Effort& effort) {
  Variance sum{std::vector<double>(densities.size()), std::vector<double>(densities.size())};
  double energy = 0;
  for (int turn = 0; turn < effort.turns; ++turn) {
    const auto [mean, variance] =
        moments_in_environment(brdf, guide, densities, turned(environment, kTwoPi * turn / effort.turns),
                               {.size = kPictureSize, .samples = effort.samples, .seed = 7});
    double total = 0;
    std::size_t lit = 0;
    for (const float value : mean.pixels) {
      total += value;
      lit += value > 0;
    }
    // One tenth of the mean is added, so that no black pixel dominates.
    const double floor = 0.1 * total / static_cast<double>(lit);
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
      const double value = mean.pixels[i];
      energy += value * value;
      for (std::size_t k = 0; k < densities.size(); ++k) {
        sum.of_picture[k] += variance[k].pixels[i];
        sum.of_pixels[k] += variance[k].pixels[i] / (value * value + floor * floor) /
                            (static_cast<double>(lit) * effort.turns);
      }
    }
  }
  for (double& v : sum.of_picture) v /= energy;
  return sum;
}

// Returns the CPU time of one draw and evaluation in microseconds, on one thread.
double time_of(BrdfRef brdf, SamplerRef sampler, const Effort& effort) {
  const ThreadLimit one(1);
  double best = 1e9;
  for (int run = 0; run < effort.timed_runs; ++run) {
    const double start = cpu_seconds();
    render_in_environment(brdf, sampler, environments()[0], {.size = 32, .samples = 64});
    best = std::min(best, cpu_seconds() - start);
  }
  return 1e6 * best / (64 * kPi / 4 * 32 * 32);
}

// Compares our variance and time with those of each density, over the materials seen.
struct Comparison {
  std::array<double, kDensities> ratio{}, worst{}, best_ratio{}, pixel_ratio{};  // ratios of variances
  std::array<double, kWays> time{}, timed_ratio{};

  void add(const Variance& variance, const std::array<double, kWays>& microseconds, double share) {
    for (std::size_t k = 0; k < kDensities; ++k) {
      const double r = variance.of_picture[kOurs] / variance.of_picture[k];
      ratio[k] += share * r;
      worst[k] = std::max(worst[k], r);
      best_ratio[k] += share * variance.of_picture[kWays] / variance.of_picture[k];
      pixel_ratio[k] += share * variance.of_pixels[kOurs] / variance.of_pixels[k];
    }
    for (std::size_t k = 0; k < kWays; ++k) {
      const double r = variance.of_picture[kOurs] / variance.of_picture[k];
      time[k] += share * microseconds[k];
      timed_ratio[k] += share * r * microseconds[kOurs] / microseconds[k];
    }
  }

  void print(const std::string& environment, Table& table) const {
    const auto line = [&](const char* name, std::span<const double> values) {
      std::vector<std::string> texts = cells("{:.3f}", values);
      texts.resize(kDensities);
      table.add(joined({environment, name}, texts));
    };
    line("**burnish's over this, mean**", ratio);
    line("burnish's over this, worst", worst);
    line("that of a draw in proportion over this, mean", best_ratio);
    line("burnish's over this in equal time, mean", timed_ratio);
    line("burnish's over this, of pixels, mean", pixel_ratio);
    line("µs for a draw and its value", time);
  }
};

// Reports the models of a form, or the measurements.
void report_variance(Page& page, const Materials& materials, std::optional<std::size_t> form,
                     const Effort& effort) {
  const std::string what = form ? kForms[*form].name : "measurements";
  const auto head = [&](std::vector<std::string> first) {
    first = joined(std::move(first), kWayNames);
    first.emplace_back(kProportional);
    return first;
  };
  Table table(head({"environment", "variance"})), rows(head({"environment", "material"}));
  for (const Environment& environment : environments()) {
    Comparison comparison;
    for (const Material& m : materials) {
      tell(fmt::format("sampling: {}, {}, {}", environment.name, m.name, what));
      const Drawn& drawn = form ? m.models[*form].drawn : m.measured;
      std::vector<SamplerRef> densities;
      for (const SamplerRef s : drawn.drawers.all()) densities.push_back(s);
      densities.push_back(drawn.proportional);
      const Variance variance =
          variance_of(drawn.brdf, drawn.drawers.tabulated, densities, environment, effort);
      rows.add(joined({environment.name, m.name}, cells("{:.4g}", variance.of_picture)));
      std::array<double, kWays> microseconds;
      for (std::size_t k = 0; k < kWays; ++k)
        microseconds[k] = time_of(drawn.brdf, drawn.drawers.all()[k], effort);
      comparison.add(variance, microseconds, 1 / static_cast<double>(materials.size()));
    }
    comparison.print(fmt::format("`{}`", environment.name), table);
  }
  page["variance_" + what] = table.markdown();
  page.write_rows("variance-" + what, rows);
}

// ---- One table or one a lobe

void report_lobe_choice(Page& page, const Materials& materials, const Effort& effort) {
  std::vector<std::string> head;
  for (const Environment& e : environments()) head.push_back(fmt::format("variance, {}", e.name));
  head = joined(std::move(head), std::array{"µs, one", "µs, mixture", "bytes, one", "bytes, mixture"});
  Table rows(joined({"material", "lobes"}, head)), means(head);
  std::vector<double> mean(head.size());
  for (const Material& m : materials) {
    tell(fmt::format("sampling: {}, lobes", m.name));
    const auto& [factors, evaluator, drawn] = m.models.front();
    const TabulatedSampler& one = drawn.drawers.tabulated;
    const LobeChoice mixture(factors);
    std::vector<double> figures;
    for (const Environment& environment : environments()) {
      const Variance v =
          variance_of(evaluator, one, std::array<SamplerRef, 2>{one, mixture}, environment, effort);
      figures.push_back(v.of_picture[0] / v.of_picture[1]);
    }
    figures.push_back(time_of(evaluator, one, effort));
    figures.push_back(time_of(evaluator, mixture, effort));
    figures.push_back(static_cast<double>(one.bytes()));
    figures.push_back(static_cast<double>(mixture.lobes() * one.bytes()));
    rows.add(joined({m.name, std::to_string(mixture.lobes())}, cells("{:.5g}", figures)));
    for (std::size_t k = 0; k < mean.size(); ++k)
      mean[k] += figures[k] / static_cast<double>(materials.size());
  }
  means.add(cells("{:.5g}", mean));
  page["lobe_choice"] = means.markdown();
  page.write_rows("lobes", rows);
}

// ---- Error against the number of samples

struct ErrorRun {
  double error, seconds;  // the root mean square relative to the picture's; of the processor
};

ErrorRun error_of(BrdfRef brdf, SamplerRef sampler, const Environment& environment,
                  const LightOptions& options, const Image& reference, double energy) {
  const double start = cpu_seconds();
  const LightRender render = render_in_environment(brdf, sampler, environment, options);
  const double seconds = cpu_seconds() - start;
  double squares = 0;
  for (std::size_t i = 0; i < reference.pixels.size(); ++i)
    squares += std::pow(render.mean.pixels[i] - reference.pixels[i], 2);
  return {std::sqrt(squares / energy), seconds};
}

void report_errors(Page& page, const Material& m, const Effort& effort) {
  constexpr int kPixels = 64;
  constexpr const char* kStratified = "burnish, stratified";
  const BrdfRef brdf = m.measurement;
  const Drawers& drawers = m.measured.drawers;
  const Environment& studio = environments()[1];
  const Image reference = moments_in_environment(brdf, drawers.tabulated, {}, studio,
                                                 {.size = kPixels, .samples = effort.reference_samples})
                              .mean;
  double energy = 0;
  for (const float value : reference.pixels) energy += value * value;

  // Each way has a line. Ours has a second one, with points in a grid.
  Plot by_count{.title = fmt::format("{} under \"{}\"", m.name, studio.name),
                .x_label = "samples a pixel",
                .y_label = "rms error / rms value",
                .log_x = true,
                .log_y = true};
  for (const char* way : kWayNames)
    by_count.series.push_back({.label = way, .style = PlotStyle::line_and_points});
  by_count.series.push_back({.label = kStratified, .style = PlotStyle::dashed});
  Plot by_time = by_count;
  by_time.x_label = "CPU microseconds a pixel";
  Table table(joined(joined({"samples"}, kWayNames), std::array{kStratified}));
  for (int samples = 4; samples <= effort.max_samples; samples *= 4) {
    tell(fmt::format("sampling: {}, {} samples a pixel", m.name, samples));
    std::vector<double> errors;
    for (std::size_t k = 0; k <= kWays; ++k) {
      const auto [error, seconds] =
          error_of(brdf, drawers.all()[std::min(k, kWays - 1)], studio,
                   {.size = kPixels, .samples = samples, .stratified = k == kWays}, reference, energy);
      errors.push_back(error);
      by_count.series[k].x.push_back(samples);
      by_time.series[k].x.push_back(1e6 * seconds / (kPi / 4 * kPixels * kPixels));
      by_count.series[k].y.push_back(error);
      by_time.series[k].y.push_back(error);
    }
    table.add(joined({std::to_string(samples)}, cells("{:.4f}", errors)));
  }
  page["errors"] = table.markdown();
  page["plotted"] = m.name;
  page.write_plot("sampling-error-count", by_count);
  page.write_plot("sampling-error-time", by_time);
}

// Draws the pictures by each way with sixteen samples a pixel, beside the picture that they converge to.
void draw_noise(const Page& page, const Materials& materials) {
  ContactSheet sheet{.title = "16 samples a pixel, environment \"studio\"", .column_labels = {"reference"}};
  for (const char* way : kWayNames) sheet.column_labels.push_back(way);
  const Environment& studio = environments()[1];
  for (const char* name : {"acrylic_felt_green_rgb", "cc_ibiza_sunset_rgb", "chm_mint_rgb"}) {
    const auto m = std::ranges::find(materials, name, &Material::name);
    if (m == materials.end()) continue;
    tell(fmt::format("sampling: {}, a picture", m->name));
    const Measurement& measurement = m->measurement;
    const Drawers& drawers = m->measured.drawers;
    constexpr int kPixels = 128;
    const Image reference =
        moments_in_environment(measurement, drawers.tabulated, {}, studio, {.size = kPixels, .samples = 144})
            .mean;
    std::vector<float> values;
    for (int i = 0; i < kPixels * kPixels; ++i)
      if (sphere_normal(kPixels, i % kPixels + 0.5, i / kPixels + 0.5))
        for (const float v : reference.at(i % kPixels, i / kPixels)) values.push_back(v);
    const double exposure = 1 / percentile(values, 0.95);
    sheet.row_labels.push_back(m->name);
    std::vector<Image8>& row = sheet.cells.emplace_back();
    row.push_back(to_image8(tone_map(reference, exposure)));
    for (const SamplerRef sampler : drawers.all())
      row.push_back(to_image8(
          tone_map(render_in_environment(measurement, sampler, studio, {.size = kPixels, .samples = 16}).mean,
                   exposure)));
  }
  page.write_figure("sampling-noise.png", encode_png(compose(sheet)));
}

}  // namespace

void report_sampling(const ReportOptions& options) {
  if (!options.data) throw Error("BURNISH_DATA: expected the folder of measurements, found nothing");
  const Effort effort = options.quick ? kQuick : Effort{};
  Page page(options, "sampling-results");
  const Materials materials = load_materials(*options.data / "rgl", options.quick);
  if (materials.empty()) throw Error::in_file(*options.data / "rgl", "measurements", "none");
  page["materials"] = std::to_string(materials.size());
  page["table_bytes"] = std::to_string(materials.front().measured.drawers.tabulated.bytes());
  page["draws"] = std::to_string(effort.draws);
  page["turns"] = std::to_string(effort.turns);
  page["picture_size"] = std::to_string(kPictureSize);
  for (std::size_t form = 0; form < kForms.size(); ++form) {
    tell(fmt::format("sampling: weights, {}", kForms[form].command));
    page[std::string("command_") + kForms[form].name] = kForms[form].command;
    page[mark_of("weights", form, '_')] = weights_table(materials, form, effort).markdown();
    report_horizon(page, materials, form, effort);
  }
  report_variance(page, materials, {}, effort);
  for (std::size_t form = 0; form < kForms.size(); ++form) report_variance(page, materials, form, effort);
  report_lobe_choice(page, materials, effort);
  if (const auto m = std::ranges::find(materials, kPlotted, &Material::name); m != materials.end())
    report_errors(page, *m, effort);
  draw_noise(page, materials);
  page.write();
}

}  // namespace burnish::reports
