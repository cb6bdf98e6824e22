// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/texels/texel_samples.h>
#include <burnish/eval/lobe_evaluator.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// Values that are known of texels, or found.
struct TexelFits {
  std::vector<float> weights;  ///< [texel][lobe], >= 0
  std::vector<float> normals;  ///< x and y, [texel][2]
  /// The trust in each pixel, in [0, 1]; [picture][texel]. It is 0 for missing pixels and held-out pictures, and
  /// small for pixels far from the model. Clipped channels below the model count as no error. Empty unless
  /// Options::trust is set.
  std::vector<float> trust;
  /// The remaining cost of each texel's errors; empty unless Options::costs is set.
  std::vector<double> costs;
};

/// Fits weights, and on request normals, of texels whose lobes are known. It minimizes the squared errors of pixels
/// as they are seen, about (exposure f cos)^(1/2). Errors beyond a few percent of white count less and less (weights
/// of [GemanMcClure1987]), so that shadows and misregistered edges have little influence. Clipped pixels count if the
/// model is below them. Texels are independent: the result has the same bits for any number of threads and any cut
/// into blocks.
class TexelSolver {
 public:
  /// Takes lobes of three channels, at most kMaxSurfaceLobes. `exposure` makes white 1.
  TexelSolver(const FactoredBrdf& lobes, const CaptureForm& form, double exposure);

  struct Options {
    int passes = 3;        ///< passes of reweighted least squares
    bool normals = false;  ///< find normals too, from those given
    int normal_steps = 4;  ///< Gauss-Newton steps, each followed by a fit of weights
    bool trust = false;    ///< fill TexelFits::trust
    bool costs = false;    ///< fill TexelFits::costs
  };
  TexelFits solve(const TexelSamples& samples, std::vector<float> normals, const Options& options) const;

  /// Squared differences of min(1, exposure f cos)^(1/2.2) between pictures and model, summed over channels, each to
  /// 1e-6. If a picture's channel is clipped, the model is clipped at the same value, as the camera would have done.
  /// The sums are integers in units of kUnit, so that they do not depend on the order.
  struct PictureError {
    static constexpr double kUnit = 0x1p-32;
    std::uint64_t seen = 0, all = 0;              ///< over unmasked pixels, and over all that have values
    std::uint64_t seen_count = 0, all_count = 0;  ///< values, three a pixel

    PictureError& operator+=(const PictureError& other) noexcept {
      seen += other.seen;
      all += other.all;
      seen_count += other.seen_count;
      all_count += other.all_count;
      return *this;
    }
    /// Returns the mean squares; nothing if there is no value.
    std::optional<double> seen_mean() const noexcept { return mean(seen, seen_count); }
    std::optional<double> all_mean() const noexcept { return mean(all, all_count); }

   private:
    static std::optional<double> mean(std::uint64_t sum, std::uint64_t count) noexcept {
      if (count == 0) return std::nullopt;
      return static_cast<double>(sum) * kUnit / static_cast<double>(count);
    }
  };
  /// Returns the errors of every picture; `all` includes the pixels that masks leave out.
  std::vector<PictureError> errors(const TexelSamples& samples, const TexelFits& fits) const;

  std::size_t lobes() const noexcept { return evaluator_.lobes(); }

 private:
  LobeEvaluator evaluator_;
  const CaptureForm& form_;
  double exposure_;
};

}  // namespace burnish
