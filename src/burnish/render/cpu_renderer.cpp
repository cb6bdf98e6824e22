#include <algorithm>
#include <array>
#include <cmath>

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

}  // namespace

Image render_cpu(const Scene& scene, std::span<const BrdfRef> materials, const CpuOptions& options) {
  check(scene, materials, options.width, options.height);
  const int side = static_cast<int>(std::lround(std::sqrt(std::max(options.draws, 0))));
  if (side < 1 || side > 1024 || side * side != options.draws)
    throw Error(fmt::format("scene: expected draws that are a square, found {}", options.draws));

  // light from all around is drawn by a lobe like each material's
  std::vector<GgxProxy> guides;
  if (options.environment)
    for (const BrdfRef& material : materials) guides.push_back(fit_ggx_proxy(material, true));

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
              const SurfacePoint point = point_of(part.mesh, *hit);
              value = shade(scene, materials[material], point, options.shadows ? &caster : nullptr);
              if (options.environment) {
                Pcg32 random(1, static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(options.width) +
                                    static_cast<std::uint64_t>(x));
                value = value +
                        radiance_in_environment(materials[material], guides[material], *options.environment,
                                                {point.normal, point.tangent, point.bitangent},
                                                normalize(scene.camera.eye - point.position), side, random);
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
  for (const auto& [mesh, material] : scene.parts) {
    const BrdfRef brdf = materials[static_cast<std::size_t>(material)];
    std::vector<Rgb>& part = values.emplace_back(mesh.vertices.size());
    for_each_chunk(part.size(), 256, [&, &mesh = mesh](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vertex& vertex = mesh.vertices[i];
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
