// SPDX-License-Identifier: Apache-2.0
#include "frames.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/render/cpu_renderer.h>
#include <burnish/render/mesh/shapes.h>
#include <burnish/render/picture.h>

namespace burnish::reports {

namespace {

Scene knot(int lights) {
  Scene scene;
  scene.parts = {{make_shape(Shape::torus_knot, kFrameVertices), 0}};
  fit_to_unit_sphere(scene.parts);
  for (int i = 0; i < lights; ++i) {
    const double turn = kTwoPi * i / lights;
    scene.lights.push_back({{3 * std::cos(turn), 3 * std::sin(turn), 3}, 20.0 / lights});
  }
  scene.camera = camera_for_unit_sphere(radians(20), radians(20));
  return scene;
}

}  // namespace

std::vector<Times> time_rounds(const std::vector<std::function<void(int)>>& tasks, int repetitions) {
  // So many rounds run at once that the wait at their end hardly counts.
  constexpr double kMinSeconds = 0.01;
  constexpr int kMaxRounds = 4096;
  int rounds = 1;
  const auto quickest = [&] {
    double least = kMinSeconds;
    for (const auto& task : tasks) {
      const Stopwatch watch;
      task(rounds);
      least = std::min(least, watch.seconds());
    }
    return least;
  };
  while (rounds < kMaxRounds && quickest() < kMinSeconds) rounds *= 2;

  std::vector<std::function<void()>> all;
  for (const auto& task : tasks) all.emplace_back([&task, rounds] { task(rounds); });
  std::vector<Times> times = time_in_turns(all, repetitions);
  for (Times& t : times) t = {t.least / rounds, t.median / rounds};
  return times;
}

double picture_psnr(const FrameMaterial& material) {
  const Scene scene = knot(4);
  constexpr int kSmall = 192;
  const GlRenderer renderer(scene, {&material.shader, 1}, kSmall, kSmall);
  renderer.draw();
  const Image truth = render_cpu(scene, {&material.truth, 1}, {.width = kSmall, .height = kSmall});
  const double exposure = automatic_exposure(truth, scene.background);
  return psnr(mean_squared_error(tone_map(renderer.read(), exposure), tone_map(truth, exposure)));
}

void check_picture(const FrameMaterial& material) {
  const double found = picture_psnr(material);
  if (!(found >= kMinPicturePsnr))
    throw Error(fmt::format("{}: expected a picture of at least {} dB, found {:.1f}", material.name,
                            kMinPicturePsnr, found));
}

std::vector<Times> time_frames(const std::vector<FrameMaterial>& materials, int lights, int repetitions) {
  const Scene scene = knot(lights);
  std::vector<std::unique_ptr<GlRenderer>> renderers;
  for (const FrameMaterial& material : materials) {
    renderers.push_back(
        std::make_unique<GlRenderer>(scene, std::span(&material.shader, 1), kFrameSize, kFrameSize));
    renderers.back()->draw();  // compiles the shader
  }

  std::vector<std::function<void(int)>> tasks;
  for (const auto& renderer : renderers)
    tasks.emplace_back([renderer = renderer.get()](int frames) { renderer->draw(frames); });
  std::vector<Times> times = time_rounds(tasks, repetitions);
  for (Times& t : times) t = {1000 * t.least, 1000 * t.median};
  return times;
}

Table frame_times(const std::string& report, const std::string& first,
                  const std::vector<FrameMaterial>& materials, const std::vector<int>& lights,
                  int repetitions) {
  std::vector<std::string> head{"material"};
  std::vector<std::vector<std::string>> rows;
  for (const FrameMaterial& material : materials) rows.push_back({material.name});
  for (const int count : lights) {
    head.push_back(fmt::format("{} light{}", count, count == 1 ? "" : "s"));
    head.push_back("of " + first);
    tell(fmt::format("{}: lights: {}", report, count));
    const std::vector<Times> times = time_frames(materials, count, repetitions);
    for (std::size_t i = 0; i < materials.size(); ++i) {
      const int digits = times[0].least < 10 ? 3 : 1;
      rows[i].push_back(fmt::format("{:.{}f} ({:.{}f})", times[i].least, digits, times[i].median, digits));
      rows[i].push_back(fmt::format("{:.2f}", times[i].least / times[0].least));
    }
  }
  Table table(head);
  for (const auto& row : rows) table.add(row);
  return table;
}

std::string drawn_by(const GlContext& context) {
  return context.in_software() ? fmt::format("software, no GPU: {} on {}", context.renderer(), processor())
                               : fmt::format("a GPU: {}, OpenGL {}", context.renderer(), context.version());
}

}  // namespace burnish::reports
