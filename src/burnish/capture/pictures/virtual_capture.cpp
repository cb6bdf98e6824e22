// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <thread>

#include <Imath/half.h>
#include <fmt/format.h>

#include <burnish/capture/pictures/json_member.h>
#include <burnish/capture/pictures/picture_rows.h>
#include <burnish/capture/pictures/virtual_capture.h>
#include <burnish/error.h>
#include <burnish/image/png.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/render/ray_caster.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

namespace {

constexpr int kSceneVersion = 1, kMaxCaptureSide = 16'384, kMaxStations = 4096, kOctaves = 3;

std::size_t place(int width, int x, int y) noexcept {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

double normal_deviate(Pcg32& random) noexcept {  // by Box and Muller
  const double u = 1 - random.uniform(), v = random.uniform();
  return std::sqrt(-2 * std::log(u)) * std::cos(kTwoPi * v);
}

/// Returns noise with values in about [-1, 1], cubic between nodes that repeat.
std::vector<float> noise_values(const NoiseMap& map, int width, int height) {
  std::vector<float> values(place(width, 0, height));
  for (int octave = 0; octave < kOctaves; ++octave) {
    const int cells = map.cells << octave;
    Pcg32 random(map.seed, static_cast<std::uint64_t>(octave));
    std::vector<double> nodes(place(cells, 0, cells));
    for (double& node : nodes) node = 2 * random.uniform() - 1;
    const auto at = [&](int i, int j) {
      return nodes[place(cells, (i + cells) % cells, (j + cells) % cells)];
    };
    const auto smooth = [](double t) { return t * t * t * (t * (6 * t - 15) + 10); };
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double u = (x + 0.5) / width * cells, v = (y + 0.5) / height * cells;
        const int i = static_cast<int>(u), j = static_cast<int>(v);
        const double fx = smooth(u - i), fy = smooth(v - j);
        const double low = at(i, j) + fx * (at(i + 1, j) - at(i, j));
        const double high = at(i, j + 1) + fx * (at(i + 1, j + 1) - at(i, j + 1));
        values[place(width, x, y)] += static_cast<float>(std::ldexp(low + fy * (high - low), -octave));
      }
  }
  return values;
}

/// Reads a picture as the mean over its channels.
std::vector<float> picture_values(const std::filesystem::path& path, int width, int height) {
  const PictureSize size = picture_size(path);
  if (size.width != width || size.height != height)
    throw Error::in_file(path.string(), fmt::format("{} x {} pixels", width, height),
                         fmt::format("{} x {}", size.width, size.height));
  const Image picture = read_picture_rows(path, 0, height, false);
  std::vector<float> values;
  for (std::size_t i = 0; i < picture.pixels.size(); i += 3) {
    values.push_back((picture.pixels[i] + picture.pixels[i + 1] + picture.pixels[i + 2]) / 3);
    if (!std::isfinite(values.back())) throw Error::in_file(path.string(), "finite values", "others");
  }
  return values;
}

NoiseMap parse_noise(const JsonMember& member) {
  NoiseMap map{.cells = member.at("cells").integer(1, 256)};
  if (member.has("seed")) map.seed = static_cast<std::uint64_t>(member.at("seed").integer(0, 1 << 30));
  return map;
}

/// Reads a list of stations, or a count of them, spread evenly over the directions within an angle of the normal.
std::vector<Station> parse_stations(const JsonMember& member) {
  std::vector<Station> stations;
  if (member.is_list()) {
    for (const JsonMember& item : member.list(1, kMaxStations)) stations.push_back(parse_station(item));
    return stations;
  }
  member.has_only({"count", "angle_deg"});
  const int count = member.at("count").integer(1, kMaxStations);
  const double angle = radians(member.has("angle_deg") ? member.at("angle_deg").number(0, 85) : 70);
  for (int i = 0; i < count; ++i) {
    constexpr double kGoldenStep = 0.6180339887498949;
    const double z = 1 - (1 - std::cos(angle)) * (i + 0.5) / count;
    stations.push_back({.is_direction = true,
                        .at = spherical_direction(std::acos(z), kTwoPi * std::fmod(i * kGoldenStep, 1.0))});
  }
  return stations;
}

/// Reads shares: the softmax of noise, or pictures divided by their sum.
std::vector<std::vector<float>> parse_shares(const JsonMember& root, const SurfaceScene& scene,
                                             const std::filesystem::path& folder) {
  const std::size_t count = scene.materials.size(), texels = place(scene.width, 0, scene.height);
  if (count == 1 || !root.has("shares")) {
    if (count > 1) root.fail("shares of the materials");
    return {std::vector<float>(texels, 1)};
  }
  const JsonMember member = root.at("shares");
  std::vector<std::vector<float>> shares;
  if (member.is_list()) {
    for (const JsonMember& item : member.list(count, count))
      shares.push_back(picture_values(folder / item.file(), scene.width, scene.height));
  } else {
    member.has_only({"cells", "seed", "sharpness"});
    NoiseMap noise = parse_noise(member);
    const double sharpness = member.has("sharpness") ? member.at("sharpness").number(0, 100) : 8;
    for (std::size_t m = 0; m < count; ++m, noise.seed += 1000) {
      shares.push_back(noise_values(noise, scene.width, scene.height));
      for (float& value : shares.back())
        value = static_cast<float>(std::exp(sharpness * static_cast<double>(value)));
    }
  }
  for (std::size_t i = 0; i < texels; ++i) {
    double sum = 0;
    for (const auto& map : shares) {
      if (map[i] < 0) member.fail("shares >= 0");
      sum += static_cast<double>(map[i]);
    }
    if (!(sum > 0)) member.fail("some material in every texel");
    for (auto& map : shares) map[i] = static_cast<float>(static_cast<double>(map[i]) / sum);
  }
  return shares;
}

std::vector<float> parse_heights(const JsonMember& member, const SurfaceScene& scene,
                                 const std::filesystem::path& folder) {
  member.has_only({"file", "cells", "seed", "amplitude"});
  const double amplitude = member.at("amplitude").number(0, 1e6);
  std::vector<float> heights =
      member.has("file") ? picture_values(folder / member.at("file").file(), scene.width, scene.height)
                         : noise_values(parse_noise(member), scene.width, scene.height);
  for (float& value : heights) value = static_cast<float>(amplitude * static_cast<double>(value));
  return heights;
}

/// Returns the heights as triangles, with one vertex at each texel's middle.
MeshPart mesh_of(const SurfaceScene& scene, const CaptureForm& form) {
  MeshPart part;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      Vec3 point = form.point(x, y);
      point.z = static_cast<double>(scene.heights[place(scene.width, x, y)]);
      part.mesh.vertices.push_back({.position = to_floats(point)});
    }
  const auto corner = [&](int x, int y) { return static_cast<std::uint32_t>(place(scene.width, x, y)); };
  for (int y = 0; y + 1 < scene.height; ++y)
    for (int x = 0; x + 1 < scene.width; ++x) {
      part.mesh.triangles.push_back({corner(x, y), corner(x, y + 1), corner(x + 1, y)});
      part.mesh.triangles.push_back({corner(x + 1, y), corner(x, y + 1), corner(x + 1, y + 1)});
    }
  return part;
}

