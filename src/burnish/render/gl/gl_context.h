#pragma once

#include <string>

namespace burnish {

/// What may draw.
enum class GlDevice {
  any,  ///< what EGL takes without a surface: Mesa's, which may be llvmpipe beside a GPU of another driver
  gpu_first,  ///< a GPU that EGL lists, where one has OpenGL 4.5; else any
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

  /// What draws: "llvmpipe (LLVM 15.0.6, 256 bits)".
  std::string renderer() const;
  /// Whether that is one of Mesa's renderers that run on the processor.
  bool in_software() const;

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace burnish
