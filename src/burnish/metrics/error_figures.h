// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <burnish/metrics/sphere_images.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/pair_error.h>

namespace burnish {

/// The errors of a model f^ against a reference f, both in 1/sr. Means run over direction pairs and channels alike.
/// Values below 0 (a source kept raw) count as 0.
struct ErrorFigures {
  double log_cos = 0;           ///< mean |ln(1 + f cos theta_i) - ln(1 + f^ cos theta_i)| [Low 2012]
  double relative = 0;          ///< exp(mean |ln((f + floor) / (f^ + floor))|) - 1
  double rms_log = 0;           ///< root of the mean square of ln((f + floor) / (f^ + floor))
  double rms = 0;               ///< root of the mean square of f - f^, 1/sr: the highlight's peak rules it
  double mean_abs_log = 0;      ///< mean |ln(f / f^)| over values where both are above 0; 0 if there are none
  double psnr = 0;              ///< dB, of the mean squared error of the three lit spheres; infinite if equal
  double ssim = 0;              ///< mean of the three lit spheres
  double unknown_fraction = 0;  ///< share of the pairs left out because a side knows nothing there
  std::size_t unknown_pixels = 0;  ///< pixels of the three spheres left out, the reference knowing nothing
};

/// The pairs that are drawn and their weights; the defaults are the definition.
struct FigureOptions {
  std::size_t count = 200'000;  ///< direction pairs, see draw_pairs
  std::uint64_t seed = 1;
  double floor = 1e-3;  ///< 1/sr, in `relative` and `rms_log`
  int image_size = kSphereSize;
};

/// The three lit spheres of one BRDF and what is shown of them.
struct SpherePictures {
  std::array<LitSphere, kSphereLights.size()> spheres;
  std::array<Image, kSphereLights.size()> shown;  ///< exposed, clamped, gamma encoded
};

/// Measures models against one reference, whose values and pictures are computed once. Deterministic: the
/// same figures, to the last bit, for every number of threads. Both sides are taken as they come: wrap what
/// shall be symmetrized in SymmetrizedBrdf. Between one channel and several, grey stands for every channel.
/// Where the reference knows nothing, pixels are black in both pictures and counted; where only the model
/// knows nothing, its pixels are scored as the black it returns.
class Scorer {
 public:
  /// The reference must outlive the scorer. Throws Error if count is 0, floor is negative or the image size
  /// is outside [16, 8192].
  explicit Scorer(BrdfRef reference, const FigureOptions& options = {});

  /// Throws Error if the channel counts do not fit or no drawn pair is known on both sides.
  ErrorFigures score(BrdfRef model) const;

  /// Errors of the drawn pairs that both sides know, in the order drawn. phi_h varies unless both are
  /// isotropic. Throws Error if the channel counts do not fit.
  std::vector<PairError> pair_errors(BrdfRef model) const;

  /// The model's pictures under the reference's exposure.
  SpherePictures pictures(BrdfRef model) const;

  /// The psnr of score, in dB, of pictures(model).
  double picture_psnr(const SpherePictures& pictures) const;

  BrdfRef reference() const noexcept { return reference_; }
  const SpherePictures& reference_pictures() const noexcept { return pictures_; }
  double exposure() const noexcept { return exposure_; }
  const FigureOptions& options() const noexcept { return options_; }

 private:
  struct Evaluated {
    std::vector<DirectionPair> pairs;
    std::vector<double> values;
    std::vector<std::uint8_t> known;
  };
  static Evaluated evaluate(BrdfRef brdf, std::vector<DirectionPair> pairs);
  void tone_map_known(SpherePictures& pictures) const;

  BrdfRef reference_;
  FigureOptions options_;
  Evaluated evaluated_;
  SpherePictures pictures_;
  double exposure_ = 1;
};

/// Scorer(reference, options).score(model).
ErrorFigures error_figures(BrdfRef reference, BrdfRef model, const FigureOptions& options = {});

}  // namespace burnish
