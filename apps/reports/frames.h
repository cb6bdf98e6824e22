// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <burnish/reflectance/brdf.h>
#include <burnish/render/gl/gl_context.h>
#include <burnish/render/gl/gl_renderer.h>

#include "report.h"

namespace burnish::reports {

/// Frames show a torus knot of so many vertices on a square of so many pixels.
inline constexpr int kFrameVertices = 10'000, kFrameSize = 1024;

/// A material's shader, and the BRDF that it stands for.
struct FrameMaterial {
  std::string name;
  SurfaceShader shader;
  BrdfRef truth;  ///< its owner must outlive it
};

/// Returns the seconds of one round of each task. Tasks run in turn, with as many rounds at once as take 10 ms or more.
std::vector<Times> time_rounds(const std::vector<std::function<void(int)>>& tasks, int repetitions);

/// Returns the psnr in dB of the shader's small picture against the CPU renderer's of the truth. Needs a GlContext.
double picture_psnr(const FrameMaterial& material);

/// A psnr below this means that the shader drew something else.
inline constexpr double kMinPicturePsnr = 40;
/// Throws Error, naming the material, where picture_psnr is below kMinPicturePsnr.
void check_picture(const FrameMaterial& material);

/// Returns the milliseconds a frame of each material under so many lights, by time_rounds. Needs a GlContext.
std::vector<Times> time_frames(const std::vector<FrameMaterial>& materials, int lights, int repetitions);

/// Returns a table of milliseconds a frame for each material and number of lights: the least, and the median in
/// brackets. A second column has the ratio to the first material's. `first` names that material in the table; `report`
/// begins the messages meanwhile. Needs a GlContext.
Table frame_times(const std::string& report, const std::string& first,
                  const std::vector<FrameMaterial>& materials, const std::vector<int>& lights,
                  int repetitions);

/// Describes the device: "a GPU: NAME, OpenGL VERSION", or "software, no GPU: llvmpipe (...) on PROCESSOR".
std::string drawn_by(const GlContext& context);

}  // namespace burnish::reports
