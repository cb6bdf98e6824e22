// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <burnish/capture/surface_normals.h>
#include <burnish/capture/surface_weights.h>
#include <burnish/error.h>
#include <burnish/surface/surface_map.h>

namespace burnish {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Writes the checkpoint of rows now and then. It always holds all finished rows. So it is written only once
/// kWorthOfASave times the duration of the last writing has passed, or after one of kSavedParts parts of the surface.
class RowNotes {
 public:
  /// Starts with the lobes, before any row is done.
  RowNotes(const SurfaceTask& task, const FitCheckpoint& done, int height)
      : task_(task), done_(done), part_(std::max(height / kSavedParts, 1)), saved_(done.rows) {
    if (done.rows == 0) save();
    saved_at_ = Clock::now();
  }

  /// Called after each turn.
  void note() {
    if (seconds_since(saved_at_) < kWorthOfASave * save_seconds_ && done_.rows - saved_ < part_) return;
    save();
    saved_ = done_.rows;
    saved_at_ = Clock::now();
  }

 private:
  static constexpr double kWorthOfASave = 20;
  static constexpr int kSavedParts = 16;

  void save() {
    const Clock::time_point start = Clock::now();
    if (task_.notes_progress()) write_then_rename(task_.options.checkpoint, format_checkpoint(done_));
    save_seconds_ = seconds_since(start);
  }

  const SurfaceTask& task_;
  const FitCheckpoint& done_;
  int part_, saved_;
  double save_seconds_ = 0;
  Clock::time_point saved_at_;
};

/// Returns the rows of a tile: as many as memory holds. Several ranks take an even part of the rows.
int tile_rows(const Capture& capture, const SurfaceTask& task) {
  const int most = capture.rows_within(task.options.tile_bytes), ranks = task.ranks();
  if (ranks == 1) return most;
  constexpr int kMinTurns = 4;  // turns of each rank; a lost turn then costs little
  const int height = capture.form().height;
  const int turns = std::max(kMinTurns, (height + most * ranks - 1) / (most * ranks));
  return std::max(1, (height + turns * ranks - 1) / (turns * ranks));
}

/// Returns the weights, and normals, of all texels of some rows, before rounding.
TexelFits fit_rows(const CaptureForm& form, const SurfaceTask& task, double exposure,
                   const TexelSolver& solver, const TexelSamples& samples) {
  const bool estimate = task.normals == NormalsFrom::estimate;
  std::vector<float> normals = estimate ? first_normals(samples, form, exposure, nullptr)
                                        : normals_at(samples.texels, task.known_normals, form.width);
  return solver.solve(samples, std::move(normals), {.passes = 3, .normals = estimate, .normal_steps = 8});
}

/// Rounds the fits to what is stored, and keeps them in the tile.
void store(TexelFits& fits, int width, FitCheckpoint& tile) {
  const std::vector<float>& scales = tile.scales;
  const std::size_t lobes = scales.size(), count = fits.weights.size() / lobes;
  const int rows = static_cast<int>(count) / width;
  for (std::size_t j = 0; j < lobes; ++j) {
    std::vector<float> weights(count);
    for (std::size_t t = 0; t < count; ++t) weights[t] = std::min(fits.weights[t * lobes + j], scales[j]);
    const SurfaceMap map(width, rows, 1, TableFormat::unorm8, scales[j], weights);
    tile.codes[j].assign(map.stored_bytes().begin(), map.stored_bytes().end());
    for (std::size_t t = 0; t < count; ++t)
      fits.weights[t * lobes + j] = map.texel(static_cast<int>(t) % width, static_cast<int>(t) / width)[0];
  }
  if (fits.normals.empty()) return;
  fits.normals = rounded_normals(fits.normals, width);
  tile.normals = fits.normals;
}

/// Returns the number of texels that no fitted picture shows.
std::size_t without_data(const TexelSamples& samples, const CaptureForm& form) {
  std::vector<char> shown(samples.size());
  for (std::size_t p = 0; p < samples.pictures; ++p) {
    if (form.pictures[p].held_out) continue;
    const PixelState* const states = &samples.states[p * samples.size()];
    for (std::size_t t = 0; t < samples.size(); ++t) shown[t] |= static_cast<char>(is_there(states[t]));
  }
  return static_cast<std::size_t>(std::ranges::count(shown, 0));
}

/// Returns an empty tile of the same lobes.
FitCheckpoint empty_tile(const FitCheckpoint& done) {
  FitCheckpoint tile{.lobes = done.lobes, .scales = done.scales, .codes = {}, .normals = {}, .errors = {}};
  tile.codes.resize(done.codes.size());
  return tile;
}

/// Reads at least one row, fits and scores the rows, and adds to the seconds.
FitCheckpoint fitted_tile(const Capture& capture, const SurfaceTask& task, const TexelSolver& solver,
                          const FitCheckpoint& done, int row, int rows, double& seconds) {
  const CaptureForm& form = capture.form();
  Capture::Read read = capture.read(row, rows);
  if (!read.damaged.empty())
    throw Error::in_file(capture.file(read.damaged.front().file).string(),
                         "a picture that stays as it was when it was read first", read.damaged.front().why);
  const TexelSamples samples = samples_of(std::move(read.rows));
  FitCheckpoint tile = empty_tile(done);
  const Clock::time_point start = Clock::now();
  TexelFits fits = fit_rows(form, task, done.exposure, solver, samples);
  store(fits, form.width, tile);
  seconds += seconds_since(start);
  tile.errors = solver.errors(samples, fits);
  tile.texels_without_data = without_data(samples, form);
  tile.rows = rows;
  return tile;
}

void append(const FitCheckpoint& tile, FitCheckpoint& done) {
  done.texels_without_data += tile.texels_without_data;
  for (std::size_t j = 0; j < done.codes.size(); ++j)
    done.codes[j].insert(done.codes[j].end(), tile.codes[j].begin(), tile.codes[j].end());
  done.normals.insert(done.normals.end(), tile.normals.begin(), tile.normals.end());
  for (std::size_t p = 0; p < tile.errors.size(); ++p) done.errors[p] += tile.errors[p];
}

}  // namespace

