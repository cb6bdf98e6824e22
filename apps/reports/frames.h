#pragma once

#include <functional>
#include <string>
#include <vector>

#include <burnish/reflectance/brdf.h>
#include <burnish/render/gl/gl_context.h>
#include <burnish/render/gl/gl_renderer.h>

#include "report.h"

namespace burnish::reports {

/// What frames are drawn of: a torus knot of so many vertices, on a square of so many pixels.
inline constexpr int kFrameVertices = 10'000, kFrameSize = 1024;

/// A material as a shader draws it, and what it stands for.
struct FrameMaterial {
  std::string name;
  SurfaceShader shader;
  BrdfRef truth;  ///< refers to what its owner keeps
};

/// Seconds of one round of each task, all tasks in turn, as many rounds at once as take 10 ms or more.
std::vector<Times> time_rounds(const std::vector<std::function<void(int)>>& tasks, int repetitions);

/// The psnr in dB of a small picture by the shader, against the CPU renderer's of the truth. Needs a GlContext.
double picture_psnr(const FrameMaterial& material);

/// Below this the shader drew something else.
inline constexpr double kMinPicturePsnr = 40;
/// Throws Error, naming the material, where picture_psnr is below kMinPicturePsnr.
void check_picture(const FrameMaterial& material);

/// Milliseconds a frame of each material under so many lights, by time_rounds. Needs a GlContext.
std::vector<Times> time_frames(const std::vector<FrameMaterial>& materials, int lights, int repetitions);

/// The least milliseconds a frame of each material, the median in brackets, under each number of lights, and how many
/// times the first one's that is; `first` names it in the table, `report` in what is told meanwhile. Needs a GlContext.
Table frame_times(const std::string& report, const std::string& first,
                  const std::vector<FrameMaterial>& materials, const std::vector<int>& lights,
                  int repetitions);

/// What draws, in words: "a GPU: NAME, OpenGL VERSION", or "software, no GPU: llvmpipe (...) on PROCESSOR".
std::string drawn_by(const GlContext& context);

}  // namespace burnish::reports
