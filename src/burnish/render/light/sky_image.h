// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <burnish/file.h>
#include <burnish/image/image.h>
#include <burnish/math/point2.h>
#include <burnish/math/rgb.h>
#include <burnish/reflectance/sampling.h>

namespace burnish {

/// Light from all around as a picture: rows from the zenith (+y) to the nadir, columns by the azimuth
/// atan2(z, x) from -pi, so that +x is in the middle, as three.js has it. Linear radiance, three channels.
class SkyImage {
 public:
  /// Throws Error unless the image has three channels of finite values >= 0 and is twice as wide as high.
  explicit SkyImage(Image image);

  const Image& image() const noexcept { return image_; }
  /// Bilinear.
  Rgb radiance(Vec3 w) const noexcept;
  /// Towards the middle of texel (x, y).
  Vec3 direction(double x, double y) const noexcept;
  /// Solid angle of a texel of row y, sr.
  double solid_angle(int y) const noexcept;

  /// In proportion to the light around a texel, evenly within it; in the picture's frame.
  DrawnDirection draw(Point2 u) const noexcept;
  double pdf(Vec3 w) const noexcept;

 private:
  /// In texels, from the picture's corner.
  struct PicturePlace {
    double x, y;
  };
  PicturePlace place_of(Vec3 w) const noexcept;

  Image image_;
  std::vector<double> until_;  ///< cumulated share of the light, a texel
};

/// Halves the picture, texels weighed by their solid angles, until it is at most `width` wide.
Image smaller_sky(Image image, int width);

/// An OpenEXR file with channels R, G and B. Negative values count as 0. Throws Error if it is none, is not
/// twice as wide as high or wider than 8192 or too short for its size, or has values that are not finite.
SkyImage parse_sky(const FileBytes& file);

}  // namespace burnish
