// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/ggx_proxy.h>
#include <burnish/render/cpu_renderer.h>
#include <burnish/render/ray_caster.h>

namespace burnish {

namespace {

struct SurfacePoint {
  Vec3 position, normal, tangent, bitangent;

  Vec3 local(Vec3 w) const noexcept { return {dot(tangent, w), dot(bitangent, w), dot(normal, w)}; }
};

SurfacePoint point_of(const Vertex& a, const Vertex& b, const Vertex& c, double u, double v) noexcept {
  const auto mix = [&](std::array<float, 3> Vertex::*field) {
    return (1 - u - v) * to_vec3(a.*field) + u * to_vec3(b.*field) + v * to_vec3(c.*field);
  };
  SurfacePoint p{.position = mix(&Vertex::position), .normal = normalize(mix(&Vertex::normal))};
  p.tangent = orthogonalized(mix(&Vertex::tangent), p.normal);
  p.bitangent = static_cast<double>(a.side) * cross(p.normal, p.tangent);
  return p;
}

SurfacePoint point_of(const Mesh& mesh, const SurfaceHit& hit) noexcept {
  const auto& [a, b, c] = mesh.triangles[hit.triangle];
  return point_of(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], hit.u, hit.v);
}

// [HomomorphicBrdf, eq. 2]; `shadows` may be null
Rgb shade(const Scene& scene, BrdfRef material, const SurfacePoint& point,
          const RayCaster* shadows) noexcept {
  const Vec3 wo = point.local(normalize(scene.camera.eye - point.position));
  Rgb sum;
  if (wo.z <= 0) return sum;
  for (const PointLight& light : scene.lights) {
    const Vec3 to_light = light.position - point.position;
    const double square = dot(to_light, to_light);
    const Vec3 wi = point.local(normalize(to_light));
    if (wi.z <= 0 || square == 0) continue;
    if (shadows && shadows->blocked(point.position, light.position)) continue;
    std::array<double, 3> f{};
    material.eval(wi, wo, std::span(f).first(material.channels()));
    if (material.channels() == 1) f[1] = f[2] = f[0];
    sum = sum + Rgb(wi.z / square) * Rgb(f[0], f[1], f[2]) * light.intensity;
  }
  return sum;
}

void check(const Scene& scene, std::span<const BrdfRef> materials, int width, int height) {
  check_scene(scene, width, height, materials.size());
  for (const BrdfRef& material : materials)
    if (material.channels() != 1 && material.channels() != 3)
      throw Error(fmt::format("scene: expected materials of 1 or 3 channels, found {}", material.channels()));
}

/// A surface at one place, in the frame there.
struct PlacedBrdf {
  const SpatialBrdf* surface;
  SpatialBrdf::Place place;

  std::size_t channels() const noexcept { return surface->channels(); }
  static bool isotropic() noexcept { return false; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    surface->eval(place, wi, wo, f);
    return true;
  }
};

// The weights of a triangle's second and third corner where a ray meets its plane; nothing where it is parallel.
std::optional<std::array<double, 2>> weights_in_plane(const std::array<Vec3, 3>& corners, Vec3 origin,
                                                      Vec3 direction) noexcept {
  const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0], p = cross(direction, b),
             to = origin - corners[0], q = cross(to, a);
  const double under = dot(a, p);  // [Moeller1997]
  if (under == 0) return {};
  return std::array{dot(to, p) / under, dot(direction, q) / under};
}

struct TexturePlace {
  double u = 0, v = 0;  ///< v downwards
};
TexturePlace texture_place(const std::array<const Vertex*, 3>& corners, double u, double v) noexcept {
  const auto mix = [&](std::size_t k) {
    return (1 - u - v) * static_cast<double>(corners[0]->uv[k]) + u * static_cast<double>(corners[1]->uv[k]) +
           v * static_cast<double>(corners[2]->uv[k]);
  };
  return {mix(0), 1 - mix(1)};
}

// The ray's direction through the middle of a pixel.
class Pixels {
 public:
  Pixels(const Camera& camera, int width, int height) noexcept
      : frame_(frame_of(camera)),
        step_(2 * std::tan(0.5 * camera.field_of_view) / height),
        width_(width),
        height_(height) {}
  Vec3 direction(int x, int y) const noexcept {
    return normalize(step_ * (x + 0.5 - 0.5 * width_) * frame_.right +
                     step_ * (0.5 * height_ - y - 0.5) * frame_.up - frame_.back);
  }

 private:
  CameraFrame frame_;
  double step_;
  int width_, height_;
};

// Returns the place where a pixel's ray meets a surface.
SpatialBrdf::Place place_of(const SpatialBrdf& surface, const Mesh& mesh, const SurfaceHit& hit, Vec3 eye,
                            const Pixels& pixels, int x, int y) noexcept {
  std::array<const Vertex*, 3> corners{};
  std::array<Vec3, 3> positions{};
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = &mesh.vertices[mesh.triangles[hit.triangle][k]];
    positions[k] = to_vec3(corners[k]->position);
  }
  const TexturePlace here = texture_place(corners, hit.u, hit.v);
  // a pixel's steps, by the rays through its neighbours
  double largest = 1;
  for (const auto& [i, j] : {std::pair(x + 1, y), std::pair(x, y + 1)})
    if (const auto weights = weights_in_plane(positions, eye, pixels.direction(i, j))) {
      const TexturePlace next = texture_place(corners, (*weights)[0], (*weights)[1]);
      const double across = surface.width() * (next.u - here.u), down = surface.height() * (next.v - here.v);
      largest = std::max(largest, across * across + down * down);
    }
  return surface.place(here.u, here.v, 0.5 * std::log2(largest));
}

