// SPDX-License-Identifier: Apache-2.0
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

/// The source of the normals that a fit uses.
enum class NormalsFrom { capture, flat, estimate };

struct SurfaceFitOptions {
  std::size_t lobes = 6;              ///< 1 to kMaxSurfaceLobes
  std::size_t lobe_bytes = 24 << 10;  ///< bytes of each lobe's tables, [kMinLobeBytes, kMaxLobeBytes]
  /// Lobes that are known: only weights are fitted. Each of the model's lobes has a weight.
  std::optional<FactoredBrdf> book = {};
  /// None: the capture's normals, or estimated ones if it has none. Samples have flat ones, since their directions
  /// refer to the normals.
  std::optional<NormalsFrom> normals = {};
  /// Rounds, which alternate between lobes and weights, 1 to kMaxSurfaceRounds. None: 9, or 24 if normals are
  /// estimated.
  std::optional<int> rounds = {};
  /// Adds copies of the lobes, widened by the bumps that mip levels lose. Each copy costs one more fetch per light.
  bool widened = false;
  std::size_t tile_bytes = 256 << 20;  ///< bytes of pictures in memory at a time
  std::uint64_t seed = 1;              ///< for the texels and pixels that lobes are fitted to
  /// A file that records the progress, written after each round and each part; empty: none. A fit resumes from an
  /// existing file of the same capture and options. The file stays: the caller removes it once the result is saved.
  std::filesystem::path checkpoint = {};
  /// The ranks that share the work; null: this process alone. Rank 0 calls fit_surface, the other ranks
  /// help_fit_surface, with the same capture and options.
  FitCrew* crew = nullptr;
  /// Called from the calling thread with the current stage and a rising share of it. An exception that it throws ends
  /// the fit.
  std::function<void(std::string_view stage, double fraction)> progress = {};
};

inline constexpr std::size_t kMinLobeBytes = 512, kMaxLobeBytes = 1 << 20;

/// PSNR of pictures as they are seen: min(1, exposure f cos)^(1/2.2), the mean over all of them. It is infinite if
/// there is no error, and empty if there is no picture.
struct PictureScore {
  std::optional<double> psnr;         ///< without the pixels that masks leave out
  std::optional<double> psnr_of_all;  ///< with these pixels
  std::size_t pictures = 0;
};

struct SurfaceReport {
  std::size_t width = 0, height = 0, pictures = 0, lobes = 0;
  /// The number of different pairs of a light and a view among the fitted pictures; 0 for samples. Few pairs say
  /// little about lobes, however many pictures there are.
  std::size_t lights_and_views = 0;
  bool of_samples = false;  ///< texels have their own samples, at most as many as there are pictures
  std::vector<Capture::LeftOut> left_out;
  std::size_t missing_pixels = 0, clipped_pixels = 0;  ///< in the fitted pictures
  std::size_t texels_without_data = 0;                 ///< texels that no fitted picture shows
  NormalsFrom normals = NormalsFrom::flat;
  double exposure = 1;  ///< makes the 97th percentile of the fitted pixels white
  PictureScore fitted, held_out;
  std::size_t weight_bytes = 0, frame_bytes = 0, lobe_bytes = 0;  ///< the first two a texel
  double bytes_a_texel = 0;                                       ///< weights and lobes, normals apart
  double seconds = 0;
  double weight_seconds = 0;                 ///< without reading, for weights and normals of all texels
  int resumed_rounds = 0, resumed_rows = 0;  ///< rounds of lobes and rows of weights taken from a checkpoint
};

struct SurfaceFit {
  SurfaceModel surface;
  SurfaceReport report;
};

/// Fits a capture. Lobes are fitted to a sample of texels spread over the surface, then the weights of all texels are
/// fitted, tile by tile.
///
/// General lobes are fitted to the sampled texels first, and their weights group the texels into clusters. Each lobe
/// starts as the log-linear fit to one cluster [HomomorphicBrdf, eq. 5]. Then weights (TexelSolver) and lobes
/// (refine, with the pixels' weights) are found in turn. Weights are stored in 8 bits.
///
/// The result has the same bits for any number of threads, any tile size, and whether or not the fit was resumed.
/// Pictures that turn out damaged are left out and reported. Throws Error for options out of range, and what Capture
/// throws.
SurfaceFit fit_surface(Capture capture, const SurfaceFitOptions& options);

/// Takes part in fit_surface at all ranks of options.crew except 0. Finds this rank's share of the lobes, which all
/// ranks exchange, and the weights of its rows, which rank 0 gathers. Only rank 0 reports progress and writes
/// checkpoints. The result is the same to the bit for any number of ranks. Throws Error as fit_surface does. If one
/// rank throws, the ranks that wait for it have to be ended by the program that started them.
void help_fit_surface(Capture capture, const SurfaceFitOptions& options);

/// Returns the report as JSON.
std::string report_json(const SurfaceReport& report);

}  // namespace burnish