SurfaceWeights find_weights(const Capture& capture, const SurfaceTask& task, FitCheckpoint begun) {
  const CaptureForm& form = capture.form();
  SurfaceWeights found{.done = std::move(begun), .seconds = 0};
  FitCheckpoint& done = found.done;
  done.codes.resize(done.lobes.lobes().size());
  done.errors.resize(form.pictures.size());
  const TexelSolver solver(done.lobes, form, done.exposure);
  const int ranks = task.ranks(), step = tile_rows(capture, task);
  RowNotes notes(task, done, form.height);
  while (done.rows < form.height) {
    // Each rank finds one tile; rank 0 joins the tiles in their order.
    const int begin = done.rows, end = std::min(begin + ranks * step, form.height),
              row = std::min(begin + task.rank() * step, end), rows = std::min(step, end - row);
    const FitCheckpoint tile =
        rows > 0 ? fitted_tile(capture, task, solver, done, row, rows, found.seconds) : empty_tile(done);
    if (ranks == 1) {
      append(tile, done);
    } else {
      for (const std::string& sent : task.options.crew->gather(format_checkpoint(tile))) {
        const auto bytes = std::as_bytes(std::span(sent));
        append(parse_checkpoint({"what a rank sent", {bytes.begin(), bytes.end()}}, form.width), done);
      }
    }
    done.rows = end;
    notes.note();
    task.progress("fitting weights", static_cast<double>(done.rows) / form.height);
  }
  return found;
}

PictureScore score_of(const std::vector<TexelSolver::PictureError>& errors, const CaptureForm& form,
                      bool held_out) {
  PictureScore score;
  double seen = 0, all = 0;
  std::size_t seen_pictures = 0, all_pictures = 0;
  for (std::size_t p = 0; p < errors.size(); ++p) {
    if (form.pictures[p].held_out != held_out) continue;
    ++score.pictures;
    if (const auto mean = errors[p].seen_mean()) {
      seen += *mean;
      ++seen_pictures;
    }
    if (const auto mean = errors[p].all_mean()) {
      all += *mean;
      ++all_pictures;
    }
  }
  const auto psnr = [](double sum, std::size_t count) -> std::optional<double> {
    if (count == 0) return std::nullopt;
    return -10 * std::log10(sum / static_cast<double>(count));
  };
  score.psnr = psnr(seen, seen_pictures);
  score.psnr_of_all = psnr(all, all_pictures);
  return score;
}

}  // namespace burnish