/// Takes pictures of one scene.
class SceneCamera {
 public:
  SceneCamera(const SurfaceScene& scene, const CaptureForm& form) : scene_(scene), form_(form) {
    for (const Source& material : scene.materials)
      if (material.ref().channels() != 3 && material.ref().channels() != 1)
        throw Error(fmt::format("surface scene: expected materials of 1 or 3 channels, found {} of {}",
                                material.ref().channels(), material.name));
    if (scene.heights.empty() || !scene.shadows) return;
    parts_.push_back(mesh_of(scene, form));
    caster_ = std::make_unique<RayCaster>(parts_);
    for (const auto* stations : {&scene.lights, &scene.views})
      for (const Station& station : *stations) seen_.push_back(seen_from(station));
  }

  struct Shot {
    Image picture;
    Image8 mask;
  };
  Shot shoot(std::size_t light, std::size_t view, std::size_t number) const {
    const int width = scene_.width, height = scene_.height;
    Shot shot{Image(width, height, 3), Image8(width, height, 3)};
    Pcg32 random(scene_.seed, number);
    // Some pictures are shifted by a texel.
    int dx = 0, dy = 0;
    if (random.uniform() < scene_.misregistered) {
      const std::uint32_t side = random.next() % 4;
      (side < 2 ? dx : dy) = side % 2 == 0 ? 1 : -1;
    }
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const int from_x = std::clamp(x + dx, 0, width - 1), from_y = std::clamp(y + dy, 0, height - 1);
        const std::size_t from = place(width, from_x, from_y);
        const bool lit =
            seen_.empty() || (seen_[light][from] != 0 && seen_[scene_.lights.size() + view][from] != 0);
        const Vec3 point = form_.point(from_x, from_y);
        std::array<double, 3> value{};
        if (lit)
          value = scene_radiance(scene_, from_x, from_y, scene_.lights[light].seen_from(point),
                                 scene_.views[view].seen_from(point));
        const Vec3 way = scene_.lights[light].at - point;
        const double fall = scene_.lights[light].is_direction ? 1 : 1 / dot(way, way);
        for (std::size_t c = 0; c < 3; ++c) {
          double v = value[c] * fall;
          if (scene_.noise > 0) v *= std::exp(scene_.noise * normal_deviate(random));
          if (scene_.clip) v = std::min(v, *scene_.clip);
          shot.picture.at(x, y)[c] = static_cast<float>(v);
          shot.mask.at(x, y)[c] = lit ? 255 : 0;
        }
      }
    return shot;
  }

 private:
  std::vector<std::uint8_t> seen_from(const Station& station) const {
    constexpr double kLift = 0.2;  // in texels
    const double texel = scene_.size_x / scene_.width, far = 2 * std::hypot(scene_.size_x, scene_.size_y);
    std::vector<std::uint8_t> seen(place(scene_.width, 0, scene_.height));
    for_each_chunk(
        static_cast<std::size_t>(scene_.height), 1, [&](std::size_t, std::size_t row, std::size_t) {
          const int y = static_cast<int>(row);
          for (int x = 0; x < scene_.width; ++x) {
            const Vec3 flat = form_.point(x, y), way = station.seen_from(flat);
            const Vec3 from = flat +
                              Vec3{0, 0, static_cast<double>(scene_.heights[place(scene_.width, x, y)])} +
                              kLift * texel * scene_normal(scene_, x, y);
            seen[place(scene_.width, x, y)] = !caster_->blocked(from, from + far * way);
          }
        });
    return seen;
  }

  const SurfaceScene& scene_;
  const CaptureForm& form_;
  std::vector<MeshPart> parts_;
  std::unique_ptr<RayCaster> caster_;
  std::vector<std::vector<std::uint8_t>> seen_;  // lights, then views
};

}  // namespace

