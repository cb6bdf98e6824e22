#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/ranks/fit_crew.h>
#include <burnish/capture/texels/texel_solver.h>
#include <burnish/surface/surface_file.h>

namespace burnish {

inline constexpr int kMaxSurfaceRounds = 100;

/// What normals a fit takes.
enum class NormalsFrom { capture, flat, estimate };

struct SurfaceFitOptions {
  std::size_t lobes = 6;              ///< 1 to kMaxSurfaceLobes
  std::size_t lobe_bytes = 24 << 10;  ///< of each lobe's tables, [kMinLobeBytes, kMaxLobeBytes]
  /// Lobes that are known: weights alone are fitted. Each of the model's lobes has a weight.
  std::optional<FactoredBrdf> book = {};
  /// None: those of the capture, or estimated where it has none; flat of samples, whose directions are about them.
  std::optional<NormalsFrom> normals = {};
  /// Of lobes and weights in turn, 1 to kMaxSurfaceRounds; none: 9, where normals are estimated 24.
  std::optional<int> rounds = {};
  /// Copies of the lobes, widened by the bumps that mip levels lose; each costs a light one fetch more.
  bool widened = false;
  std::size_t tile_bytes = 256 << 20;  ///< of pictures in memory at a time
  std::uint64_t seed = 1;              ///< of the texels and pixels that lobes are fitted to
  /// A file that says how far the work is, written after each round and part; empty: none. One that is there and of the
  /// same capture and options is gone on from. It stays: the caller removes it, once the result is kept.
  std::filesystem::path checkpoint = {};
  /// Ranks that share the work; null: this process alone. Rank 0 calls fit_surface, the others
  /// help_fit_surface, with the same capture and options.
  FitCrew* crew = nullptr;
  /// Called from the calling thread with what is done and a rising share of it. What it throws ends the fit.
  std::function<void(std::string_view stage, double fraction)> progress = {};
};

inline constexpr std::size_t kMinLobeBytes = 512, kMaxLobeBytes = 1 << 20;

/// PSNR of pictures as they are seen: min(1, exposure f cos)^(1/2.2), the mean over all of them; infinite where there
/// is no error, nothing where there is no picture.
struct PictureScore {
  std::optional<double> psnr;         ///< pixels that masks leave out do not count
  std::optional<double> psnr_of_all;  ///< they do
  std::size_t pictures = 0;
};

struct SurfaceReport {
  std::size_t width = 0, height = 0, pictures = 0, lobes = 0;
  /// Pairs of a light and a view, counted once each, of the pictures that are fitted; of samples 0. Few pairs say
  /// little about lobes, however many pictures there are.
  std::size_t lights_and_views = 0;
  bool of_samples = false;  ///< texels have samples of their own, at most as many as there are pictures
  std::vector<Capture::LeftOut> left_out;
  std::size_t missing_pixels = 0, clipped_pixels = 0;  ///< of the pictures that are fitted
  std::size_t texels_without_data = 0;                 ///< that none of these shows
  NormalsFrom normals = NormalsFrom::flat;
  double exposure = 1;  ///< what makes the 97th percentile of the fitted pixels white
  PictureScore fitted, held_out;
  std::size_t weight_bytes = 0, frame_bytes = 0, lobe_bytes = 0;  ///< the first two a texel
  double bytes_a_texel = 0;                                       ///< weights and lobes, normals apart
  double seconds = 0;
  double weight_seconds = 0;  ///< of these in weights and normals of all texels, without reading
  int resumed_rounds = 0, resumed_rows = 0;  ///< of lobes and of weights, that a checkpoint already had
};

struct SurfaceFit {
  SurfaceModel surface;
  SurfaceReport report;
};

/// Fits a capture: lobes by samples of texels spread over the surface, then the weights of all texels, tile by tile.
/// Lobes start from clusters of texels, found by what a few general lobes make of them, each as the log-linear fit to
/// its texels [HomomorphicBrdf, eq. 5]; then weights (TexelSolver) and lobes (refine, the pixels' weights in it) are
/// found in turn. Weights are stored in 8 bits. The same bits for any number of threads, tile size, and whether it was
/// resumed or not. Takes pictures out that turn out damaged and says so. Throws Error for options out of range, and
/// what Capture throws.
SurfaceFit fit_surface(Capture capture, const SurfaceFitOptions& options);

/// What ranks other than 0 of options.crew call: finds its share of lobes, which all exchange, and the weights of its
/// rows, which rank 0 gathers. Progress and checkpoint are rank 0's. The result is the same to the bit for any count of
/// ranks. Throws Error as fit_surface does; the ranks that wait for one that threw have to be ended by whoever started
/// them.
void help_fit_surface(Capture capture, const SurfaceFitOptions& options);

/// The report as JSON.
std::string report_json(const SurfaceReport& report);

}  // namespace burnish
