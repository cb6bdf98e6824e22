// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/embedded_file.h>

namespace burnish {

/// The files of web/.
std::span<const EmbeddedFile> web_files();

/// A script of web/ with `model`, JavaScript, in place of its MODEL.
std::string web_script(std::string_view file, const std::string& model);

/// In 64 digits with padding, as RFC 4648, section 4, has them.
std::string base64(std::span<const std::byte> bytes);

/// Texels of 1 or 3 channels as half floats of four in base64: what WebGL2 filters without an extension.
std::string half_texels(const std::vector<float>& values, std::size_t channels);

}  // namespace burnish
