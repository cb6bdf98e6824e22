// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/math/angles.h>
#include <burnish/render/mesh/shapes.h>
#include <burnish/render/scene.h>

namespace burnish {

/// Returns a scene: a knot of material 0 with a sphere of material 1 before it, under three lights.
inline Scene knot_and_sphere() {
  Scene scene;
  scene.parts = {{make_shape(Shape::torus_knot, 6000), 0}, {make_shape(Shape::sphere, 1500), 1}};
  for (Vertex& v : scene.parts[1].mesh.vertices)
    v.position = to_floats(0.3 * to_vec3(v.position) + Vec3{0.6, -0.5, 0.6});
  scene.lights = {{{2, 3, 4}, {20, 15, 10}}, {{-3, 1, 2}, {5, 9, 12}}, {{0.5, -4, 1}, 6}};
  fit_to_unit_sphere(scene.parts);
  scene.camera = camera_for_unit_sphere(radians(20), radians(15));
  scene.background = {0.02, 0.03, 0.05};
  return scene;
}

}  // namespace burnish
