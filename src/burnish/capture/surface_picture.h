// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/capture/pictures/capture.h>
#include <burnish/image/image.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// Returns a sheet of panels: a picture of a capture, by its number in the form; the surface under the same light and
/// view; and each lobe's weights, white at their largest. The first two are multiplied by `exposure` and shown as
/// sRGB. Throws Error if there is no such picture, if it is damaged, or if the surface has another size or other than
/// three channels.
Image8 surface_picture(const Capture& capture, const SpatialBrdf& surface, std::size_t picture,
                       double exposure);

}  // namespace burnish
