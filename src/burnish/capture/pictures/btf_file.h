// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <burnish/image/image.h>
#include <burnish/math/vec3.h>

namespace burnish {

/// A bidirectional texture of the University of Bonn (UBO2014, signature !DFMF08FCR): pictures of one surface for all
/// pairs of some lights and views. Each picture has three decorrelated channels. Each channel is the product of a
/// matrix of pictures and a matrix of texels. The matrices of pictures are in memory; texels are read a few rows at a
/// time. Layout and colours follow the owners' library, btflib (github.com/cgbonn/btflib, read_ubo_dfmf.m and
/// undecorrelate.m). The independent pysmtb reads them in the same way.
class BtfFile {
 public:
  /// True if a file begins with the signature of one of Bonn's formats. False if it cannot be read.
  static bool recognizes(const std::filesystem::path& path);

  /// Reads all but the texels. Throws Error with the offset and the expected content for:
  /// - Bonn's other kinds of files;
  /// - lights that differ between views, or directions below the surface;
  /// - other than three channels, or a colour model that is not implemented;
  /// - rotated frames;
  /// - sizes that do not fit the file.
  explicit BtfFile(std::filesystem::path path);

  const std::filesystem::path& path() const noexcept { return path_; }
  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  double pixels_per_mm() const noexcept { return pixels_per_mm_; }  ///< 0 where the file does not say
  /// True if values are already f cos(theta_i), instead of f.
  bool with_cosine() const noexcept { return with_cosine_; }
  const std::vector<Vec3>& lights() const noexcept { return lights_; }  ///< unit vectors
  const std::vector<Vec3>& views() const noexcept { return views_; }    ///< unit vectors
  std::size_t pictures() const noexcept { return lights_.size() * views_.size(); }
  /// Returns a hash of the bytes before the texels and of the number of bytes after them.
  std::uint64_t fingerprint() const noexcept { return fingerprint_; }
  /// Bytes of a row of texels in a Rows.
  std::size_t row_bytes() const noexcept;

  /// Rows [first, first + count) of all pictures, as factors.
  class Rows {
   public:
    /// Returns the linear values of picture `light + lights * view`, three channels. They have the same bits whatever
    /// rows were read.
    Image picture(std::size_t number) const;

   private:
    friend class BtfFile;
    const BtfFile* file_ = nullptr;
    int count_ = 0;
    std::array<std::vector<float>, 3> texels_;  ///< [block of kLanes texels][component][lane]
  };

  /// Throws Error if the rows are not within the surface or the file has become shorter.
  Rows rows(int first, int count) const;

 private:
  /// The colour model of the three channels, with the numbers of the files.
  enum class ColourModel : std::int32_t {
    rgb = 0,
    yuv = 1,
    principal = 3,
    ycocg = 4,
    log_y_uv = 9,
    log_yuv = 10,
    log_y_ratios = 11,
    log_rgb = 12
  };
  struct Channel {
    int scalar_bytes = 4;
    std::size_t components = 0;
    std::vector<float> pictures;  ///< [picture][component]
    std::uint64_t texels_at = 0;  ///< offset of [texel][component]
  };
  class Head;

  void read_description(Head& head);
  void read_directions(Head& head);
  void read_size(Head& head);
  void read_colours(Head& head);
  Channel read_channel(Head& head) const;
  std::array<float, 3> colour_of(std::array<float, 3> channels) const noexcept;

  std::filesystem::path path_;
  int width_ = 0, height_ = 0;
  double pixels_per_mm_ = 0;
  bool with_cosine_ = false;
  ColourModel colours_ = ColourModel::rgb;
  std::array<float, 3> mean_{};
  std::array<float, 9> transform_{};
  std::vector<Vec3> lights_, views_;
  std::array<Channel, 3> channels_;
  std::uint64_t fingerprint_ = 0;
};

}  // namespace burnish
