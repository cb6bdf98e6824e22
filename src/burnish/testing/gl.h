#pragma once

#include <memory>
#include <string>

#include <burnish/error.h>
#include <burnish/render/gl/gl_context.h>

namespace burnish {

/// A context for tests, or why there is none.
struct TestContext {
  std::unique_ptr<GlContext> context;
  std::string reason;

  TestContext() {
    try {
      context = std::make_unique<GlContext>();
    } catch (const Error& error) {
      reason = error.what();
    }
  }
};

}  // namespace burnish
