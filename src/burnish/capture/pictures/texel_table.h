// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <burnish/capture/pictures/capture.h>

namespace burnish {

/// Samples of each texel of a surface, in memory, ordered as pictures: a texel's k-th sample belongs to picture k.
/// The held-out pictures come last. A sample takes 37 bytes.
class TexelTable {
 public:
  /// True if a file begins like a CSV of samples. False if it cannot be read.
  static bool recognizes(const std::filesystem::path& path);

  /// Reads a file as parse_texel_csv does, with at most so many texels a side and samples a texel. Throws Error if
  /// there is less than one sample a texel on the mean, and what parse_texel_csv throws.
  TexelTable(const std::filesystem::path& path, int most_side, std::size_t most_pictures);

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  std::size_t pictures() const noexcept { return fitted_ + held_out_; }
  std::size_t fitted_pictures() const noexcept { return fitted_; }
  /// Returns a hash of the file's bytes.
  std::uint64_t fingerprint() const noexcept { return fingerprint_; }

  /// Rows [first, first + count) of all pictures.
  CaptureRows rows(int first, int count) const;

 private:
  struct Sample {
    std::array<float, 6> directions;
    std::array<float, 3> seen;  ///< f cos(theta_i)
    std::uint8_t held_out;
  };

  int width_ = 0, height_ = 0;
  std::size_t fitted_ = 0, held_out_ = 0;
  std::vector<std::size_t> starts_;  ///< the first sample of each texel, then the end
  std::vector<Sample> samples_;
  std::uint64_t fingerprint_ = 0;
};

}  // namespace burnish
