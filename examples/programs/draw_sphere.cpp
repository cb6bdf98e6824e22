// SPDX-License-Identifier: Apache-2.0
// Draws a material by ray casting with burnish::render: draw_sphere MATERIAL RESULT.png. The material is anything that
// open_source accepts.
#include <array>
#include <cstdio>
#include <exception>

#include <burnish/image/png.h>
#include <burnish/io/open_source.h>
#include <burnish/render/cpu_renderer.h>
#include <burnish/render/mesh/shapes.h>
#include <burnish/render/picture.h>

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: draw_sphere MATERIAL RESULT.png\n");
    return 2;
  }
  try {
    const burnish::Source source = burnish::open_source(arguments[1], {});
    const burnish::Scene scene{.parts = {{.mesh = burnish::make_sphere(64, 32)}},
                               .lights = {{.position = {3, 4, 5}, .intensity = {100, 100, 100}}},
                               .camera = burnish::camera_for_unit_sphere(0, 0)};
    const std::array<burnish::BrdfRef, 1> materials{source.ref()};
    const burnish::Image picture = burnish::render_cpu(scene, materials, {.width = 128, .height = 128});
    burnish::write_png(arguments[2], burnish::to_bytes(picture, 1, burnish::Tone::srgb));
    std::printf("%s is written\n", arguments[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
