// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

/// True in a build with sanitizers.
#ifdef __SANITIZE_ADDRESS__
#define BURNISH_SANITIZED true
#else
#define BURNISH_SANITIZED false
#endif

/// The first statement of a test of quality, or of browsers and compilers that read written files. The release build
/// runs such a test. Sanitizers would take ten times as long or see nothing of it, and other tests run the same code
/// there.
#ifdef __SANITIZE_ADDRESS__
#define BURNISH_SKIP_WHERE_SANITIZED() GTEST_SKIP() << "the release build tests this"
#else
#define BURNISH_SKIP_WHERE_SANITIZED() static_cast<void>(0)
#endif
