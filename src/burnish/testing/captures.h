// SPDX-License-Identifier: Apache-2.0
#pragma once

// Small captures for tests.

#include <filesystem>
#include <string>

#include <burnish/capture/pictures/virtual_capture.h>
#include <burnish/testing/tools.h>

namespace burnish {

/// Returns a scene of two analytic materials in patches, with bumps; `more` adds members to its JSON.
inline SurfaceScene small_scene(int side, int lights, const std::string& more = "") {
  const std::string text =
      R"({"version":1,"width":)" + std::to_string(side) + R"(,"height":)" + std::to_string(side) +
      R"(,"materials":["lambert:kd=0.7/0.2/0.1","ggx:alpha_x=0.25,alpha_y=0.25,f0=0.6"],)"
      R"("shares":{"cells":2,"seed":5,"sharpness":12},)"
      R"("heights":{"cells":3,"seed":2,"amplitude":0.02},)"
      R"("lights":{"count":)" +
      std::to_string(lights) + R"(,"angle_deg":60},"views":{"count":2,"angle_deg":40})" +
      (more.empty() ? "" : "," + more) + "}";
  return parse_surface_scene(memory_file(text), ".");
}

/// Writes small_scene as a capture into a folder.
inline CaptureForm small_capture(const std::filesystem::path& folder, int side, int lights,
                                 const std::string& more = "") {
  return write_virtual_capture(small_scene(side, lights, more), folder);
}

}  // namespace burnish
