// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include <Imath/half.h>
#include <fmt/format.h>

#include <burnish/capture/pictures/btf_file.h>
#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/pictures/file_stamp.h>
#include <burnish/error.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr std::string_view kSignature = "!DFMF08FCR";
constexpr std::size_t kLanes = 64;  // texels whose sums fit in registers
constexpr std::uint32_t kMaxDirections = 4096, kMaxComponents = 4096, kMaxWidth = 16'384;
constexpr std::uint32_t kMaxVersion = 100;  // the head's version; it has only grown so far
constexpr double kMinZ = 1e-3;              // the least z of a direction above the surface
// The offset that was added before logarithms were taken [btflib, undecorrelate.m: drr_eps].
constexpr float kLogOffset = 1e-5f;

float number_at(const char* bytes, int size) noexcept {
  if (size == 2) {
    Imath::half half;
    std::uint16_t bits;
    std::memcpy(&bits, bytes, sizeof(bits));
    half.setBits(bits);
    return half;
  }
  if (size == 4) {
    float value;
    std::memcpy(&value, bytes, sizeof(value));
    return value;
  }
  double value;
  std::memcpy(&value, bytes, sizeof(value));
  return static_cast<float>(value);
}

std::vector<float> numbers_of(std::string_view bytes, int size) {
  std::vector<float> numbers(bytes.size() / static_cast<std::size_t>(size));
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = number_at(bytes.data() + i * static_cast<std::size_t>(size), size);
  return numbers;
}

/// exp(value) - offset, the inverse of the function that reduced the range.
float expanded(float value) noexcept {
  return std::exp(value) - kLogOffset;
}

}  // namespace

/// Reads the head front to back; every step is checked against the end of the file.
class BtfFile::Head {
 public:
  explicit Head(const std::filesystem::path& path)
      : path_(path), file_(path, std::ios::binary), size_(std::filesystem::file_size(path)) {
    if (!file_) throw Error::in_file(path.string(), "a file that can be read", "none");
  }

  std::uint64_t offset() const noexcept { return offset_; }
  std::uint64_t size() const noexcept { return size_; }
  std::uint64_t hash() const noexcept { return hash_; }

  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    throw Error(path_.string(), offset_, expected, found);
  }
  void require(std::uint64_t bytes, const char* what) const {
    if (bytes > size_ - offset_)
      fail(fmt::format("{} bytes of {}", bytes, what), fmt::format("{} to the end", size_ - offset_));
  }
  std::string take(std::uint64_t bytes, const char* what) {
    require(bytes, what);
    std::string taken(bytes, '\0');
    if (!file_.read(taken.data(), static_cast<std::streamsize>(bytes)))
      fail(what, "a file that cannot be read");
    offset_ += bytes;
    hash_ = hash_of(taken, hash_);
    return taken;
  }
  void skip(std::uint64_t bytes, const char* what) {
    require(bytes, what);
    file_.seekg(static_cast<std::streamoff>(bytes), std::ios::cur);
    offset_ += bytes;
  }
  template <class T>
  T number(const char* what) {
    T value;
    std::memcpy(&value, take(sizeof(T), what).data(), sizeof(T));
    return value;
  }
  std::uint32_t count(const char* what, std::uint32_t least, std::uint32_t most) {
    const auto found = number<std::uint32_t>(what);
    if (found < least || found > most) {
      offset_ -= sizeof(found);
      fail(fmt::format("{} of {} to {}", what, least, most), fmt::format("{}", found));
    }
    return found;
  }
  /// Reads a direction as polar angle and azimuth, radians.
  Vec3 direction(const char* what) {
    const auto theta = static_cast<double>(number<float>(what)),
               phi = static_cast<double>(number<float>(what));
    const Vec3 found = spherical_direction(theta, phi);
    if (!(theta >= 0 && found.z >= kMinZ) || !std::isfinite(phi))
      fail(fmt::format("{} above the surface", what), fmt::format("theta = {}, phi = {}", theta, phi));
    return found;
  }

 private:
  const std::filesystem::path& path_;
  std::ifstream file_;
  std::uint64_t size_, offset_ = 0, hash_ = hash_of("");
};

bool BtfFile::recognizes(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) return false;
  std::ifstream file(path, std::ios::binary);
  std::array<char, 3> head{};
  // Bonn's other formats are recognized too, so that an error can name them.
  return file.read(head.data(), head.size()) && head[0] == '!' && head[1] >= 'B' && head[1] <= 'P' &&
         head[2] >= 'A' && head[2] <= 'Z';
}