SurfaceScene parse_surface_scene(const FileBytes& file, const std::filesystem::path& folder) {
  const Json json = parse_json(file);
  const JsonMember root(file, json, "");
  root.at("version").integer(kSceneVersion, kSceneVersion);
  root.has_only({"version", "width", "height", "size", "materials", "shares", "heights", "lights", "views",
                 "noise", "clip", "shadows", "misregistered", "held_out", "normals", "seed"});
  SurfaceScene scene;
  scene.width = root.at("width").integer(1, kMaxCaptureSide);
  scene.height = root.at("height").integer(1, kMaxCaptureSide);
  if (root.has("size")) {
    const std::vector<JsonMember> size = root.at("size").list(2, 2);
    scene.size_x = size[0].number(1e-6, 1e6);
    scene.size_y = size[1].number(1e-6, 1e6);
  }
  for (const JsonMember& item : root.at("materials").list(1, 64)) {
    const std::string name = item.text();
    const std::filesystem::path beside = folder / name;
    std::error_code none;
    scene.materials.push_back(
        open_source(std::filesystem::is_regular_file(beside, none) ? beside.string() : name, {}));
  }
  scene.shares = parse_shares(root, scene, folder);
  if (root.has("heights")) scene.heights = parse_heights(root.at("heights"), scene, folder);
  scene.lights = parse_stations(root.at("lights"));
  scene.views = parse_stations(root.at("views"));
  if (root.has("noise")) scene.noise = root.at("noise").number(0, 1);
  if (root.has("clip")) scene.clip = root.at("clip").number(1e-6, 1e6);
  if (root.has("shadows")) scene.shadows = root.at("shadows").truth();
  if (root.has("misregistered")) scene.misregistered = root.at("misregistered").number(0, 1);
  if (root.has("held_out")) scene.held_out = root.at("held_out").integer(0, kMaxStations);
  if (root.has("normals")) scene.give_normals = root.at("normals").truth();
  if (root.has("seed")) scene.seed = static_cast<std::uint64_t>(root.at("seed").integer(0, 1 << 30));
  return scene;
}

