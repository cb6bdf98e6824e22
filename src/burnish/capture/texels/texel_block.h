// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/texels/texel_lanes.h>
#include <burnish/capture/texels/texel_samples.h>
#include <burnish/eval/lobe_evaluator.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// The form, lobes and samples that a block's texels refer to. All of them outlive the block.
struct TexelSetting {
  const LobeEvaluator& lobes;
  const CaptureForm& form;
  const TexelSamples& samples;
  float exposure;
};

/// Which texels a block has: at most kTexelLanes, from the first on. Lanes beyond the last repeat it.
struct TexelRange {
  std::size_t first = 0, count = 0;

  std::size_t texel(std::size_t lane) const noexcept { return first + std::min(lane, count - 1); }
};

/// The values of lobes with weight 1 at texels side by side, with buffers for their computation.
class LobeRows {
 public:
  /// Takes pictures by their numbers in the form.
  LobeRows(const TexelSetting& setting, std::span<const std::size_t> pictures);

  /// Finds f cos(theta_i), rows [picture][lobe][channel]. `normals` has x and y of all samples' texels, [texel][2],
  /// to which (dx, dy) is added; null: all are flat.
  void find(const TexelRange& range, const float* normals, float dx, float dy, std::span<float> to);

  std::size_t rows() const noexcept { return setting_.lobes.lobes() * kCaptureChannels; }  ///< rows a picture

 private:
  static constexpr std::size_t kTogether = 4;  // pictures that lobes are evaluated for

  void find_frames(const TexelRange& range, const float* normals, float dx, float dy);
  void find_directions(const TexelRange& range, std::size_t picture, std::size_t first);
  void find_towards(const Station& station);

  TexelSetting setting_;
  std::span<const std::size_t> pictures_;
  TexelFrames frames_;
  std::array<TexelRow, 3> points_, towards_;
  std::array<std::array<float, kTogether * kTexelLanes>, 6> local_;  // light and view in the texels' frames
  std::vector<float> lobe_values_;
};

/// Texels side by side whose weights are fitted: their measured values, the lobes' values, and the equations of a
/// pass. A block is valid after begin(), which may be called again for other texels of the same samples.
class TexelBlock {
 public:
  static constexpr int kLastPass = 2;  ///< from this pass on pixels are trusted least

  /// Takes the held-out pictures, or the fitted ones.
  TexelBlock(const TexelSetting& setting, bool held_out);
  TexelBlock(const TexelBlock&) = delete;  // lobe_rows_ refers to pictures_
  TexelBlock& operator=(const TexelBlock&) = delete;

  /// Takes other texels, and trusts all of their pixels. Weights stay as they were.
  void begin(const TexelRange& range, const float* normals);
  void load_weights(const float* weights);  ///< [texel][lobe] of all samples' texels

  /// Finds the lobes' values under other normals, for the passes that follow.
  void see(const float* normals) { lobe_rows_.find(range_, normals, 0, 0, model_); }
  /// Finds the lobes' values under moved normals, in the caller's floats: as many as model() has.
  void see_moved(const float* normals, float dx, float dy, std::span<float> to) {
    lobe_rows_.find(range_, normals, dx, dy, to);
  }

  /// Finds the normal equations of a pass, and its trust in pixels.
  void find_equations(int pass);
  /// Fits the weights by least squares. Each pass trusts pixels according to the errors that the previous pass left.
  void fit_weights(int passes, int first_pass);

  /// One picture and channel as a pass counts it. find_omega gives omega, at the mean of measured and modelled value,
  /// in pass 0 at the measured value; pixels that do not count have 0.
  struct Terms {
    TexelRow value, model, omega;
  };
  Terms terms_of(std::size_t picture, std::size_t channel, int pass) const;
  /// The remaining cost of each texel's errors, as the fit of weights counts them.
  std::array<double, kTexelLanes> costs() const;

  const TexelRange& range() const noexcept { return range_; }
  std::size_t lobes() const noexcept { return lobes_; }
  std::span<const std::size_t> pictures() const noexcept { return pictures_; }
  std::span<const float> model() const noexcept { return model_; }       ///< [picture][lobe][channel][lane]
  std::span<TexelRow> weights() noexcept { return weights_; }            ///< [lobe]
  std::span<const TexelRow> matrix() const noexcept { return matrix_; }  ///< lower triangles, row by row
  float trust(std::size_t k, std::size_t i) const noexcept { return trust_[k * kTexelLanes + i]; }
  const TexelRow& measured(std::size_t k, std::size_t c) const noexcept {
    return values_[k * kCaptureChannels + c];
  }
  /// Returns the model's f cos(theta_i) of one picture and channel.
  TexelRow modelled(std::size_t k, std::size_t c) const noexcept;
  /// Returns the place of a pixel in the samples.
  std::size_t pixel(std::size_t k, std::size_t i) const noexcept {
    return pictures_[k] * setting_.samples.size() + range_.texel(i);
  }

 private:
  void load();
  void load_states(std::size_t k);
  void solve_one_by_one(std::size_t i, bool near);

  TexelSetting setting_;
  std::size_t lobes_;
  std::vector<std::size_t> pictures_;
  LobeRows lobe_rows_;
  TexelRange range_;
  bool seen_ = false;  // true once the model is that of some texels
  std::vector<float> model_, trust_;
  std::vector<TexelRow> weights_, values_, there_, clipped_;
  bool any_clipped_ = false;
  std::vector<std::array<PixelState, kTexelLanes>> states_;
  std::array<TexelRow, kMaxSurfaceLobes*(kMaxSurfaceLobes + 1) / 2> matrix_;
  std::array<TexelRow, kMaxSurfaceLobes> vector_;
};

}  // namespace burnish
