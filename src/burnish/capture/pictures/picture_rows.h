// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <burnish/image/image.h>

namespace burnish {

/// Width and height of a picture, from the head of its file.
struct PictureSize {
  int width = 0, height = 0;
};

/// Throws Error if the file is no EXR or PNG or its head is damaged.
PictureSize picture_size(const std::filesystem::path& path);

/// The encoding that a PNG's own chunks (gAMA, sRGB) state; none if they state nothing.
enum class StatedTransfer { none, linear, srgb, other };
StatedTransfer stated_transfer(const std::filesystem::path& path);

/// Rows [first, first + count) of an EXR or PNG as three linear channels. An EXR gives R, G, B or, if it lacks these,
/// Y. A PNG's values of 8 or 16 bits lie in [0, 1] and are sRGB or linear as `srgb` says, whatever its chunks say. A
/// PNG is decoded whole each time. Throws Error if the file is damaged or the rows are not within it.
Image read_picture_rows(const std::filesystem::path& path, int first, int count, bool srgb);

/// Encodes an EXR without compression, which is fastest to read by rows: halves R, G, B. Throws Error if there are
/// other than three channels. Values are clamped to the range of halves.
std::string encode_half_exr(const Image& image);

}  // namespace burnish