Vec3 scene_normal(const SurfaceScene& scene, int x, int y) noexcept {
  if (scene.heights.empty()) return {0, 0, 1};
  const int w = scene.width, h = scene.height;
  const auto height = [&](int i, int j) {
    return static_cast<double>(scene.heights[place(w, (i + w) % w, (j + h) % h)]);
  };
  // rows run from +y to -y
  const double slope_x = (height(x + 1, y) - height(x - 1, y)) / (2 * scene.size_x / w);
  const double slope_y = (height(x, y - 1) - height(x, y + 1)) / (2 * scene.size_y / h);
  return normalize({-slope_x, -slope_y, 1});
}

std::array<double, 3> scene_radiance(const SurfaceScene& scene, int x, int y, Vec3 wi, Vec3 wo) {
  const ShadingFrame frame = frame_about(scene_normal(scene, x, y), {1, 0, 0});
  const Vec3 light = frame.local(wi), view = frame.local(wo);
  std::array<double, 3> sum{}, f{};
  if (light.z <= 0 || view.z <= 0) return sum;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const double share = static_cast<double>(scene.shares[m][place(scene.width, x, y)]);
    constexpr double kMinShare = 1e-4;
    if (share < kMinShare) continue;
    const SymmetrizedBrdf brdf(scene.materials[m].ref());
    brdf.eval(light, view, std::span(f).first(brdf.channels()));
    if (brdf.channels() == 1) f.fill(f[0]);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += share * f[c] * light.z;
  }
  return sum;
}

CaptureForm write_virtual_capture(const SurfaceScene& scene, const std::filesystem::path& folder,
                                  const std::function<void(double)>& progress) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error::in_file(folder.string(), "a folder that can be written", failed.message());
  CaptureForm form{.width = scene.width,
                   .height = scene.height,
                   .size_x = scene.size_x,
                   .size_y = scene.size_y,
                   .clip = {},
                   .normals = {},
                   .pictures = {}};
  for (std::size_t v = 0; v < scene.views.size(); ++v)
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
      const std::size_t number = form.pictures.size();
      CapturePicture picture{.file = fmt::format("{:05}.exr", number),
                             .light = scene.lights[l],
                             .view = scene.views[v],
                             .mask = {}};
      picture.held_out = scene.held_out > 0 && number % static_cast<std::size_t>(scene.held_out) ==
                                                   static_cast<std::size_t>(scene.held_out) / 2;
      if (picture.held_out && !scene.heights.empty() && scene.shadows)
        picture.mask = fmt::format("{:05}_mask.png", number);
      form.pictures.push_back(std::move(picture));
    }

  // Pictures are halves: clipped pixels have the half nearest to the scene's clip value.
  if (scene.clip)
    form.clip = static_cast<double>(static_cast<float>(Imath::half(static_cast<float>(*scene.clip))));
  const SceneCamera camera(scene, form);
  std::atomic<std::size_t> done = 0;
  const std::thread::id caller = std::this_thread::get_id();
  for_each_chunk(form.pictures.size(), 1, [&](std::size_t p, std::size_t, std::size_t) {
    const SceneCamera::Shot shot = camera.shoot(p % scene.lights.size(), p / scene.lights.size(), p);
    write_then_rename(folder / form.pictures[p].file, encode_half_exr(shot.picture));
    if (!form.pictures[p].mask.empty()) write_png(folder / form.pictures[p].mask, shot.mask);
    const std::size_t count = ++done;
    if (progress && std::this_thread::get_id() == caller)
      progress(static_cast<double>(count) / static_cast<double>(form.pictures.size()));
  });
  if (scene.give_normals && !scene.heights.empty()) {
    Image normals(scene.width, scene.height, 3);
    for (int y = 0; y < scene.height; ++y)
      for (int x = 0; x < scene.width; ++x) {
        const auto n = to_floats(scene_normal(scene, x, y));
        std::ranges::copy(n, normals.at(x, y).begin());
      }
    form.normals = "normals.exr";
    write_then_rename(folder / form.normals, encode_half_exr(normals));
  }
  write_then_rename(folder / "capture.json", format_capture(form));
  if (progress) progress(1);
  return form;
}

}  // namespace burnish
