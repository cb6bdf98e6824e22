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

constexpr std::size_t kCaptureChannels = 3;  ///< of every picture

/// Where a light or a view stands: a unit vector towards it, or a point in the capture's unit of length.
struct Station {
  bool is_direction = true;
  Vec3 at{0, 0, 1};

  /// The unit vector towards it from a point of the surface.
  Vec3 seen_from(Vec3 point) const noexcept { return is_direction ? at : normalize(at - point); }

  friend bool operator==(const Station&, const Station&) = default;
};

/// How the numbers of a picture's file become linear ones.
enum class Transfer { linear, srgb };

/// One registered picture: pixel (x, y) shows texel (x, y).
struct CapturePicture {
  std::string file;  ///< below the capture's folder
  Station light, view;
  /// What a linear pixel value of 1 is: outgoing radiance over the light's irradiance at right angles to it, of a
  /// light at a point that which it gives at distance 1. One a channel.
  Rgb scale{1, 1, 1};
  std::string mask;  ///< where this picture holds: not black; empty: everywhere
  bool held_out = false;

  friend bool operator==(const CapturePicture&, const CapturePicture&) = default;
};

/// What `capture.json` says.
struct CaptureForm {
  int width = 0, height = 0;  ///< of every picture, texels
  /// Of the surface, in any unit of length: it lies in the plane z = 0 about the origin, rows from +y to -y, columns
  /// from -x to +x.
  double size_x = 1, size_y = 1;
  Transfer transfer = Transfer::linear;
  std::optional<double> clip = {};  ///< linear pixel values from here on are clipped
  std::string normals;              ///< a picture of normals, empty: unknown
  std::vector<CapturePicture> pictures;
  /// Texels see lights from directions of their own, which CaptureRows has; stations say nothing.
  bool own_directions = false;

  /// The middle of texel (x, y).
  Vec3 point(int x, int y) const noexcept {
    return {((x + 0.5) / width - 0.5) * size_x, (0.5 - (y + 0.5) / height) * size_y, 0};
  }
  /// Whether all lights and views are directions: then texels of one normal see them alike.
  bool directional() const noexcept;

  friend bool operator==(const CaptureForm&, const CaptureForm&) = default;
};

/// The most pictures of a capture.
inline constexpr std::size_t kMaxPictures = 65'536;

/// Reads `capture.json`; docs/guide/surfaces.md lists its members. Throws Error, naming the file and the member, if it
/// is no such JSON: sides out of range, no picture, stations that are neither directions above the surface nor points
/// above it, names that lead out of the folder.
CaptureForm parse_capture(const FileBytes& file);

/// What parse_capture reads.
std::string format_capture(const CaptureForm& form);

/// State of a pixel: there; without a value (not finite, negative beyond noise); there, but left out by a mask; there,
/// with channels that are clipped, which clipped_in says.
enum class PixelState : std::uint8_t { there, missing, masked, clipped = 8 };

constexpr bool is_clipped(PixelState state) noexcept {
  return (static_cast<unsigned>(state) & static_cast<unsigned>(PixelState::clipped)) != 0;
}
/// Whether a channel's value is a lower bound.
constexpr bool is_clipped(PixelState state, std::size_t channel) noexcept {
  return is_clipped(state) && (static_cast<unsigned>(state) >> channel & 1U) != 0;
}
/// The state of a pixel that is there or clipped, with one more channel clipped.
constexpr PixelState clipped_in(PixelState state, std::size_t channel) noexcept {
  return static_cast<PixelState>(static_cast<unsigned>(state) | static_cast<unsigned>(PixelState::clipped) |
                                 1U << channel);
}
/// Whether a pixel has values that count.
constexpr bool is_there(PixelState state) noexcept {
  return state == PixelState::there || is_clipped(state);
}

