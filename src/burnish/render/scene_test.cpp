// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/math/random.h>
#include <burnish/render/scene.h>
#include <burnish/testing/directions.h>

namespace burnish {
namespace {

TEST(Camera, HasARightHandedFrame) {
  Pcg32 random(2);
  for (int i = 0; i < 500; ++i) {
    const Camera camera{.eye = 3 * random_direction(random), .target = 0.5 * random_direction(random)};
    const CameraFrame frame = frame_of(camera);
    EXPECT_NEAR(length(frame.right), 1, 1e-12);
    EXPECT_NEAR(length(frame.up), 1, 1e-12);
    EXPECT_NEAR(dot(frame.right, frame.back), 0, 1e-9);
    EXPECT_NEAR(length(cross(frame.right, frame.up) - frame.back), 0, 1e-9);
    EXPECT_NEAR(dot(frame.right, camera.up), 0, 1e-9) << "the horizon is level";
  }
}

TEST(Camera, HasTheWholeUnitSphereInItsFrame) {
  for (const double yaw : {-2.0, 0.0, 0.7})
    for (const double pitch : {-1.0, 0.0, 1.2}) {
      const Camera camera = camera_for_unit_sphere(yaw, pitch);
      // the cone of tangents, seen from the eye
      EXPECT_LT(std::asin(1 / length(camera.eye - camera.target)), 0.5 * camera.field_of_view);
    }
}

TEST(Scene, FitsPartsIntoTheUnitSphereTogether) {
  Pcg32 random(3);
  std::vector<MeshPart> parts(2);
  for (MeshPart& part : parts)
    for (int i = 0; i < 20; ++i)
      part.mesh.vertices.push_back({.position = to_floats(Vec3{5, -2, 9} + 7 * random_direction(random))});
  fit_to_unit_sphere(parts);
  const Bounds bounds = bounds_of(parts);
  EXPECT_NEAR(length(bounds.middle()), 0, 1e-6);
  double farthest = 0;
  for (const MeshPart& part : parts)
    for (const Vertex& v : part.mesh.vertices) farthest = std::max(farthest, length(to_vec3(v.position)));
  EXPECT_NEAR(farthest, 1, 1e-6);
}

TEST(Scene, IsCheckedBeforeItIsDrawn) {
  Scene scene;
  scene.parts.resize(1);
  scene.parts[0].mesh.vertices.resize(3);
  scene.parts[0].mesh.triangles = {{0, 1, 2}};
  EXPECT_NO_THROW(check_scene(scene, 16, 16, 1));
  EXPECT_THROW(check_scene(scene, 0, 16, 1), Error);
  EXPECT_THROW(check_scene(scene, 16, 20'000, 1), Error);
  EXPECT_THROW(check_scene(scene, 16, 16, 0), Error) << "no material for the part";
  Scene bad = scene;
  bad.parts[0].mesh.triangles[0][2] = 3;
  EXPECT_THROW(check_scene(bad, 16, 16, 1), Error);
  bad = scene;
  bad.camera.target = bad.camera.eye;
  EXPECT_THROW(check_scene(bad, 16, 16, 1), Error);
  bad = scene;
  for (const double angle : {0.0, -1.0, 4.0, std::numeric_limits<double>::quiet_NaN()}) {
    bad.camera.field_of_view = angle;
    EXPECT_THROW(check_scene(bad, 16, 16, 1), Error) << angle;
  }
}

}  // namespace
}  // namespace burnish
