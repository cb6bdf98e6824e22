// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include <burnish/capture/pictures/btf_file.h>
#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/pictures/file_stamp.h>
#include <burnish/capture/pictures/json_member.h>
#include <burnish/capture/pictures/picture_rows.h>
#include <burnish/capture/pictures/texel_table.h>
#include <burnish/error.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

constexpr int kCaptureVersion = 1, kMaxSide = 16'384;
constexpr std::uint64_t kMaxJson = std::uint64_t{64} << 20;
constexpr double kMinHeight = 1e-3;      // z of a unit vector towards a light or view
constexpr double kUnitTolerance = 0.02;  // for a direction's length
// Noise about zero may make values negative, down to this part of the picture's white.
constexpr float kMinValue = -0.05f;
constexpr std::size_t kHeldOut = 12;  // one of so many pictures of a BTF

}  // namespace

Station parse_station(const JsonMember& member) {
  member.has_only({"direction", "position"});
  if (member.has("position")) {
    const JsonMember position = member.at("position");
    const Station station{.is_direction = false, .at = position.vector()};
    if (!(station.at.z > 0)) position.fail("a point above the surface");
    return station;
  }
  const JsonMember direction = member.at("direction");
  const Vec3 found = direction.vector();
  if (std::abs(length(found) - 1) > kUnitTolerance) direction.fail("a vector of length 1");
  // A vector that is a unit vector up to rounding is kept to the bit.
  constexpr double kRounding = 1e-12;
  const Station station{.is_direction = true,
                        .at = std::abs(length(found) - 1) < kRounding ? found : normalize(found)};
  if (!(station.at.z >= kMinHeight)) direction.fail("a direction above the surface");
  return station;
}

namespace {

Rgb parse_scale(const JsonMember& member) {
  constexpr double kMin = 1e-12, kMax = 1e12;
  if (!member.is_list()) return member.number(kMin, kMax);
  const std::vector<JsonMember> rgb = member.list(3, 3);
  return {rgb[0].number(kMin, kMax), rgb[1].number(kMin, kMax), rgb[2].number(kMin, kMax)};
}

CapturePicture parse_picture(const JsonMember& member) {
  member.has_only({"file", "light", "view", "scale", "mask", "held_out"});
  CapturePicture picture{.file = member.at("file").file(),
                         .light = parse_station(member.at("light")),
                         .view = parse_station(member.at("view")),
                         .mask = {}};
  if (member.has("scale")) picture.scale = parse_scale(member.at("scale"));
  if (member.has("mask")) picture.mask = member.at("mask").file();
  if (member.has("held_out")) picture.held_out = member.at("held_out").truth();
  return picture;
}

Json to_json(const Station& station) {
  return {{station.is_direction ? "direction" : "position", {station.at.x, station.at.y, station.at.z}}};
}

}  // namespace

bool CaptureForm::directional() const noexcept {
  return !own_directions && std::ranges::all_of(pictures, [](const CapturePicture& picture) {
    return picture.light.is_direction && picture.view.is_direction;
  });
}

CaptureForm parse_capture(const FileBytes& file) {
  const Json json = parse_json(file);
  const JsonMember root(file, json, "");
  root.at("version").integer(kCaptureVersion, kCaptureVersion);
  root.has_only({"version", "width", "height", "size", "transfer", "clip", "normals", "pictures"});
  CaptureForm form{.width = root.at("width").integer(1, kMaxSide),
                   .height = root.at("height").integer(1, kMaxSide),
                   .normals = {},
                   .pictures = {}};
  if (root.has("size")) {
    constexpr double kMin = 1e-6, kMax = 1e6;
    const std::vector<JsonMember> size = root.at("size").list(2, 2);
    form.size_x = size[0].number(kMin, kMax);
    form.size_y = size[1].number(kMin, kMax);
  }
  if (root.has("transfer")) {
    const JsonMember transfer = root.at("transfer");
    const std::string name = transfer.text();
    if (name != "linear" && name != "srgb") transfer.fail("linear or srgb");
    form.transfer = name == "srgb" ? Transfer::srgb : Transfer::linear;
  }
  if (root.has("clip")) form.clip = root.at("clip").number(1e-9, 1e9);
  if (root.has("normals")) form.normals = root.at("normals").file();
  std::set<std::string> names;
  for (const JsonMember& member : root.at("pictures").list(1, kMaxPictures)) {
    form.pictures.push_back(parse_picture(member));
    if (!names.insert(form.pictures.back().file).second) member.fail("pictures of different files");
  }
  return form;
}

