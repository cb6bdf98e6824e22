// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <burnish/image/image.h>

namespace burnish {

/// The meaning of a picture's bytes. A file of colours, encoded by sRGB's function, says so in a chunk. A file of linear
/// numbers says nothing, so that readers leave them as they are.
enum class PngValues { srgb, linear };

/// The PNG file of an image of 3 (RGB) or 4 (RGBA) channels; the same image gives the same bytes. Throws
/// Error for other channel counts and empty images.
std::string encode_png(const Image8& image, PngValues values = PngValues::srgb);

/// Any PNG as 8-bit RGB, or RGBA where it is transparent somewhere; `name` is the file its errors name.
/// Throws Error for what is no PNG, is damaged, or has more than 2^28 pixels.
Image8 decode_png(const std::string& bytes, const std::string& name);

/// encode_png into a file, under a temporary name first. Throws Error if it cannot be written.
void write_png(const std::filesystem::path& path, const Image8& image);

/// decode_png of a file.
Image8 read_png(const std::filesystem::path& path);

}  // namespace burnish
