// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/embedded_file.h>
#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/image/contact_sheet.h>
#include <burnish/image/markup.h>
#include <burnish/image/png.h>
#include <burnish/math/written_degrees.h>
#include <burnish/metrics/figures_json.h>
#include <burnish/parameterization/half_diff.h>
#include <burnish/report/compare_report.h>
#include <burnish/report/factor_images.h>

namespace burnish {

// Returns the files of web/comparison.
std::span<const EmbeddedFile> comparison_files();

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kReferenceColor = "#202226";
constexpr std::array<double, 3> kSliceAngles = {radians(10), radians(30), radians(60)};

constexpr std::array<double, 6> kAlbedoAngles = {0,           radians(15), radians(30),
                                                 radians(45), radians(60), radians(75)};

std::string bytes_text(std::optional<std::uint64_t> bytes) {
  return bytes ? fmt::format("{} bytes", *bytes) : std::string("size unknown");
}

std::string psnr_text(double psnr) {
  return std::isinf(psnr) ? std::string("equal") : fmt::format("{:.2f} dB", psnr);
}

nlohmann::ordered_json node_json(const NodeFigures& figures) {
  return json_of(figures, {"log_cos", "relative", "rms_log", "rms"});
}

nlohmann::ordered_json json_of(const MeasurementQuality& quality) {
  nlohmann::ordered_json entry{{"repeated", quality.repeated}};
  entry.update(json_of(quality.figures, {"log_cos", "relative", "rms_log", "rms", "psnr", "ssim"}));
  entry["negative_share"] = quality.negative_share;
  entry["negative_rms"] = quality.negative_rms;
  if (quality.held_out) entry["held_out"] = node_json(*quality.held_out);
  if (quality.held_out_incidences) entry["held_out_incidences"] = node_json(*quality.held_out_incidences);
  return entry;
}

nlohmann::ordered_json json_of(std::span<const ComparedFigures> compared, const Measurement* measurement) {
  auto list = nlohmann::ordered_json::array();
  for (const ComparedFigures& c : compared) {
    nlohmann::ordered_json entry{{"model", c.name}, {"bytes", nullptr}};
    if (c.bytes) entry["bytes"] = *c.bytes;
    entry.update(json_of(c.figures, {"log_cos", "relative", "rms_log", "rms", "mean_abs_log", "psnr", "ssim",
                                     "unknown_fraction"}));
    const double disc = psnr_of_disc(c.figures.psnr);
    entry["psnr_of_disc"] = std::isfinite(disc) ? nlohmann::ordered_json(disc) : nullptr;
    entry["unknown_pixels"] = c.figures.unknown_pixels;
    for (const ComparedAlbedo& a : c.albedos)
      entry["albedo"].push_back({{"theta_i_deg", written_degrees(a.theta_i)},
                                 {"phi_i_deg", written_degrees(a.phi_i)},
                                 {"reference", a.reference.albedo},
                                 {"model", a.model.albedo},
                                 {"reference_unknown_fraction", a.reference.unknown_fraction}});
    if (!c.note.empty()) entry["note"] = c.note;
    if (c.nodes) entry["nodes"] = node_json(*c.nodes);
    if (c.nodes && measurement) entry["nodes"]["itself"] = node_json(measurement->itself);
    if (c.expected) entry["expected"] = json_of(*c.expected);
    if (c.expected && measurement && measurement->expected)
      entry["expected"]["itself"] = json_of(*measurement->expected);
    if (measurement && measurement->quality) entry["measurement"] = json_of(*measurement->quality);
    list.push_back(std::move(entry));
  }
  return list;
}

// Writes a JSON text. A file's name is free text in any encoding, so bytes that are no UTF-8 are replaced.
std::string dump(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

// Returns the least number that is 1, 2, 5 or 10 times a power of ten and at or above v.
double round_up(double v) {
  const double power = std::pow(10.0, std::floor(std::log10(v))), lead = v / power;
  return power * (lead <= 1 ? 1 : lead <= 2 ? 2 : lead <= 5 ? 5 : 10);
}

// Returns the end of a model's colour scale: the 99.5th percentile of the worst of its pictures, rounded up.
double heat_scale(const SpherePictures& reference, const SpherePictures& model) {
  constexpr double kShare = 0.995, kMin = 0.02;
  double scale = kMin;
  for (std::size_t i = 0; i < model.shown.size(); ++i)
    scale = std::max(scale, percentile(mean_difference(reference.shown[i], model.shown[i]).pixels, kShare));
  return std::min(1.0, round_up(scale));
}

std::string_view name_of(const MeasurementQuality& quality) {
  return quality.repeated ? "the measurement, repeated" : "the measurement itself (estimate)";
}

std::string light_text(std::size_t i) {
  return fmt::format("light {:.0f}°", degrees(kSphereLights[i]));
}

std::string heading(const ComparedFigures& c) {
  return fmt::format("{}\n{}, psnr {}, ssim {:.3f}", c.name, bytes_text(c.bytes), psnr_text(c.figures.psnr),
                     c.figures.ssim);
}

void write_plot(const fs::path& stem, const Plot& plot) {
  write_then_rename(stem.string() + ".svg", to_svg(plot));
  write_png(stem.string() + ".png", to_image(plot));
}

// Returns a file of web/comparison with values in place of its marks.
std::string filled(std::string_view file, const std::map<std::string_view, std::string>& marks) {
  return with_marks(text_of(comparison_files(), file), marks);
}

std::string nodes_row(std::string_view name, const NodeFigures& figures) {
  return filled("nodes_row.html", {{"NAME", escape_markup(name)},
                                   {"LOGCOS", fmt::format("{:.5f}", figures.log_cos)},
                                   {"RELATIVE", fmt::format("{:.4f}", figures.relative)},
                                   {"RMSLOG", fmt::format("{:.4f}", figures.rms_log)},
                                   {"RMS", fmt::format("{:.4g}", figures.rms)}});
}

// Writes the models' scores at the measured nodes.
std::string nodes_html(const Measurement& measurement, std::span<const ComparedFigures> compared) {
  const auto& quality = measurement.quality;
  std::string rows = nodes_row("the reference, made reciprocal", measurement.itself);
  if (quality && quality->held_out)
    rows += nodes_row("the function between nodes that has not seen them", *quality->held_out);
  if (quality && quality->held_out_incidences)
    rows += nodes_row("the function between nodes that has not seen their theta_i",
                      *quality->held_out_incidences);
  for (const ComparedFigures& c : compared)
    if (c.nodes) rows += nodes_row(c.name, *c.nodes);
  std::string noise;
  if (quality && quality->negative_share > 0)
    noise = fmt::format(
        " {:.1f} % of the measured values are negative, with a root mean square of {:.2g} per sr.",
        100 * quality->negative_share, quality->negative_rms);
  return filled("nodes.html", {{"ROWS", std::move(rows)},
                               {"COUNT", fmt::format("{}", measurement.itself.count)},
                               {"NOISE", std::move(noise)}});
}

std::string expected_row(std::string_view name, const ExpectedError& expected) {
  std::string bands;
  for (const auto& relative : expected.by_theta_i)
    bands += filled("expected_band.html", {{"RELATIVE", relative ? fmt::format("{:.4f}", *relative) : "–"}});
  return filled("expected_row.html", {{"NAME", escape_markup(name)},
                                      {"RELATIVE", fmt::format("{:.4f}", expected.relative)},
                                      {"BANDS", std::move(bands)}});
}

// Writes the errors expected between scattered samples, of the function itself and of each model.
std::string expected_html(const Measurement& measurement, std::span<const ComparedFigures> compared) {
  if (!measurement.expected) return {};
  std::string heads, rows = expected_row("the function between the samples", *measurement.expected);
  for (std::size_t band = 0; band < measurement.expected->by_theta_i.size(); ++band)
    heads +=
        filled("expected_head.html", {{"FROM", fmt::format("{:.0f}", ExpectedError::begin_degrees(band))},
                                      {"TO", fmt::format("{:.0f}", ExpectedError::begin_degrees(band + 1))}});
  for (const ComparedFigures& c : compared)
    if (c.expected) rows += expected_row(c.name, *c.expected);
  return filled("expected.html", {{"HEADS", std::move(heads)}, {"ROWS", std::move(rows)}});
}

std::string figures_row(std::string_view name, std::optional<std::uint64_t> bytes,
                        const ErrorFigures& figures, std::string_view note) {
  return filled("row.html", {{"NAME", escape_markup(name)},
                             {"BYTES", bytes ? fmt::format("{}", *bytes) : "–"},
                             {"LOGCOS", fmt::format("{:.5f}", figures.log_cos)},
                             {"RELATIVE", fmt::format("{:.4f}", figures.relative)},
                             {"RMSLOG", fmt::format("{:.4f}", figures.rms_log)},
                             {"PSNR", psnr_text(figures.psnr)},
                             {"DISC", psnr_text(psnr_of_disc(figures.psnr))},
                             {"SSIM", fmt::format("{:.4f}", figures.ssim)},
                             {"NOTE", escape_markup(note)}});
}

std::string factor_file(std::size_t model, const Table& table) {
  return fmt::format("factors/model_{}_{}.png", model + 1, table.name);
}

// Writes the pictures of a factored model's tables; nothing for any other BRDF.
std::string tables_html(const ComparedModel& model, std::size_t number) {
  if (!model.factored) return {};
  std::string tables;
  for (const Table& table : model.factored->tables())
    tables += filled("table.html", {{"FILE", escape_markup(factor_file(number, table))},
                                    {"TABLE", escape_markup(table.name)},
                                    {"LARGEST", fmt::format("{:.4g}", std::ranges::max(table.values))}});
  return filled("tables.html", {{"NAME", escape_markup(model.name)}, {"TABLES", std::move(tables)}});
}

std::string index_html(const std::string& reference_name, std::span<const ComparedModel> models,
                       std::span<const ComparedFigures> compared, const FigureOptions& options,
                       std::span<const std::string> plots, const Measurement* measurement) {
  std::string rows, sheets, charts;
  if (measurement && measurement->quality)
    rows += figures_row(name_of(*measurement->quality), {}, measurement->quality->figures,
                        "a model that scores better follows noise");
  else if (measurement)
    rows += filled("untold.html", {{"NAME", "the measurement itself"}, {"SAYS", std::string(kCannotBeTold)}});
  for (const ComparedFigures& c : compared) rows += figures_row(c.name, c.bytes, c.figures, c.note);
  for (std::size_t i = 0; i < compared.size(); ++i)
    sheets += filled("sheet.html", {{"NAME", escape_markup(compared[i].name)},
                                    {"FILE", fmt::format("model_{}.png", i + 1)},
                                    {"FACTORS", tables_html(models[i], i)}});
  for (const std::string& plot : plots) charts += filled("plot.html", {{"NAME", plot}});
  return filled("index.html", {{"NAME", escape_markup(reference_name)},
                               {"ROWS", std::move(rows)},
                               {"PAIRS", fmt::format("{}", options.count)},
                               {"SEED", fmt::format("{}", options.seed)},
                               {"SIZE", fmt::format("{}", options.image_size)},
                               {"FLOOR", fmt::format("{:g}", options.floor)},
                               {"NODES", measurement ? nodes_html(*measurement, compared) +
                                                           expected_html(*measurement, compared)
                                                     : std::string()},
                               {"SHEETS", std::move(sheets)},
                               {"PLOTS", std::move(charts)}});
}

// Scores a model; errors name it.
ErrorFigures score_of(const Scorer& scorer, const ComparedModel& model) {
  try {
    return scorer.score(model.brdf);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", model.name, error.what()));
  }
}

}  // namespace

std::optional<Measurement> measurement_of(const Source& source, BrdfRef scored, bool nodes_asked,
                                          const std::string& only) {
  if (!nodes_asked && only.empty() && !is_measurement(source)) return {};
  Measurement measurement{.nodes = measured_nodes(source), .itself = {}, .quality = {}};
  if (!only.empty()) measurement.nodes = nodes_of(measurement.nodes, parse_node_part(only));
  measurement.itself = node_figures(measurement.nodes, scored);
  if (const auto* scattered = std::get_if<ScatteredBrdf>(&source.brdf))
    measurement.between = scattered->kriged();
  if (measurement.between) measurement.expected = expected_error(*measurement.between, scored);
  return measurement;
}

std::vector<ComparedFigures> compare_models(const Scorer& scorer, std::span<const ComparedModel> models,
                                            const Measurement* measurement) {
  const std::vector<AlbedoAt> reference = albedo_curve(scorer.reference(), kAlbedoAngles);
  std::vector<ComparedFigures> result;
  for (const ComparedModel& model : models) {
    ComparedFigures& c = result.emplace_back(
        ComparedFigures{model.name, model.bytes, model.note, score_of(scorer, model), {}});
    for (const AlbedoAt& at : reference)
      c.albedos.push_back({at.theta_i, at.phi_i, at.albedo,
                           directional_albedo(model.brdf, spherical_direction(at.theta_i, at.phi_i))});
    if (measurement) c.nodes = node_figures(measurement->nodes, model.brdf);
    if (measurement && measurement->between) c.expected = expected_error(*measurement->between, model.brdf);
  }
  return result;
}

double psnr_of_disc(double psnr) noexcept {
  return psnr + 10 * std::log10(kPi / 4);
}

std::string to_json(std::span<const ComparedFigures> figures, const Measurement* measurement) {
  return dump(json_of(figures, measurement));
}

std::string nodes_json(const Measurement& measurement, std::span<const ComparedModel> models) {
  auto list = nlohmann::ordered_json::array();
  const auto add = [&](std::string_view name, std::optional<std::uint64_t> bytes,
                       const NodeFigures& figures) {
    nlohmann::ordered_json entry = {{"model", name}, {"bytes", nullptr}};
    if (bytes) entry["bytes"] = *bytes;
    entry.update(node_json(figures));
    list.push_back(std::move(entry));
  };
  add("the reference itself", {}, measurement.itself);
  for (const ComparedModel& model : models)
    add(model.name, model.bytes, node_figures(measurement.nodes, model.brdf));
  return dump(list);
}

Plot albedo_plot(std::span<const ComparedFigures> figures) {
  Plot plot{.title = "Directional albedo",
            .x_label = "θ_i (degrees)",
            .y_label = "albedo",
            .series = {},
            .x_min = 0,
            .x_max = 90,
            .y_min = 0};
  const auto add = [&](const ComparedFigures& c, double phi, const std::string& label, bool reference) {
    PlotSeries series{
        label, {}, {}, PlotStyle::line, reference ? std::string(kReferenceColor) : std::string()};
    if (reference) series.style = PlotStyle::dashed;
    for (const ComparedAlbedo& a : c.albedos) {
      if (a.phi_i != phi) continue;
      const std::vector<double>& albedo = (reference ? a.reference : a.model).albedo;
      series.x.push_back(degrees(a.theta_i));
      series.y.push_back(std::accumulate(albedo.begin(), albedo.end(), 0.0) /
                         static_cast<double>(albedo.size()));
    }
    plot.series.push_back(std::move(series));
  };
  if (figures.empty()) return plot;
  const bool turned = figures.front().albedos.size() > kAlbedoAngles.size();
  for (const double phi : turned ? std::vector{0.0, kHalfPi} : std::vector{0.0}) {
    const std::string at = turned ? fmt::format(", φ_i = {:.0f}°", degrees(phi)) : std::string();
    add(figures.front(), phi, "reference" + at, true);
    for (const ComparedFigures& c : figures) add(c, phi, c.name + at, false);
  }
  return plot;
}

Plot incidence_plane_plot(BrdfRef reference, std::span<const ComparedModel> models, double theta_i) {
  Plot plot{.title = fmt::format("Plane of incidence, θ_i = {:.0f}°", degrees(theta_i)),
            .x_label = "θ_o (degrees), mirror direction positive",
            .y_label = "f (1/sr)",
            .log_y = true,
            .series = {},
            .x_min = -90,
            .x_max = 90};
  const Vec3 wi = spherical_direction(theta_i, kPi);
  const auto add = [&](BrdfRef brdf, const std::string& name, PlotStyle style, std::string_view color) {
    PlotSeries series{name, {}, {}, style, std::string(color)};
    std::vector<double> f(brdf.channels());
    for (int half_deg = -178; half_deg <= 178; ++half_deg) {
      const double theta = radians(0.5 * half_deg);
      const bool known = brdf.eval(wi, {std::sin(theta), 0, std::cos(theta)}, f);
      double mean = 0;
      for (const double value : f) mean += value / static_cast<double>(f.size());
      series.x.push_back(0.5 * half_deg);
      series.y.push_back(known ? mean : std::numeric_limits<double>::quiet_NaN());
    }
    plot.series.push_back(std::move(series));
  };
  add(reference, "reference", PlotStyle::dashed, kReferenceColor);
  for (const ComparedModel& model : models) add(model.brdf, model.name, PlotStyle::line, "");
  return plot;
}

Plot error_plot(std::span<const ComparedModel> models, std::span<const std::vector<PairError>> errors,
                ErrorAxis axis, const MeasurementQuality* measurement) {
  const bool over_h = axis == ErrorAxis::theta_h;
  Plot plot{.title = fmt::format("Mean log error over {}", over_h ? "θ_h" : "θ_d"),
            .x_label = over_h ? "θ_h (degrees)" : "θ_d (degrees)",
            .y_label = "mean |Δ log f|",
            .series = {},
            .x_min = 0,
            .x_max = 90,
            .y_min = 0};
  constexpr std::size_t kBins = 18;
  const auto add = [&](PlotSeries series, std::span<const PairError> of) {
    std::array<double, kBins> sums{}, counts{};
    for (const PairError& error : of) {
      const HalfDiff angles = to_half_diff(error.pair.wi, error.pair.wo);
      const double theta = over_h ? angles.theta_h : angles.theta_d;
      const std::size_t bin = std::min(static_cast<std::size_t>(theta / kHalfPi * kBins), kBins - 1);
      sums[bin] += error.log_ratio;
      ++counts[bin];
    }
    for (std::size_t bin = 0; bin < kBins; ++bin)
      if (counts[bin] > 0) {
        series.x.push_back(90 * (static_cast<double>(bin) + 0.5) / kBins);
        series.y.push_back(sums[bin] / counts[bin]);
      }
    plot.series.push_back(std::move(series));
  };
  if (measurement)
    add({std::string(name_of(*measurement)), {}, {}, PlotStyle::dashed, std::string(kReferenceColor)},
        measurement->errors);
  for (std::size_t i = 0; i < models.size(); ++i)
    add({models[i].name, {}, {}, PlotStyle::line_and_points}, errors[i]);
  return plot;
}

namespace {

ColorBar difference_bar(double scale) {
  return {scale, "mean |difference| of the shown values"};
}

// Returns the sheet of all models side by side, with the reference's spheres already in it. Each light has a
// row of spheres and a row of differences.
ContactSheet start_overview(const fs::path& folder, const std::string& reference_name,
                            const SpherePictures& reference, double scale) {
  ContactSheet overview{reference_name, {"reference"}, {}, {}, difference_bar(scale)};
  for (std::size_t i = 0; i < kSphereLights.size(); ++i) {
    overview.row_labels.insert(overview.row_labels.end(), {light_text(i), "difference"});
    overview.cells.push_back({to_image8(reference.shown[i])});
    overview.cells.push_back({Image8{}});
    write_png(folder / "spheres" / fmt::format("reference_{:.0f}.png", degrees(kSphereLights[i])),
              overview.cells[2 * i][0]);
  }
  return overview;
}

// Writes the spheres, a sheet for every model and the overview of all.
void write_pictures(const fs::path& folder, const std::string& reference_name, const Scorer& scorer,
                    std::span<const ComparedModel> models, std::span<const ComparedFigures> compared) {
  // The sheets need every model's spheres and the end of its colour scale.
  const SpherePictures& reference = scorer.reference_pictures();
  const int size = scorer.options().image_size;
  std::vector<SpherePictures> pictures;
  for (const ComparedModel& model : models) pictures.push_back(scorer.pictures(model.brdf));
  std::vector<double> scales;
  for (const SpherePictures& model : pictures) scales.push_back(heat_scale(reference, model));
  const auto dome = [size](BrdfRef brdf) { return tone_map(render_dome(brdf, size), 1); };
  const Image reference_dome = dome(scorer.reference());

  // The overview has the median model's scale, so that one bad model does not hide the differences of the other models.
  std::vector<double> sorted = scales;
  std::ranges::sort(sorted);
  const double shared_scale = sorted[(sorted.size() - 1) / 2];
  ContactSheet overview = start_overview(folder, reference_name, reference, shared_scale);

  for (std::size_t m = 0; m < models.size(); ++m) {
    // Each light adds a row to the model's own sheet and to the overview.
    ContactSheet sheet{
        reference_name, {"reference", heading(compared[m]), "difference"}, {}, {}, difference_bar(scales[m])};
    overview.column_labels.push_back(heading(compared[m]));
    for (std::size_t i = 0; i < kSphereLights.size(); ++i) {
      const Image8 model = to_image8(pictures[m].shown[i]);
      const Image difference = mean_difference(reference.shown[i], pictures[m].shown[i]);
      const Image8 heat = heat_map(difference, scales[m]);
      sheet.row_labels.push_back(light_text(i));
      sheet.cells.push_back({overview.cells[2 * i][0], model, heat});
      overview.cells[2 * i].push_back(model);
      overview.cells[2 * i + 1].push_back(heat_map(difference, shared_scale));
      const auto name = fmt::format("model_{}_{:.0f}", m + 1, degrees(kSphereLights[i]));
      write_png(folder / "spheres" / (name + ".png"), model);
      write_png(folder / "spheres" / (name + "_difference.png"), heat);
    }

    // The dome stands on the model's own sheet only.
    const Image model_dome = dome(models[m].brdf);
    sheet.row_labels.push_back("dome");
    sheet.cells.push_back({to_image8(reference_dome), to_image8(model_dome),
                           heat_map(mean_difference(reference_dome, model_dome), scales[m])});
    write_png(folder / fmt::format("model_{}.png", m + 1), compose(sheet));
  }
  write_png(folder / "overview.png", compose(overview));
}

void write_factors(const fs::path& folder, std::span<const ComparedModel> models) {
  for (std::size_t m = 0; m < models.size(); ++m) {
    if (!models[m].factored) continue;
    fs::create_directories(folder / "factors");
    for (const Table& table : models[m].factored->tables())
      write_png(folder / factor_file(m, table), factor_image(table));
  }
}

// Writes the plots; returns their names.
std::vector<std::string> write_plots(const fs::path& folder, const Scorer& scorer,
                                     std::span<const ComparedModel> models,
                                     std::span<const ComparedFigures> compared,
                                     const MeasurementQuality* measurement) {
  std::vector<std::string> plots;
  const auto save = [&](const std::string& name, const Plot& plot) {
    write_plot(folder / name, plot);
    plots.push_back(name);
  };
  for (const double theta_i : kSliceAngles)
    save(fmt::format("slice_{:.0f}", degrees(theta_i)),
         incidence_plane_plot(scorer.reference(), models, theta_i));
  std::vector<std::vector<PairError>> errors;
  for (const ComparedModel& model : models) errors.push_back(scorer.pair_errors(model.brdf));
  save("error_theta_h", error_plot(models, errors, ErrorAxis::theta_h, measurement));
  save("error_theta_d", error_plot(models, errors, ErrorAxis::theta_d, measurement));
  save("albedo", albedo_plot(compared));
  return plots;
}

}  // namespace

std::vector<ComparedFigures> write_report(const fs::path& folder, const std::string& reference_name,
                                          const Scorer& scorer, std::span<const ComparedModel> models,
                                          const Measurement* measurement) {
  if (models.empty()) throw Error("a report needs a model to compare");
  const std::vector<ComparedFigures> compared = compare_models(scorer, models, measurement);
  const MeasurementQuality* quality = measurement && measurement->quality ? &*measurement->quality : nullptr;
  std::error_code error;
  fs::create_directories(folder / "spheres", error);
  if (error) throw Error::in_file(folder.string(), "a folder to write to", error.message());

  write_pictures(folder, reference_name, scorer, models, compared);
  write_factors(folder, models);
  const std::vector<std::string> plots = write_plots(folder, scorer, models, compared, quality);

  const FigureOptions& options = scorer.options();
  const nlohmann::ordered_json report = {{"reference", reference_name},
                                         {"pairs", options.count},
                                         {"seed", options.seed},
                                         {"floor", options.floor},
                                         {"image_size", options.image_size},
                                         {"models", json_of(compared, measurement)}};
  write_then_rename(folder / "report.json", dump(report));
  write_then_rename(folder / "index.html",
                    index_html(reference_name, models, compared, options, plots, measurement));
  return compared;
}

}  // namespace burnish
