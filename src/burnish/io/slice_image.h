// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/reflectance/half_diff_table.h>

namespace burnish {

/// Returns an OpenEXR image that any viewer shows: the table's slices of constant phi_d side by side, row by
/// row from the top, phi_d growing. Within a slice, theta_d grows to the right and theta_h downwards; each
/// entry is a pixel. Channels are floats R, G, B (grey: Y) in 1/sr; A is 0 at holes, 1 elsewhere. Attributes
/// state the sizes. Throws Error unless the table has 1 or 3 channels.
std::string format_slice_image(const HalfDiffTable& table);

}  // namespace burnish