std::string format_capture(const CaptureForm& form) {
  Json pictures = Json::array();
  for (const CapturePicture& picture : form.pictures) {
    Json item{{"file", picture.file},
              {"light", to_json(picture.light)},
              {"view", to_json(picture.view)},
              {"scale", {picture.scale.r, picture.scale.g, picture.scale.b}}};
    if (!picture.mask.empty()) item["mask"] = picture.mask;
    if (picture.held_out) item["held_out"] = true;
    pictures.push_back(std::move(item));
  }
  Json json{{"version", kCaptureVersion},
            {"width", form.width},
            {"height", form.height},
            {"size", {form.size_x, form.size_y}},
            {"transfer", form.transfer == Transfer::srgb ? "srgb" : "linear"}};
  if (form.clip) json["clip"] = *form.clip;
  if (!form.normals.empty()) json["normals"] = form.normals;
  json["pictures"] = std::move(pictures);
  return json.dump(1) + "\n";
}

Capture::Capture(std::filesystem::path path, std::size_t btf_pictures) : path_(std::move(path)) {
  if (BtfFile::recognizes(path_))
    open_btf(btf_pictures);
  else if (TexelTable::recognizes(path_))
    open_samples();
  else if (std::error_code none; std::filesystem::is_regular_file(path_, none))
    throw Error::in_file(
        path_.string(),
        "a folder with capture.json, a BTF of UBO2014, or a CSV of samples with columns texel_x and texel_y",
        "another file");
  else
    open_folder();
}

std::filesystem::path Capture::form_file() const {
  return btf_ || table_ ? path_ : path_ / "capture.json";
}

void Capture::open_folder() {
  const FileBytes file = read_file(form_file(), kMaxJson);
  form_ = parse_capture(file);

  // Files that exist and have the right size are kept.
  std::vector<std::string> why(form_.pictures.size());
  std::vector<std::uint8_t> disagrees(why.size());
  const StatedTransfer meant =
      form_.transfer == Transfer::srgb ? StatedTransfer::srgb : StatedTransfer::linear;
  for_each_chunk(why.size(), 1, [&](std::size_t p, std::size_t, std::size_t) {
    try {
      for (const std::string& name : {form_.pictures[p].file, form_.pictures[p].mask}) {
        if (name.empty()) continue;
        const PictureSize size = picture_size(path_ / name);
        if (size.width != form_.width || size.height != form_.height)
          throw Error::in_file((path_ / name).string(),
                               fmt::format("{} x {} pixels", form_.width, form_.height),
                               fmt::format("{} x {}", size.width, size.height));
      }
      const StatedTransfer stated = stated_transfer(path_ / form_.pictures[p].file);
      disagrees[p] = stated != StatedTransfer::none && stated != meant;
    } catch (const Error& error) {
      why[p] = error.what();
    }
  });
  if (const auto first = std::ranges::find(disagrees, 1); first != disagrees.end())
    disagreement_ = fmt::format(
        "a chunk of {} of {} pictures ({} first) says that numbers are not {}: taken as \"transfer\" says",
        std::ranges::count(disagrees, 1), disagrees.size(),
        form_.pictures[static_cast<std::size_t>(first - disagrees.begin())].file,
        meant == StatedTransfer::srgb ? "sRGB" : "linear");
  std::vector<LeftOut> damaged;
  for (std::size_t p = 0; p < why.size(); ++p)
    if (!why[p].empty()) damaged.push_back({form_.pictures[p].file, why[p]});
  fingerprint_ = hash_of(file.text());
  const auto hash_stamp = [&](const std::string& name) {
    if (!name.empty()) fingerprint_ = hash_of(file_stamp(path_ / name) + '\n', fingerprint_);
  };
  hash_stamp(form_.normals);
  for (const CapturePicture& picture : form_.pictures) {
    hash_stamp(picture.file);
    hash_stamp(picture.mask);
  }
  leave_out(damaged);
}