/// Rows of all pictures of a capture: outgoing radiance over irradiance, f cos(theta_i), of texels.
struct CaptureRows {
  int first_row = 0, rows = 0, width = 0;
  std::size_t pictures = 0;
  std::vector<float> values;       ///< [picture][row][x][channel], three channels
  std::vector<PixelState> states;  ///< [picture][row][x]
  /// Unit vectors towards light and view, [picture][row][x][6]; empty: as the form's stations say.
  std::vector<float> directions;

  std::size_t texels() const noexcept {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(width);
  }
};

/// A number of bytes that changes with them, from that of the bytes before.
constexpr std::uint64_t hash_of(std::string_view bytes,
                                std::uint64_t before = 0xcbf29ce484222325) noexcept {  // FNV-1a
  for (const char c : bytes) before = (before ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return before;
}

class BtfFile;
class TexelTable;

/// A folder of pictures, or a BTF of UBO2014 (btf_file.h), read a few rows at a time: memory does not grow with the
/// number of pictures or texels. Or samples of each texel, a CSV (parse_texel_csv), which is in memory: a texel's k-th
/// sample belongs to picture k, and where it has fewer they are missing.
class Capture {
 public:
  static constexpr std::size_t kMinPictures = 4;
  static constexpr std::size_t kBtfPictures = 500;

  /// Reads FOLDER/capture.json and looks at the head of every picture. Those that are missing, no EXR or PNG, or of
  /// another size are left out. Throws Error where the JSON is wrong or fewer than `kMinPictures` are left to fit.
  /// Of a BTF, which has tens of thousands, so many pictures are taken, spread evenly over its lights and views (0:
  /// all), every twelfth of them held out; its unit of length is the millimetre. Throws Error as BtfFile does.
  /// Of samples every twelfth of a texel is held out where the file does not say which; its width and height are what
  /// the largest texel says, each texel has a sample on the mean. Throws Error where they have not, and as
  /// parse_texel_csv does.
  explicit Capture(std::filesystem::path path, std::size_t btf_pictures = kBtfPictures);

  /// The pictures that are there are all of the form's.
  const CaptureForm& form() const noexcept { return form_; }
  /// What says so: capture.json, the BTF, or the samples.
  std::filesystem::path form_file() const;
  /// Where a picture or the normals are.
  std::filesystem::path file(const std::string& name) const { return path_ / name; }

  struct LeftOut {
    std::string file, why;
  };
  const std::vector<LeftOut>& left_out() const noexcept { return left_out_; }
  /// One sentence where chunks of pictures say otherwise than `transfer` how numbers are meant; empty elsewhere.
  const std::string& disagreement() const noexcept { return disagreement_; }
  /// The same number for the same capture: the bytes of capture.json, size and last write time of every picture, mask
  /// and the normals, and what is left out; of a BTF its head, size and last write time; of samples all bytes.
  std::uint64_t fingerprint() const noexcept { return fingerprint_; }

  /// Rows that keep a tile of all pictures within so many bytes, at least one.
  int rows_within(std::size_t bytes) const noexcept;

  /// Rows [first, first + count) of every picture, read side by side. A picture that turns out damaged is reported in
  /// `damaged`; its pixels are missing.
  struct Read {
    CaptureRows rows;
    std::vector<LeftOut> damaged;
  };
  Read read(int first, int count) const;
  /// Takes pictures out, as open does. Throws Error as the constructor does.
  void leave_out(const std::vector<LeftOut>& damaged);

  /// The normals of the form, x and y a texel, [row][x][2]; empty where it names none. Throws Error if the picture
  /// is damaged or holds no unit vectors above the surface (three channels, to 2 %).
  std::vector<float> normals() const;

 private:
  void open_folder();
  void open_btf(std::size_t pictures);
  void open_samples();

  std::filesystem::path path_;
  CaptureForm form_;
  std::shared_ptr<const BtfFile> btf_;       ///< null: a folder
  std::vector<std::size_t> btf_numbers_;     ///< of the form's pictures
  std::shared_ptr<const TexelTable> table_;  ///< of samples, else null
  std::vector<LeftOut> left_out_;
  std::string disagreement_;
  std::uint64_t fingerprint_ = 0;
};

}  // namespace burnish
