// SPDX-License-Identifier: Apache-2.0
// Measures the cost of a surface against a uniform model, and the accuracy of its mip levels.
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <burnish/capture/pictures/virtual_capture.h>
#include <burnish/eval/factored_eval.h>
#include <burnish/eval/spatial_eval.h>
#include <burnish/file.h>
#include <burnish/fitting/fit.h>
#include <burnish/math/random.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/render/scene.h>
#include <burnish/surface/widened_lobes.h>

#include "frames.h"
#include "report.h"

namespace burnish::reports {

namespace {

constexpr const char* kScene = R"({"version": 1, "width": 256, "height": 256,
  "materials": ["ggx:alpha_x=0.08,alpha_y=0.08,f0=0.6,kd=0.05", "ggx:alpha_x=0.3,alpha_y=0.3,f0=0.04,kd=0.6",
                "ggx:alpha_x=0.2,alpha_y=0.2,f0=0.8,kd=0", "ggx:alpha_x=0.6,alpha_y=0.6,f0=0.1,kd=0.3"],
  "shares": {"cells": 6, "seed": 3, "sharpness": 8}, "heights": {"cells": 12, "seed": 11, "amplitude": 0.012},
  "lights": {"count": 9, "angle_deg": 60}, "views": {"count": 1, "angle_deg": 30}})";

FileBytes bytes_of(std::string_view text) {
  const auto* const first = reinterpret_cast<const std::byte*>(text.data());
  return {.name = "scene", .bytes = {first, first + text.size()}};
}

// The scene's materials, each fitted with one lobe, with their shares as weights.
struct Surfaces {
  SpatialBrdf flat, bumpy, widened;
};
Surfaces surfaces_of(const SurfaceScene& scene) {
  std::vector<burnish::Table> tables;
  std::vector<Lobe> lobes;
  for (const Source& material : scene.materials) {
    tell(fmt::format("surfaces: {}", material.name));
    const std::vector<std::string> nodes{"z=200,power:0.5", "g=20x13x4,power:0.5"};
    const GivenLobes one{.model = "z(theta_h) g(theta_h,theta_d,phi_d)", .tables = nodes};
    const FactoredBrdf model = fit(material, {.form = one, .score = false}).model();
    for (Lobe lobe : model.lobes()) {
      for (FactorUse& use : lobe.factors) use.table += tables.size();
      if (lobe.scale.size() == 1) lobe.scale.resize(3, lobe.scale[0]);
      lobes.push_back(std::move(lobe));
    }
    for (burnish::Table table : model.tables()) {
      table.name += fmt::format("{}", lobes.size());
      tables.push_back(std::move(table));
    }
  }
  SurfaceMaps maps;
  for (const std::vector<float>& share : scene.shares)
    maps.weights.emplace_back(scene.width, scene.height, std::size_t{1}, TableFormat::unorm8, 1.0f,
                              std::span<const float>(share));
  const FactoredBrdf brdf(3, std::move(tables), std::move(lobes));
  SpatialBrdf flat(brdf, maps);
  std::vector<float> normals;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      const Vec3 n = scene_normal(scene, x, y);
      normals.push_back(static_cast<float>(n.x));
      normals.push_back(static_cast<float>(n.y));
    }
  maps.normals.emplace(scene.width, scene.height, std::size_t{2}, TableFormat::half, 1.0f,
                       std::span<const float>(normals));
  SpatialBrdf bumpy(brdf, std::move(maps)), widened = with_widened_lobes(bumpy);
  return {std::move(flat), std::move(bumpy), std::move(widened)};
}

// Returns f cos of a whole level under one light.
Image lit_level(const SpatialBrdf& surface, std::size_t level, Vec3 light, Vec3 view) {
  const SurfaceMap& map = surface.maps().weights.front();
  const int width = map.level_width(level), height = map.level_height(level);
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const SpatialBrdf::Place place =
          surface.place((x + 0.5) / width, (y + 0.5) / height, static_cast<double>(level));
      const Vec3 wi = place.frame.local(light), wo = place.frame.local(view);
      std::array<double, 3> f{};
      surface.eval(place, wi, wo, f);
      for (std::size_t c = 0; c < f.size(); ++c)
        image.at(x, y)[c] = static_cast<float>(f[c] * std::max(wi.z, 0.0));
    }
  return image;
}

// Returns the psnr of a level's pictures against averages of full pictures, all lights together. With `finer` the
// pictures are means of 4^finer samples of a level that is finer by so many steps.
double level_psnr(const SpatialBrdf& surface, const SurfaceScene& scene, std::size_t level,
                  std::size_t finer = 0) {
  double sum = 0;
  for (const Station& light : scene.lights) {
    const Vec3 view = scene.views.front().at;
    const Image full = lit_level(surface, 0, light.at, view), truth = averaged(full, 1 << level);
    const double exposure = 1 / percentile(full.pixels, 0.97);
    const Image shown = averaged(lit_level(surface, level - finer, light.at, view), 1 << finer);
    sum += mean_squared_error(tone_map(shown, exposure), tone_map(truth, exposure));
  }
  return psnr(sum / static_cast<double>(scene.lights.size()));
}

