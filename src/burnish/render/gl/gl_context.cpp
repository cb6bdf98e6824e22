// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/render/gl/gl_context.h>

#if __has_include(<epoxy/egl.h>)
#include <epoxy/egl.h>
#define BURNISH_HAS_EGL 1
#else
#define BURNISH_HAS_EGL 0
#endif

namespace burnish {

#if BURNISH_HAS_EGL

namespace {

[[noreturn]] void fail(const char* what) {
  const EGLint code = eglGetError();
  throw Error(fmt::format("OpenGL: expected {}, found EGL error 0x{:x}", what, code));
}

// The context, made current. Throws Error where the display has no OpenGL 4.5 without a surface.
EGLContext open_display(EGLDisplay display) {
  if (!display || !eglInitialize(display, nullptr, nullptr)) fail("a display without a surface");
  const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglBindAPI(EGL_OPENGL_API) || !eglChooseConfig(display, wanted, &config, 1, &count) || count == 0)
    fail("OpenGL");
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION,
                            4,
                            EGL_CONTEXT_MINOR_VERSION,
                            5,
                            EGL_CONTEXT_OPENGL_PROFILE_MASK,
                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                            EGL_NONE};
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
  if (!context) fail("OpenGL 4.5");
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    eglDestroyContext(display, context);
    fail("OpenGL 4.5");
  }
  return context;
}

// EGL's devices but those that run on the processor; none where EGL cannot list them.
std::vector<EGLDeviceEXT> gpus() {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") ||
      !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_query") ||
      !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device"))
    return {};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(0, nullptr, &count)) return {};
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  if (!eglQueryDevicesEXT(count, devices.data(), &count)) return {};
  devices.resize(static_cast<std::size_t>(count));
  std::erase_if(devices, [](EGLDeviceEXT device) {
    const char* const extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
    return extensions &&
           std::string_view(extensions).find("EGL_MESA_device_software") != std::string_view::npos;
  });
  return devices;
}

}  // namespace

// Opens one of EGL's GPUs; returns false if none serves.
bool GlContext::open_gpu() {
  for (const EGLDeviceEXT gpu : gpus()) try {
      display_ = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, gpu, nullptr);
      context_ = open_display(display_);
      return true;
    } catch (const Error&) {  // another may serve
    }
  return false;
}

// Opens Mesa; returns false if it is missing. Throws Error if it is there without OpenGL 4.5.
bool GlContext::open_mesa() {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) return false;
  display_ = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  context_ = open_display(display_);
  return true;
}

GlContext::~GlContext() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);  // the display is the process's, and may have other contexts
}

#else  // a libepoxy without EGL, as of macOS: nothing draws

bool GlContext::open_gpu() {
  return false;
}

bool GlContext::open_mesa() {
  return false;
}

GlContext::~GlContext() = default;

#endif

GlContext::GlContext(GlDevice device) {
  if (device == GlDevice::gpu_first ? open_gpu() || open_mesa() : open_mesa() || open_gpu()) return;
  throw Error("OpenGL: expected EGL with EGL_MESA_platform_surfaceless or a GPU, found neither");
}

std::string GlContext::renderer() const {
  return reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

std::string GlContext::version() const {
  return reinterpret_cast<const char*>(glGetString(GL_VERSION));
}

bool GlContext::in_software() const {
  constexpr std::array<std::string_view, 3> kSoftware{"llvmpipe", "softpipe", "swrast"};
  const std::string name = renderer();
  return std::ranges::any_of(kSoftware, [&](std::string_view s) { return name.find(s) != name.npos; });
}

}  // namespace burnish
