// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/file.h>
#include <burnish/image/image.h>
#include <burnish/math/rgb.h>
#include <burnish/math/vec3.h>

namespace burnish {

constexpr std::size_t kCaptureChannels = 3;  ///< the channels of every picture

/// The place of a light or a view: a unit vector towards it, or a point in the capture's unit of length.
struct Station {
  bool is_direction = true;
  Vec3 at{0, 0, 1};

  /// Returns the unit vector towards it from a point of the surface.
  Vec3 seen_from(Vec3 point) const noexcept { return is_direction ? at : normalize(at - point); }

  friend bool operator==(const Station&, const Station&) = default;
};

/// The encoding of the numbers in a picture's file: linear, or the curve of sRGB.
enum class Transfer { linear, srgb };

/// One registered picture: pixel (x, y) shows texel (x, y).
struct CapturePicture {
  std::string file;  ///< below the capture's folder
  Station light, view;
  /// The value that a linear pixel value of 1 stands for, one a channel: outgoing radiance over irradiance of the
  /// light. The irradiance is taken at right angles to the light; a light at a point has that of distance 1.
  Rgb scale{1, 1, 1};
  std::string mask;  ///< a picture that is not black where this one holds; empty: everywhere
  bool held_out = false;

  friend bool operator==(const CapturePicture&, const CapturePicture&) = default;
};

/// The content of `capture.json`.
struct CaptureForm {
  int width = 0, height = 0;  ///< the size of every picture, texels
  /// Sides of the surface, in any unit of length. The surface lies in the plane z = 0 about the origin, with rows
  /// from +y to -y and columns from -x to +x.
  double size_x = 1, size_y = 1;
  Transfer transfer = Transfer::linear;
  std::optional<double> clip = {};  ///< linear pixel values are clipped from here on
  std::string normals;              ///< a picture of normals, empty: unknown
  std::vector<CapturePicture> pictures;
  /// Texels have directions of their own, which CaptureRows stores; stations are not used.
  bool own_directions = false;

  /// Returns the middle of texel (x, y).
  Vec3 point(int x, int y) const noexcept {
    return {((x + 0.5) / width - 0.5) * size_x, (0.5 - (y + 0.5) / height) * size_y, 0};
  }
  /// True if all lights and views are directions. Texels of one normal then see them alike.
  bool directional() const noexcept;

  friend bool operator==(const CaptureForm&, const CaptureForm&) = default;
};

/// The most pictures of a capture.
inline constexpr std::size_t kMaxPictures = 65'536;

/// Reads `capture.json`; docs/guide/surfaces.md lists its members. Throws Error, with the file and the member, if it
/// is not JSON of this form: sides out of range, no picture, stations that are neither directions nor points above
/// the surface, or names that lead out of the folder.
CaptureForm parse_capture(const FileBytes& file);

/// Returns text that parse_capture reads.
std::string format_capture(const CaptureForm& form);

/// The state of a pixel:
/// - there: it has a value;
/// - missing: it has none (not finite, or negative beyond noise);
/// - masked: it has a value, but a mask leaves it out;
/// - clipped: it has a value, with clipped channels that clipped_in adds.
enum class PixelState : std::uint8_t { there, missing, masked, clipped = 8 };

constexpr bool is_clipped(PixelState state) noexcept {
  return (static_cast<unsigned>(state) & static_cast<unsigned>(PixelState::clipped)) != 0;
}
/// True if a channel's value is a lower bound.
constexpr bool is_clipped(PixelState state, std::size_t channel) noexcept {
  return is_clipped(state) && (static_cast<unsigned>(state) >> channel & 1U) != 0;
}
/// The state of a pixel that is there or clipped, with one more channel clipped.
constexpr PixelState clipped_in(PixelState state, std::size_t channel) noexcept {
  return static_cast<PixelState>(static_cast<unsigned>(state) | static_cast<unsigned>(PixelState::clipped) |
                                 1U << channel);
}
/// True if a pixel has values that count.
constexpr bool is_there(PixelState state) noexcept {
  return state == PixelState::there || is_clipped(state);
}

/// Rows of all pictures of a capture, as outgoing radiance over irradiance, f cos(theta_i), of each texel.
struct CaptureRows {
  int first_row = 0, rows = 0, width = 0;
  std::size_t pictures = 0;
  std::vector<float> values;       ///< [picture][row][x][channel], three channels
  std::vector<PixelState> states;  ///< [picture][row][x]
  /// Unit vectors towards light and view, [picture][row][x][6]; empty: the form's stations tell them.
  std::vector<float> directions;