Table levels_table(const Surfaces& surfaces, const SurfaceScene& scene) {
  Table table({"level", "texels", "weights alone, dB", "with normals, dB", "lobes widened, dB",
               "4 samples, dB", "16 samples, dB", "64 samples, dB"});
  for (std::size_t level = 1; level <= 5; ++level) {
    std::vector<std::string> row{fmt::format("{}", level), fmt::format("{0} x {0}", scene.width >> level)};
    for (const SpatialBrdf* surface : {&surfaces.flat, &surfaces.bumpy, &surfaces.widened})
      row.push_back(fmt::format("{:.1f}", level_psnr(*surface, scene, level)));
    for (std::size_t finer = 1; finer <= 3; ++finer)
      row.push_back(finer < level ? fmt::format("{:.1f}", level_psnr(surfaces.widened, scene, level, finer))
                    : finer == level ? "exact"
                                     : "");
    table.add(row);
  }
  return table;
}

Table frames_table(const Surfaces& surfaces, int repetitions) {
  const FactoredBrdf& uniform = surfaces.flat.lobes();
  const auto shader = [](const auto& model) {
    return surface_shader(model, ShaderFilter::hardware, TableFormat::rgb9e5);
  };
  const std::vector<FrameMaterial> materials{
      {"uniform model", shader(uniform), uniform},
      {"surface, weights alone", shader(surfaces.flat), uniform},
      {"surface with normals", shader(surfaces.bumpy), uniform},
      {"surface with normals, lobes widened", shader(surfaces.widened), uniform}};
  check_picture(materials.front());
  return frame_times("surfaces", "the uniform model", materials, {1, 4}, repetitions);
}

// Returns the cost of a pair of directions at a place, beside a pair of the uniform model, and the cost of finding a
// place. Runs one by one on one thread.
Table evaluations_table(const Surfaces& surfaces, int turns) {
  constexpr std::size_t kPairs = 1 << 16;
  const std::vector<DirectionPair> pairs = draw_pairs(kPairs, 1, false);
  Pcg32 random(1);
  std::vector<std::array<double, 3>> places(kPairs);  // u, v, level of detail
  for (auto& place : places) place = {random.uniform(), random.uniform(), 3 * random.uniform()};
  std::vector<std::string> names;
  std::vector<std::function<void()>> tasks;
  const auto add = [&](std::string name, std::function<void()> task) {
    names.push_back(std::move(name));
    tasks.push_back(std::move(task));
  };

  const FactoredEvaluator uniform(surfaces.flat.at(0.5, 0.5));
  add("a pair, uniform model", [&] {
    std::array<float, 3> f{};
    for (const auto& [wi, wo] : pairs) {
      uniform.eval(wi, wo, std::span<float>(f));
      [[maybe_unused]] volatile float used = f[0] + f[1] + f[2];
    }
  });
  const SpatialEvaluator flat(surfaces.flat), bumpy(surfaces.bumpy);
  for (const auto& [surface, kind] : {std::pair(&flat, "weights alone"), std::pair(&bumpy, "with normals")}) {
    add(fmt::format("a pair at a place, {}", kind), [&pairs, surface = surface] {
      const SpatialEvaluator::Place place = surface->place(0.5, 0.5);
      std::array<float, 3> f{};
      for (const auto& [wi, wo] : pairs) {
        surface->eval(place, wi, wo, f);
        [[maybe_unused]] volatile float used = f[0] + f[1] + f[2];
      }
    });
    add(fmt::format("a place that is a texel, {}", kind), [&places, surface = surface] {
      const int width = surface->surface().width(), height = surface->surface().height();
      for (const auto& [u, v, lod] : places) {
        const SpatialEvaluator::Place place =
            surface->texel(static_cast<int>(u * width), static_cast<int>(v * height));
        [[maybe_unused]] volatile float used = place.weights[0] + static_cast<float>(place.frame.tangent.x);
      }
    });
    add(fmt::format("a place between two levels, {}", kind), [&places, surface = surface] {
      for (const auto& [u, v, lod] : places) {
        const SpatialEvaluator::Place place = surface->place(u, v, lod);
        [[maybe_unused]] volatile float used = place.weights[0] + static_cast<float>(place.frame.tangent.x);
      }
    });
  }
  const std::vector<Times> times = time_in_turns(tasks, turns);
  Table table({"what", "ns", "more than a pair of the uniform model"});
  const auto nanoseconds = [&](double seconds) { return 1e9 * seconds / static_cast<double>(kPairs); };
  for (std::size_t i = 0; i < tasks.size(); ++i)
    table.add({names[i],
               fmt::format("{:.1f} ({:.1f})", nanoseconds(times[i].least), nanoseconds(times[i].median)),
               i > 0 && names[i].starts_with("a pair")
                   ? fmt::format("{:.1f}", nanoseconds(times[i].least - times[0].least))
                   : ""});
  return table;
}

}  // namespace

void report_surfaces(const ReportOptions& options) {
  Page page(options, "surface-results");
  const SurfaceScene scene = parse_surface_scene(bytes_of(kScene), ".");
  const Surfaces surfaces = surfaces_of(scene);
  const int repetitions = options.quick ? 1 : 5;
  page["lobes"] = fmt::format("{}", surfaces.flat.lobes().lobes().size());
  page["levels"] = levels_table(surfaces, scene).markdown();
  page["evaluations"] = evaluations_table(surfaces, options.quick ? 1 : 15).markdown();
  const GlContext context(GlDevice::gpu_first);
  page["vertices"] = std::to_string(kFrameVertices);
  page["size"] = std::to_string(kFrameSize);
  page["repetitions"] = std::to_string(repetitions);
  page["renderer"] = drawn_by(context);
  page["times"] = frames_table(surfaces, repetitions).markdown();
  page.write();
}

}  // namespace burnish::reports