BtfFile::BtfFile(std::filesystem::path path) : path_(std::move(path)) {
  Head head(path_);
  if (const std::string found = head.take(kSignature.size(), "signature"); found != kSignature)
    throw Error(path_.string(), 0, fmt::format("'{}', a BTF of UBO2014", kSignature),
                fmt::format("'{}'", found));

  read_description(head);
  read_directions(head);
  read_size(head);
  read_colours(head);
  for (Channel& channel : channels_) channel = read_channel(head);
  fingerprint_ = hash_of(file_stamp(path_), head.hash());
}

/// Reads the description of the measurement.
void BtfFile::read_description(Head& head) {
  const std::uint64_t begin = head.offset();
  const auto bytes = head.number<std::uint32_t>("size of the description");
  const std::uint32_t version = head.count("version", 1, kMaxVersion);
  head.take(3 * 80, "setup, sensor and light");
  const auto pixels_per_mm = static_cast<double>(head.number<float>("pixels per mm"));
  if (std::isfinite(pixels_per_mm) && pixels_per_mm > 0) pixels_per_mm_ = pixels_per_mm;
  head.take(3 * sizeof(float), "scale of colours");
  if (version > 1) with_cosine_ = head.number<std::uint32_t>("flag of the cosine") != 0;
  if (version > 2) head.take(head.number<std::uint32_t>("size of the XML"), "XML");
  if (version > 3) {
    if (const auto channels = head.number<std::uint32_t>("channels"); channels != 3)
      head.fail("3 channels", fmt::format("{}", channels));
    for (int c = 0; c < 3; ++c) head.take(head.number<std::uint32_t>("size of a channel's name"), "name");
  }
  if (head.offset() != begin + bytes)
    head.fail(fmt::format("a description of {} bytes", bytes), fmt::format("{}", head.offset() - begin));
}

void BtfFile::read_directions(Head& head) {
  const std::uint32_t views = head.count("views", 1, kMaxDirections);
  for (std::uint32_t v = 0; v < views; ++v) {
    views_.push_back(head.direction("view"));
    const std::uint32_t lights = head.count("lights", 1, kMaxDirections);
    head.require(std::uint64_t{lights} * 2 * sizeof(float), "lights");
    std::vector<Vec3> found;
    for (std::uint32_t l = 0; l < lights; ++l) found.push_back(head.direction("light"));
    if (v > 0 && found != lights_) head.fail("the same lights for all views", "others");
    lights_ = std::move(found);
    if (std::size_t{views} * lights_.size() > kMaxPictures)
      head.fail(fmt::format("at most {} pictures", kMaxPictures), fmt::format("{} x {}", views, lights));
  }
}

void BtfFile::read_size(Head& head) {
  width_ = static_cast<int>(head.count("width", 1, kMaxWidth));
  height_ = static_cast<int>(head.count("height", 1, kMaxWidth));
  if (const auto rotations = head.number<std::uint32_t>("rotations"); rotations != 0)
    head.fail("no rotated frames", fmt::format("{}", rotations));
}

void BtfFile::read_colours(Head& head) {
  head.count("components", 0, std::numeric_limits<std::uint32_t>::max());
  const auto model = head.number<std::int32_t>("colour model");
  constexpr std::array kModels{ColourModel::rgb,          ColourModel::yuv,      ColourModel::principal,
                               ColourModel::ycocg,        ColourModel::log_y_uv, ColourModel::log_yuv,
                               ColourModel::log_y_ratios, ColourModel::log_rgb};
  if (std::ranges::find(kModels, static_cast<ColourModel>(model)) == kModels.end())
    head.fail("colour model 0, 1, 3, 4 or 9 to 12", fmt::format("{}", model));
  colours_ = static_cast<ColourModel>(model);
  for (float& value : mean_) value = head.number<float>("mean colour");
  for (float& value : transform_) value = head.number<float>("transform of colours");
}

/// Reads a channel's matrices. The singular values come first; the second matrix already contains them. Then come a
/// matrix of pictures and a matrix of texels, in either order.
BtfFile::Channel BtfFile::read_channel(Head& head) const {
  const std::uint64_t texels = static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_);
  Channel channel;
  channel.scalar_bytes = head.number<std::uint8_t>("bytes a number");
  if (channel.scalar_bytes != 2 && channel.scalar_bytes != 4 && channel.scalar_bytes != 8)
    head.fail("numbers of 2, 4 or 8 bytes", fmt::format("{}", channel.scalar_bytes));
  channel.components = head.count("components", 1, kMaxComponents);
  const auto rows = head.number<std::uint32_t>("rows"), columns = head.number<std::uint32_t>("columns");
  const bool pictures_first = rows == pictures() && columns == texels;
  if (!pictures_first && !(rows == texels && columns == pictures()))
    head.fail(fmt::format("matrices of {} and {} rows", pictures(), texels),
              fmt::format("{} and {}", rows, columns));
  const std::uint64_t row = channel.components * static_cast<std::uint64_t>(channel.scalar_bytes);
  head.skip(row, "singular values");
  for (const bool of_pictures : {pictures_first, !pictures_first}) {
    if (of_pictures) {
      channel.pictures = numbers_of(head.take(pictures() * row, "pictures"), channel.scalar_bytes);
    } else {
      channel.texels_at = head.offset();
      head.skip(texels * row, "texels");
    }
  }
  return channel;
}

