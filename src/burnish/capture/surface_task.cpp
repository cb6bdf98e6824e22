// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <burnish/capture/surface_report_json.h>
#include <burnish/capture/surface_task.h>
#include <burnish/error.h>
#include <burnish/factors/compact_file.h>

namespace burnish {

namespace {

// Normals and what is narrow in lobes sharpen each other, a little a round.
constexpr int kRounds = 9, kRoundsOfNormals = 24;

void check_ranges(const SurfaceFitOptions& options) {
  const std::size_t lobes = options.book ? options.book->lobes().size() : options.lobes;
  if (lobes < 1 || lobes > kMaxSurfaceLobes)
    throw Error(fmt::format("surface fit: expected 1 to {} lobes, found {}", kMaxSurfaceLobes, lobes));
  if (options.lobe_bytes < kMinLobeBytes || options.lobe_bytes > kMaxLobeBytes)
    throw Error(fmt::format("surface fit: expected lobes of {} to {} bytes, found {}", kMinLobeBytes,
                            kMaxLobeBytes, options.lobe_bytes));
  if (options.rounds && (*options.rounds < 1 || *options.rounds > kMaxSurfaceRounds))
    throw Error(
        fmt::format("surface fit: expected 1 to {} rounds, found {}", kMaxSurfaceRounds, *options.rounds));
  if (options.book && options.book->channels() != kCaptureChannels)
    throw Error(fmt::format("surface fit: expected a book of {} channels, found {}", kCaptureChannels,
                            options.book->channels()));
}

NormalsFrom normals_for(const Capture& capture, const SurfaceFitOptions& options) {
  const CaptureForm& form = capture.form();
  const NormalsFrom normals = options.normals.value_or(!form.normals.empty() ? NormalsFrom::capture
                                                       : form.own_directions ? NormalsFrom::flat
                                                                             : NormalsFrom::estimate);
  if (normals == NormalsFrom::capture && form.normals.empty())
    throw Error::in_file(capture.form_file().string(), "normals", "none");
  return normals;
}

std::uint64_t key_of(const Capture& capture, const SurfaceTask& task) {
  const SurfaceFitOptions& options = task.options;
  const std::string text =
      fmt::format("{} {} {} {} {} {} {}", capture.fingerprint(), options.book ? 0 : options.lobes,
                  options.lobe_bytes, name_of(task.normals), task.rounds, options.seed,
                  options.book ? format_compact({.brdf = *options.book, .lambda_nm = {}}) : std::string());
  return hash_of(text) & ~std::uint64_t{1};
}

}  // namespace

SurfaceTask task_of(const Capture& capture, const SurfaceFitOptions& options) {
  check_ranges(options);
  const NormalsFrom normals = normals_for(capture, options);
  SurfaceTask task{
      .options = options,
      .normals = normals,
      .rounds = options.rounds.value_or(normals == NormalsFrom::estimate ? kRoundsOfNormals : kRounds),
      .known_normals = {},
      .key = 0};
  if (normals == NormalsFrom::capture) task.known_normals = capture.normals();
  task.key = key_of(capture, task);
  return task;
}

}  // namespace burnish
