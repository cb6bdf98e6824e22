// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

#include <burnish/capture/ranks/fit_checkpoint.h>
#include <burnish/capture/ranks/fit_start.h>
#include <burnish/capture/surface_fit.h>
#include <burnish/capture/surface_lobes.h>
#include <burnish/capture/surface_report_json.h>
#include <burnish/capture/surface_task.h>
#include <burnish/capture/surface_weights.h>
#include <burnish/error.h>
#include <burnish/fitting/fit_report_json.h>
#include <burnish/surface/widened_lobes.h>

namespace burnish {

namespace {

/// The content of a checkpoint: nothing, a round of lobes, or lobes and rows.
using Resumed = std::variant<std::monostate, LobesCheckpoint, FitCheckpoint>;

Resumed resumed(const SurfaceTask& task, int width) {
  const std::filesystem::path& path = task.options.checkpoint;
  if (path.empty() || !std::filesystem::exists(path)) return {};
  const FileBytes file = read_file(path);
  const auto check = [&](std::uint64_t key) {
    if (key != task.key)
      throw Error::in_file(path.string(), "a checkpoint of this capture and these options", "one of others");
  };
  if (std::optional<LobesCheckpoint> lobes = parse_lobes_checkpoint(file)) {
    check(lobes->key);
    return std::move(*lobes);
  }
  FitCheckpoint rows = parse_checkpoint(file, width);
  check(rows.key);
  return rows;
}

/// A checkpoint of lobes that were just found, before the first row.
FitCheckpoint without_rows(SurfaceLobes found, std::uint64_t key, std::vector<Capture::LeftOut> damaged) {
  FitCheckpoint done{.key = key,
                     .damaged = std::move(damaged),
                     .missing_pixels = found.missing_pixels,
                     .clipped_pixels = found.clipped_pixels,
                     .exposure = found.exposure,
                     .lobes = std::move(found.lobes),
                     .scales = std::move(found.scales),
                     .codes = {},
                     .normals = {},
                     .errors = {}};
  done.codes.resize(done.lobes.lobes().size());
  return done;
}

FileBytes what_rank_0_sent(FitCrew& crew) {
  const std::string sent = crew.broadcast({});
  const auto bytes = std::as_bytes(std::span(sent));
  return {"what rank 0 sent", {bytes.begin(), bytes.end()}};
}

std::size_t lights_and_views(const CaptureForm& form) {
  std::vector<std::array<double, 8>> pairs;
  for (const auto& [file, light, view, scale, mask, held_out] : form.pictures)
    if (!held_out)
      pairs.push_back({light.is_direction ? 1.0 : 0.0, light.at.x, light.at.y, light.at.z,
                       view.is_direction ? 1.0 : 0.0, view.at.x, view.at.y, view.at.z});
  std::ranges::sort(pairs);
  return static_cast<std::size_t>(std::ranges::unique(pairs).begin() - pairs.begin());
}

/// Returns the surface made of all rows.
SpatialBrdf surface_of(const FitCheckpoint& done, const CaptureForm& form, bool widened) {
  SurfaceMaps maps;
  for (std::size_t j = 0; j < done.scales.size(); ++j)
    maps.weights.emplace_back(form.width, form.height, std::size_t{1}, TableFormat::unorm8, done.scales[j],
                              std::span<const std::byte>(done.codes[j]));
  if (!done.normals.empty())
    maps.normals.emplace(form.width, form.height, std::size_t{2}, TableFormat::half, 1.0f,
                         std::span<const float>(done.normals));
  SpatialBrdf brdf(done.lobes, std::move(maps));
  return widened ? with_widened_lobes(brdf) : std::move(brdf);
}

/// Returns the whole report except times and resumed parts.
SurfaceReport report_of(const FitCheckpoint& done, const SpatialBrdf& surface, const Capture& capture,
                        NormalsFrom normals) {
  const CaptureForm& form = capture.form();
  SurfaceReport report;
  report.width = static_cast<std::size_t>(form.width);
  report.height = static_cast<std::size_t>(form.height);
  report.pictures = form.pictures.size();
  report.lobes = done.scales.size();
  report.lights_and_views = form.own_directions ? 0 : lights_and_views(form);
  report.of_samples = form.own_directions;
  report.left_out = capture.left_out();
  report.missing_pixels = done.missing_pixels;
  report.clipped_pixels = done.clipped_pixels;
  report.texels_without_data = done.texels_without_data;
  report.normals = normals;
  report.exposure = done.exposure;
  report.fitted = score_of(done.errors, form, false);
  report.held_out = score_of(done.errors, form, true);
  report.weight_bytes = surface.weight_bytes();
  report.frame_bytes = surface.frame_bytes();
  report.lobe_bytes = surface.lobes().bytes();
  report.bytes_a_texel =
      static_cast<double>(report.weight_bytes) +
      static_cast<double>(report.lobe_bytes) / (static_cast<double>(form.width) * form.height);
  return report;
}

}  // namespace

SurfaceFit fit_surface(Capture capture, const SurfaceFitOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t left_out_at_first = capture.left_out().size();
  const SurfaceTask task = task_of(capture, options);

  // The fit begins at the state of the checkpoint, which the other ranks receive.
  Resumed resume = resumed(task, capture.form().width);
  FitStart start;
  int resumed_rounds = 0, resumed_rows = 0;
  if (auto* const lobes = std::get_if<LobesCheckpoint>(&resume)) {
    resumed_rounds = lobes->rounds;
    start.begun = std::move(*lobes);
  } else if (const auto* const rows = std::get_if<FitCheckpoint>(&resume)) {
    capture.leave_out(rows->damaged);
    resumed_rows = rows->rows;
    start.step = FitStep::weights;
  }
  if (task.ranks() > 1) options.crew->broadcast(format_start(start));

  // The lobes are found or resumed. The other ranks receive them as a checkpoint.
  FitCheckpoint lobes;
  if (start.step == FitStep::weights) {
    lobes = std::get<FitCheckpoint>(std::move(resume));
  } else {
    SurfaceLobes found = find_lobes(capture, task, std::move(start.begun));
    const auto damaged = std::span(capture.left_out()).subspan(left_out_at_first);
    lobes = without_rows(std::move(found), task.key, {damaged.begin(), damaged.end()});
  }
  if (task.ranks() > 1) options.crew->broadcast(format_checkpoint(lobes));

  // The weights of all rows follow, then the surface and its report.
  const SurfaceWeights weights = find_weights(capture, task, std::move(lobes));
  SpatialBrdf surface = surface_of(weights.done, capture.form(), options.widened);
  SurfaceReport report = report_of(weights.done, surface, capture, task.normals);
  report.weight_seconds = weights.seconds;
  report.resumed_rounds = resumed_rounds;
  report.resumed_rows = resumed_rows;
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::string notes = to_text(nlohmann::json(json_of(report)), -1);  // in the order of a file's reader
  return {.surface = {.brdf = std::move(surface), .notes = std::move(notes)}, .report = std::move(report)};
}

void help_fit_surface(Capture capture, const SurfaceFitOptions& options) {
  const SurfaceTask task = task_of(capture, options);
  FitStart start = parse_start(what_rank_0_sent(*options.crew));
  if (start.step == FitStep::lobes) find_lobes(capture, task, std::move(start.begun));
  FitCheckpoint lobes = parse_checkpoint(what_rank_0_sent(*options.crew), capture.form().width);
  capture.leave_out(lobes.damaged);
  find_weights(capture, task, std::move(lobes));
}

}  // namespace burnish