std::size_t BtfFile::row_bytes() const noexcept {
  std::size_t components = 0;
  for (const Channel& channel : channels_) components += channel.components;
  return static_cast<std::size_t>(width_) * components * sizeof(float);
}

BtfFile::Rows BtfFile::rows(int first, int count) const {
  if (first < 0 || count < 1 || first + count > height_)
    throw Error::in_file(path_.string(), fmt::format("rows {} to {}", first, first + count),
                         fmt::format("{} rows", height_));
  Rows rows;
  rows.file_ = this;
  rows.count_ = count;
  const std::size_t texels = static_cast<std::size_t>(count) * static_cast<std::size_t>(width_);
  std::ifstream file(path_, std::ios::binary);
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const Channel& channel = channels_[c];
    const std::size_t components = channel.components,
                      scalar = static_cast<std::size_t>(channel.scalar_bytes);
    std::string numbers(texels * components * scalar, '\0');
    const std::uint64_t at = channel.texels_at + static_cast<std::uint64_t>(first) *
                                                     static_cast<std::uint64_t>(width_) * components * scalar;
    file.seekg(static_cast<std::streamoff>(at));
    if (!file.read(numbers.data(), static_cast<std::streamsize>(numbers.size())))
      throw Error(path_.string(), at, fmt::format("{} bytes of texels", numbers.size()), "an earlier end");
    rows.texels_[c].resize((texels + kLanes - 1) / kLanes * kLanes * components);
    for (std::size_t t = 0; t < texels; ++t)
      for (std::size_t k = 0; k < components; ++k)
        rows.texels_[c][(t / kLanes * components + k) * kLanes + t % kLanes] =
            number_at(numbers.data() + (t * components + k) * scalar, channel.scalar_bytes);
  }
  return rows;
}

Image BtfFile::Rows::picture(std::size_t number) const {
  Image image(file_->width_, count_, 3);
  const std::size_t texels = image.pixels.size() / 3;
  for (std::size_t block = 0; block * kLanes < texels; ++block) {
    // The sums add one component after the other, so that neither rows nor threads change a bit.
    std::array<std::array<float, kLanes>, 3> sums{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t components = file_->channels_[c].components;
      const float* const weight = &file_->channels_[c].pictures[number * components];
      const float* texel = &texels_[c][block * components * kLanes];
      for (std::size_t k = 0; k < components; ++k, texel += kLanes)
        for (std::size_t lane = 0; lane < kLanes; ++lane) sums[c][lane] += weight[k] * texel[lane];
    }
    for (std::size_t lane = 0; lane < kLanes && block * kLanes + lane < texels; ++lane)
      std::ranges::copy(file_->colour_of({sums[0][lane], sums[1][lane], sums[2][lane]}),
                        &image.pixels[(block * kLanes + lane) * 3]);
  }
  return image;
}

std::array<float, 3> BtfFile::colour_of(std::array<float, 3> channels) const noexcept {
  auto [y, u, v] = channels;
  switch (colours_) {
    case ColourModel::rgb:
      return channels;
    case ColourModel::log_rgb:
      return {expanded(y), expanded(u), expanded(v)};
    case ColourModel::ycocg:
      return {y + u - v, y + v, y - u - v};
    case ColourModel::principal: {
      std::array<float, 3> colour = mean_;
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < 3; ++k) colour[c] += channels[k] * transform_[3 * k + c];
      return colour;
    }
    case ColourModel::yuv:
      break;
    case ColourModel::log_y_uv:
      y = expanded(y);
      break;
    case ColourModel::log_yuv:
      y = expanded(y);
      for (float* const chroma : {&u, &v})
        *chroma = *chroma == 0 ? 0 : std::copysign(std::exp(std::abs(*chroma)) * kLogOffset, *chroma);
      break;
    case ColourModel::log_y_ratios:
      u *= std::exp(y);
      v *= std::exp(y);
      y = expanded(y);
      break;
  }
  return {y + 1.13983f * v, y - 0.39465f * u - 0.5806f * v, y + 2.03211f * u};
}

}  // namespace burnish