void Capture::open_btf(std::size_t pictures) {
  btf_ = std::make_shared<const BtfFile>(path_);
  form_.width = btf_->width();
  form_.height = btf_->height();
  if (btf_->pixels_per_mm() > 0) {
    form_.size_x = form_.width / btf_->pixels_per_mm();
    form_.size_y = form_.height / btf_->pixels_per_mm();
  }
  const std::size_t all = btf_->pictures(), lights = btf_->lights().size();
  const std::size_t taken = pictures == 0 ? all : std::min(all, pictures);
  for (std::size_t k = 0; k < taken; ++k) {
    const std::size_t number = k * all / taken;
    const Vec3 light = btf_->lights()[number % lights], view = btf_->views()[number / lights];
    btf_numbers_.push_back(number);
    form_.pictures.push_back({.file = fmt::format("light {} view {}", number % lights, number / lights),
                              .light = {.is_direction = true, .at = light},
                              .view = {.is_direction = true, .at = view},
                              .scale = btf_->with_cosine() ? 1 : light.z,
                              .mask = {},
                              .held_out = k % kHeldOut == kHeldOut - 1});
  }
  fingerprint_ = hash_of(fmt::format("{}", taken), btf_->fingerprint());
  leave_out({});
}

void Capture::open_samples() {
  table_ = std::make_shared<const TexelTable>(path_, kMaxSide, kMaxPictures);
  form_.width = table_->width();
  form_.height = table_->height();
  form_.own_directions = true;
  for (std::size_t p = 0; p < table_->pictures(); ++p)
    form_.pictures.push_back({.file = fmt::format("sample {}", p),
                              .light = {},
                              .view = {},
                              .mask = {},
                              .held_out = p >= table_->fitted_pictures()});
  fingerprint_ = table_->fingerprint();
  leave_out({});
}

void Capture::leave_out(const std::vector<LeftOut>& damaged) {
  for (const LeftOut& picture : damaged) {
    std::erase_if(form_.pictures, [&](const CapturePicture& p) { return p.file == picture.file; });
    left_out_.push_back(picture);
    fingerprint_ = hash_of(picture.file, fingerprint_);
  }
  const auto fitted = std::ranges::count(form_.pictures, false, &CapturePicture::held_out);
  if (static_cast<std::size_t>(fitted) < kMinPictures)
    throw Error::in_file(
        form_file().string(), fmt::format("at least {} pictures to fit", kMinPictures),
        left_out_.empty() ? fmt::format("{}", fitted)
                          : fmt::format("{}; the first that is left out: {}", fitted, left_out_.front().why));
}

int Capture::rows_within(std::size_t bytes) const noexcept {
  const std::size_t row = static_cast<std::size_t>(form_.width) * form_.pictures.size() *
                              (((table_ ? 9 : 3) * sizeof(float)) + sizeof(PixelState)) +
                          (btf_ ? btf_->row_bytes() : 0);
  return static_cast<int>(std::clamp<std::size_t>(bytes / std::max<std::size_t>(row, 1), 1,
                                                  static_cast<std::size_t>(form_.height)));
}

