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

/// What is known of texels, or found.
struct TexelFits {
  std::vector<float> weights;  ///< [texel][lobe], >= 0
  std::vector<float> normals;  ///< x and y, [texel][2]
  /// How much a pixel counts, in [0, 1]: 0 where it is missing or clipped as it should be, little where it lies far
  /// from the model; [picture][texel], 0 of held-out pictures. Empty unless asked for.
  std::vector<float> trust;
  /// What is left of each texel's errors, as they count; empty unless asked for.
  std::vector<double> costs;
};

/// Fits weights, and normals if asked for, of texels whose lobes are known. What is minimized is the squared error of
/// pixels as they are seen, about (exposure f cos)^(1/2), each pixel weighted by what it deserves: errors beyond a few
/// percent of white count less and less (weights of [GemanMcClure1987]), so that shadows and misregistered edges do not
/// lead. Clipped pixels count where the model is below them. Texels are independent: the same bits for any number of
/// threads and any cut into blocks.
class TexelSolver {
 public:
  /// Lobes of three channels, at most kMaxSurfaceLobes. `exposure` makes white 1.
  TexelSolver(const FactoredBrdf& lobes, const CaptureForm& form, double exposure);

  struct Options {
    int passes = 3;        ///< of reweighted least squares
    bool normals = false;  ///< find them too, from those given
    int normal_steps = 4;  ///< of Gauss and Newton, each followed by weights
    bool trust = false;    ///< fill TexelFits::trust
    bool costs = false;    ///< fill TexelFits::costs
  };
  TexelFits solve(const TexelSamples& samples, std::vector<float> normals, const Options& options) const;

  /// Squared differences of min(1, exposure f cos)^(1/2.2), each to 1e-6, of pictures and model, over channels; where a
  /// picture's channel is clipped, the model is clipped at its value too, as what took the picture would have done. In
  /// units of kUnit: integers add up to the same in any order.
  struct PictureError {
    static constexpr double kUnit = 0x1p-32;
    std::uint64_t seen = 0, all = 0;              ///< over pixels not masked, and over all that are there
    std::uint64_t seen_count = 0, all_count = 0;  ///< values, three a pixel

    PictureError& operator+=(const PictureError& other) noexcept {
      seen += other.seen;
      all += other.all;
      seen_count += other.seen_count;
      all_count += other.all_count;
      return *this;
    }
    /// Mean squares; nothing where there is no value.
    std::optional<double> seen_mean() const noexcept { return mean(seen, seen_count); }
    std::optional<double> all_mean() const noexcept { return mean(all, all_count); }

   private:
    static std::optional<double> mean(std::uint64_t sum, std::uint64_t count) noexcept {
      if (count == 0) return std::nullopt;
      return static_cast<double>(sum) * kUnit / static_cast<double>(count);
    }
  };
  /// Of every picture; `all` counts what masks leave out too.
  std::vector<PictureError> errors(const TexelSamples& samples, const TexelFits& fits) const;

  std::size_t lobes() const noexcept { return evaluator_.lobes(); }

 private:
  LobeEvaluator evaluator_;
  const CaptureForm& form_;
  double exposure_;
};

}  // namespace burnish