void turn(SurfacePoint& point, const ShadingFrame& frame) noexcept {
  const auto world = [&](Vec3 w) { return w.x * point.tangent + w.y * point.bitangent + w.z * point.normal; };
  const Vec3 tangent = world(frame.tangent), bitangent = world(frame.bitangent), normal = world(frame.normal);
  point.tangent = tangent;
  point.bitangent = bitangent;
  point.normal = normal;
}

// The part of materials that is the same all over: BRDFs, and the means of surfaces.
struct MaterialMeans {
  std::vector<FactoredBrdf> models;
  std::vector<BrdfRef> refs;

  explicit MaterialMeans(std::span<const SceneMaterial> materials) {
    models.reserve(materials.size());
    for (const SceneMaterial& material : materials) {
      const auto* const surface = std::get_if<const SpatialBrdf*>(&material);
      refs.push_back(surface ? BrdfRef(models.emplace_back((*surface)->at(0, 0, 64)))
                             : std::get<BrdfRef>(material));
    }
  }
};

}  // namespace

Image render_cpu(const Scene& scene, std::span<const BrdfRef> materials, const CpuOptions& options) {
  return render_cpu(scene, std::vector<SceneMaterial>(materials.begin(), materials.end()), options);
}

Image render_cpu(const Scene& scene, std::span<const SceneMaterial> materials, const CpuOptions& options) {
  const MaterialMeans means(materials);
  check(scene, means.refs, options.width, options.height);
  const int side = static_cast<int>(std::lround(std::sqrt(std::max(options.draws, 0))));
  if (side < 1 || side > 1024 || side * side != options.draws)
    throw Error(fmt::format("scene: expected draws that are a square, found {}", options.draws));

  // light from all around is drawn by a lobe like each material's
  std::vector<GgxProxy> guides;
  if (options.environment)
    for (const BrdfRef& material : means.refs) guides.push_back(fit_ggx_proxy(material, true));

  // one ray a pixel; random numbers depend on the pixel alone
  const RayCaster caster(scene.parts);
  const Pixels pixels(scene.camera, options.width, options.height);
  Image image(options.width, options.height, 3);
  for_each_chunk(
      static_cast<std::size_t>(options.height), 4, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
          for (int x = 0; x < options.width; ++x) {
            Rgb value = scene.background;
            if (const auto hit = caster.nearest(scene.camera.eye, pixels.direction(x, y))) {
              const MeshPart& part = scene.parts[hit->part];
              const auto material = static_cast<std::size_t>(part.material);
              SurfacePoint point = point_of(part.mesh, *hit);
              std::optional<PlacedBrdf> placed;
              if (const auto* const surface = std::get_if<const SpatialBrdf*>(&materials[material])) {
                placed = PlacedBrdf{*surface,
                                    place_of(**surface, part.mesh, *hit, scene.camera.eye, pixels, x, y)};
                turn(point, placed->place.frame);
              }
              const BrdfRef brdf = placed ? BrdfRef(*placed) : means.refs[material];
              value = shade(scene, brdf, point, options.shadows ? &caster : nullptr);
              if (options.environment) {
                Pcg32 random(1, static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(options.width) +
                                    static_cast<std::uint64_t>(x));
                value = value + radiance_in_environment(brdf, guides[material], *options.environment,
                                                        {point.normal, point.tangent, point.bitangent},
                                                        normalize(scene.camera.eye - point.position), side,
                                                        random);
              }
            }
            const auto pixel = image.at(x, y);
            pixel[0] = static_cast<float>(value.r);
            pixel[1] = static_cast<float>(value.g);
            pixel[2] = static_cast<float>(value.b);
          }
      });
  return image;
}

std::vector<std::vector<Rgb>> shade_vertices(const Scene& scene, std::span<const BrdfRef> materials) {
  check(scene, materials, 1, 1);
  std::vector<std::vector<Rgb>> values;
  for (const auto& shown : scene.parts) {
    const BrdfRef brdf = materials[static_cast<std::size_t>(shown.material)];
    std::vector<Rgb>& part = values.emplace_back(shown.mesh.vertices.size());
    for_each_chunk(part.size(), 256, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vertex& vertex = shown.mesh.vertices[i];
        part[i] = shade(scene, brdf, point_of(vertex, vertex, vertex, 0, 0), nullptr);
      }
    });
  }
  return values;
}

std::vector<std::uint8_t> interior_pixels(const Scene& scene, int width, int height) {
  check_scene(scene, width, height, SIZE_MAX);
  const RayCaster caster(scene.parts);
  const Pixels pixels(scene.camera, width, height);

  // what every pixel shows
  struct Seen {
    std::size_t part = SIZE_MAX;
    Vec3 normal;
  };
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  };
  std::vector<Seen> seen(index(0, height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (const auto hit = caster.nearest(scene.camera.eye, pixels.direction(x, y)))
        seen[index(x, y)] = {hit->part, point_of(scene.parts[hit->part].mesh, *hit).normal};

  // interior: all eight neighbours show the same part, turned by less than 30 degrees
  std::vector<std::uint8_t> interior(seen.size());
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      const Seen& here = seen[index(x, y)];
      bool same = here.part != SIZE_MAX;
      for (int k = 0; same && k < 9; ++k) {
        const Seen& there = seen[index(x - 1 + k % 3, y - 1 + k / 3)];
        same = there.part == here.part && dot(there.normal, here.normal) > 0.866;
      }
      interior[index(x, y)] = same;
    }
  return interior;
}

}  // namespace burnish
