#pragma once

#include <memory>
#include <string>

#include <burnish/error.h>
#include <burnish/render/gl_context.h>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace burnish {

/// A context for tests, or why there is none.
struct TestContext {
  std::unique_ptr<GlContext> context;
  std::string reason;

  TestContext() {
#ifdef __SANITIZE_ADDRESS__
    const __lsan::ScopedDisabler not_ours;  // what drivers keep when they are unloaded
#endif
    try {
      context = std::make_unique<GlContext>();
    } catch (const Error& error) {
      reason = error.what();
    }
  }
};

}  // namespace burnish