  std::size_t texels() const noexcept {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(width);
  }
};

/// Returns a hash of bytes that continues from the hash `before` of the bytes before them.
constexpr std::uint64_t hash_of(std::string_view bytes,
                                std::uint64_t before = 0xcbf29ce484222325) noexcept {  // FNV-1a
  for (const char c : bytes) before = (before ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return before;
}

class BtfFile;
class TexelTable;

/// A capture, from one of three sources. A folder of pictures and a BTF of UBO2014 (btf_file.h) are read a few rows
/// at a time: memory does not grow with the number of pictures or texels. The samples of each texel in a CSV
/// (parse_texel_csv) are kept in memory. A texel's k-th sample belongs to picture k; a texel with fewer samples is
/// missing from the later pictures.
class Capture {
 public:
  static constexpr std::size_t kMinPictures = 4;
  static constexpr std::size_t kBtfPictures = 500;

  /// Opens a capture.
  ///
  /// A folder: reads FOLDER/capture.json and the head of every picture. Pictures that are missing, are no EXR or PNG,
  /// or have another size are left out. Throws Error if the JSON is wrong or fewer than `kMinPictures` are left to
  /// fit.
  ///
  /// A BTF: it has tens of thousands of pictures, so `btf_pictures` of them are taken, spread evenly over its lights
  /// and views (0: all). Every twelfth of them is held out. The unit of length is the millimetre. Throws Error as
  /// BtfFile does.
  ///
  /// Samples: every twelfth sample of a texel is held out if the file does not mark any. The largest texel gives
  /// width and height. Throws Error if there is less than one sample a texel on the mean, and as parse_texel_csv
  /// does.
  explicit Capture(std::filesystem::path path, std::size_t btf_pictures = kBtfPictures);

  /// Every picture of the form exists and can be read.
  const CaptureForm& form() const noexcept { return form_; }
  /// Returns the file that holds the form: capture.json, the BTF, or the samples.
  std::filesystem::path form_file() const;
  /// Returns the path of a picture or of the normals.
  std::filesystem::path file(const std::string& name) const { return path_ / name; }

  struct LeftOut {
    std::string file, why;
  };
  const std::vector<LeftOut>& left_out() const noexcept { return left_out_; }
  /// Returns one sentence if colour chunks of pictures contradict `transfer`; otherwise empty.
  const std::string& disagreement() const noexcept { return disagreement_; }
  /// Returns a hash that stays the same for the same capture. A folder's covers the bytes of capture.json, size and
  /// last write time of every picture, mask and the normals, and the pictures left out. A BTF's covers its head, size
  /// and last write time; that of samples covers all bytes.
  std::uint64_t fingerprint() const noexcept { return fingerprint_; }

  /// Returns the number of rows, at least one, whose tile of all pictures fits in so many bytes.
  int rows_within(std::size_t bytes) const noexcept;

  /// Rows [first, first + count) of every picture, which are read in parallel. A picture that turns out damaged is
  /// listed in `damaged`; its pixels are missing.
  struct Read {
    CaptureRows rows;
    std::vector<LeftOut> damaged;
  };
  Read read(int first, int count) const;
  /// Takes pictures out, and throws Error, as the constructor does.
  void leave_out(const std::vector<LeftOut>& damaged);

  /// Returns the normals of the form, x and y a texel, [row][x][2]; empty if it names none. Throws Error if the
  /// picture is damaged or has vectors that are not unit vectors above the surface (three channels, to 2 %).
  std::vector<float> normals() const;

 private:
  void open_folder();
  void open_btf(std::size_t pictures);
  void open_samples();

  std::filesystem::path path_;
  CaptureForm form_;
  std::shared_ptr<const BtfFile> btf_;       ///< null: a folder
  std::vector<std::size_t> btf_numbers_;     ///< the BTF's numbers of the form's pictures
  std::shared_ptr<const TexelTable> table_;  ///< null unless the capture has samples
  std::vector<LeftOut> left_out_;
  std::string disagreement_;
  std::uint64_t fingerprint_ = 0;
};

}  // namespace burnish
