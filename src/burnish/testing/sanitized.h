#pragma once

#include <gtest/gtest.h>

/// Whether this is a build with sanitizers.
#ifdef __SANITIZE_ADDRESS__
#define BURNISH_SANITIZED true
#else
#define BURNISH_SANITIZED false
#endif

/// The first statement of a test of how good something is. The release build runs it; with sanitizers it would take ten
/// times as long, and other tests run the same code there.
#ifdef __SANITIZE_ADDRESS__
#define BURNISH_SKIP_WHERE_SANITIZED() GTEST_SKIP() << "quality, which the release build tests"
#else
#define BURNISH_SKIP_WHERE_SANITIZED() static_cast<void>(0)
#endif
