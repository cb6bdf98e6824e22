#pragma once

#include <string>

namespace burnish {

/// A headless OpenGL 4.5 core context (EGL without a surface; Mesa's llvmpipe serves where there is no GPU),
/// current in the thread that made it until it is destroyed.
class GlContext {
 public:
  /// Throws Error if the machine has no EGL or no OpenGL 4.5.
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// What draws: "llvmpipe (LLVM 15.0.6, 256 bits)".
  std::string renderer() const;

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace burnish
