#pragma once

#include <gtest/gtest.h>

/// Whether this is a build with sanitizers.
#ifdef __SANITIZE_ADDRESS__
#define BURNISH_SANITIZED true
#else
#define BURNISH_SANITIZED false
#endif

/// The first statement of a test of how good something is, or of what browsers and compilers make of what was written.
/// The release build runs it; sanitizers would take ten times as long or see nothing of it, and other tests run the same
/// code there.
#ifdef __SANITIZE_ADDRESS__
#define BURNISH_SKIP_WHERE_SANITIZED() GTEST_SKIP() << "the release build tests this"
#else
#define BURNISH_SKIP_WHERE_SANITIZED() static_cast<void>(0)
#endif