namespace {

/// Rows of a picture or mask of `folder`, as wide as the form says.
Image rows_of(const std::filesystem::path& folder, const std::string& file, const CaptureRows& rows,
              bool srgb) {
  Image found = read_picture_rows(folder / file, rows.first_row, rows.rows, srgb);
  if (found.width != rows.width)
    throw Error::in_file(file, fmt::format("{} pixels a row", rows.width), fmt::format("{}", found.width));
  return found;
}

/// Fills values and states of picture `p` from `pixels` and a mask, which may be empty.
void fill_picture(CaptureRows& rows, std::size_t p, const CaptureForm& form, const Image& pixels,
                  const Image& mask) {
  const CapturePicture& picture = form.pictures[p];
  const std::array<double, 3> scale{picture.scale.r, picture.scale.g, picture.scale.b};
  const std::size_t texels = rows.texels();
  for (std::size_t i = 0; i < texels; ++i) {
    PixelState state = mask.pixels.empty() || mask.pixels[3 * i] > 0 ? PixelState::there : PixelState::masked;
    float* const to = &rows.values[(p * texels + i) * 3];
    // The irradiance of a light at a point falls with the square of its distance.
    const int x = static_cast<int>(i % static_cast<std::size_t>(form.width));
    const Vec3 point =
        form.point(x, rows.first_row + static_cast<int>(i / static_cast<std::size_t>(form.width)));
    const Vec3 way = picture.light.at - point;
    const double fall = picture.light.is_direction ? 1 : dot(way, way);
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = pixels.pixels[3 * i + c];
      if (!(value >= kMinValue) || !std::isfinite(value)) state = PixelState::missing;
      if (form.clip && static_cast<double>(value) >= *form.clip && is_there(state))
        state = clipped_in(state, c);
      to[c] = static_cast<float>(static_cast<double>(value) * scale[c] * fall);
    }
    if (state == PixelState::missing) std::fill_n(to, 3, 0.0f);
    rows.states[p * texels + i] = state;
  }
}

}  // namespace

Capture::Read Capture::read(int first, int count) const {
  if (table_) return {.rows = table_->rows(first, count), .damaged = {}};
  const bool srgb = form_.transfer == Transfer::srgb;
  Read read;
  CaptureRows& rows = read.rows;
  rows = {.first_row = first,
          .rows = count,
          .width = form_.width,
          .pictures = form_.pictures.size(),
          .values = {},
          .states = {},
          .directions = {}};
  const std::size_t texels = rows.texels();
  rows.values.resize(rows.pictures * texels * 3);
  rows.states.resize(rows.pictures * texels, PixelState::missing);
  const auto factors = btf_ ? std::optional(btf_->rows(first, count)) : std::nullopt;
  std::vector<std::string> why(rows.pictures);
  for_each_chunk(rows.pictures, 1, [&](std::size_t p, std::size_t, std::size_t) {
    const CapturePicture& picture = form_.pictures[p];
    try {
      const Image pixels =
          factors ? factors->picture(btf_numbers_[p]) : rows_of(path_, picture.file, rows, srgb);
      Image mask;
      if (!picture.mask.empty()) mask = rows_of(path_, picture.mask, rows, false);
      fill_picture(rows, p, form_, pixels, mask);
    } catch (const Error& error) {
      why[p] = error.what();
      std::fill_n(rows.states.begin() + static_cast<std::ptrdiff_t>(p * texels), texels, PixelState::missing);
    }
  });
  for (std::size_t p = 0; p < why.size(); ++p)
    if (!why[p].empty()) read.damaged.push_back({form_.pictures[p].file, why[p]});
  return read;
}

std::vector<float> Capture::normals() const {
  if (form_.normals.empty()) return {};
  const std::filesystem::path path = path_ / form_.normals;
  const Image picture = read_picture_rows(path, 0, form_.height, false);
  if (picture.width != form_.width)
    throw Error::in_file(path.string(), fmt::format("{} pixels a row", form_.width),
                         fmt::format("{}", picture.width));
  std::vector<float> normals;
  normals.reserve(picture.pixels.size() / 3 * 2);
  for (std::size_t i = 0; i < picture.pixels.size(); i += 3) {
    const Vec3 found{static_cast<double>(picture.pixels[i]), static_cast<double>(picture.pixels[i + 1]),
                     static_cast<double>(picture.pixels[i + 2])};
    const double size = length(found);
    if (!(std::abs(size - 1) < kUnitTolerance) || !(found.z > 0))
      throw Error::in_file(path.string(), "unit vectors above the surface",
                           fmt::format("({}, {}, {}) in pixel {}", found.x, found.y, found.z, i / 3));
    normals.push_back(static_cast<float>(found.x / size));
    normals.push_back(static_cast<float>(found.y / size));
  }
  return normals;
}

}  // namespace burnish
