// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace burnish {

/// The devices that may draw.
enum class GlDevice {
  any,  ///< what Mesa takes without a surface, which may be llvmpipe beside a GPU of another driver; else a GPU
  gpu_first,  ///< a GPU that EGL lists, where one has OpenGL 4.5; else what Mesa takes
};

/// A headless OpenGL 4.5 core context (EGL without a surface; Mesa's llvmpipe serves where there is no GPU),
/// current in the thread that made it until it is destroyed.
class GlContext {
 public:
  /// Throws Error if the machine has no EGL or no OpenGL 4.5.
  explicit GlContext(GlDevice device = GlDevice::any);
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Returns the name of the renderer, such as "llvmpipe (LLVM 15.0.6, 256 bits)".
  std::string renderer() const;
  /// Its OpenGL and driver: "4.5 (Core Profile) Mesa 22.3.6".
  std::string version() const;
  /// Returns true if the renderer is one of Mesa's that run on the processor.
  bool in_software() const;

 private:
  bool open_gpu();
  bool open_mesa();

  [[maybe_unused]] void* display_ = nullptr;  // where there is EGL
  [[maybe_unused]] void* context_ = nullptr;
};

}  // namespace burnish
