// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <burnish/embedded_file.h>

namespace burnish {

/// The files *.glsl of gl/ and light/: GLSL without #version lines. Where a text says @NAME, with_marks puts what is
/// made of a model.
std::span<const EmbeddedFile> glsl_files();

}  // namespace burnish
