#pragma once

#include <burnish/capture/pictures/capture.h>
#include <burnish/image/image.h>
#include <burnish/surface/spatial_brdf.h>

namespace burnish {

/// A picture of a capture, by its number in the form, beside the surface under the same light from the same side, both
/// times `exposure` and as sRGB, and then each lobe's weights, white where they are largest. Throws Error if there is
/// no such picture, it is damaged, or the surface has another size or other than three channels.
Image8 surface_picture(const Capture& capture, const SpatialBrdf& surface, std::size_t picture,
                       double exposure);

}  // namespace burnish
