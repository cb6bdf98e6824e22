#pragma once

#include <filesystem>
#include <string>

#include <burnish/image/image.h>

namespace burnish {

/// Sides of a picture's file, from its head.
struct PictureSize {
  int width = 0, height = 0;
};

/// Throws Error if the file is no EXR or PNG or its head is damaged.
PictureSize picture_size(const std::filesystem::path& path);

/// What a PNG's own chunks (gAMA, sRGB) say of its numbers; nothing where they say nothing.
enum class StatedTransfer { none, linear, srgb, other };
StatedTransfer stated_transfer(const std::filesystem::path& path);

/// Rows [first, first + count) of an EXR or PNG as three linear channels: of an EXR its R, G, B or, where there are
/// none, Y; a PNG's 8 bits are sRGB or linear as `srgb` says, its 16 bits likewise, of [0, 1], whatever its chunks say.
/// A PNG is decoded whole each time. Throws Error if the file is damaged or rows are not within it.
Image read_picture_rows(const std::filesystem::path& path, int first, int count, bool srgb);

/// An EXR without compression, which is read fastest by rows: halves R, G, B. Throws Error for other channels than
/// three. Values are clamped to what halves hold.
std::string encode_half_exr(const Image& image);

}  // namespace burnish
