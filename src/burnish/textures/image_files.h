// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/factors/table.h>
#include <burnish/image/image.h>

namespace burnish {

/// One table as an OpenEXR image, pixel (x, y) node (x, y): channels R, G, B or Y, halves where the table's
/// format is half or rgb9e5, else floats, so that values are the table's to the last bit. Throws Error for
/// channels other than 1 or 3.
std::string encode_exr(const Table& table);
/// The same of a picture of values that are rounded to `format` already.
std::string encode_exr(const Image& picture, TableFormat format);

/// One table as a PNG image of linear bytes: 255 is the table's largest value, 1; a value is off by 1/510 at
/// most, and 0 below that. Grey tables have three equal channels. Throws as encode_exr.
std::string encode_png_table(const Table& table);

}  // namespace burnish
