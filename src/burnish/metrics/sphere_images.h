// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <burnish/image/image.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// The picture that errors are judged by: a sphere seen orthographically along +z whose radius is half the
/// frame, with x to the right and y up, under a white directional light in the x-z plane. The tangent is
/// normalize(y x n), so that brushed materials run around the vertical axis.

/// Angles between the lights of the scored images and the view, radians.
inline constexpr std::array<double, 3> kSphereLights = {radians(0), radians(30), radians(60)};

/// Side of the scored images in pixels.
inline constexpr int kSphereSize = 256;

/// Normal of the sphere at image place (x, y) of a frame `size` pixels wide; nothing outside the sphere. The
/// centre of pixel (i, j) is (i + 0.5, j + 0.5).
std::optional<Vec3> sphere_normal(int size, double x, double y) noexcept;

/// Direction w of the picture's frame in the local frame at normal n; n is not +y or -y.
Vec3 sphere_local(Vec3 n, Vec3 w) noexcept;

/// One rendered sphere: f_r max(cos theta_i, 0) in each pixel, linear, 1/sr, 0 outside the sphere.
struct LitSphere {
  Image image;
  std::vector<std::uint8_t> known;  ///< one flag a pixel, false where the source knows nothing; true outside
};

/// Renders with the light at `light_angle` (radians) from the view. `size` in [16, 8192], else throws Error.
LitSphere render_sphere(BrdfRef brdf, double light_angle, int size = kSphereSize);

/// The sphere under a uniform dome of radiance 1: the directional-hemispherical reflectance towards the
/// viewer, interpolated between 48 polar angles (and 48 azimuths where anisotropic), each integrated with a
/// midpoint rule of 64 x 64 half vectors that crowd at the normal. Relative error of a smooth BRDF's albedo:
/// 0.5 %. Shown, never scored. Throws as render_sphere.
Image render_dome(BrdfRef brdf, int size = kSphereSize);

/// The value below which a share `fraction` of the values lies, linear between order statistics: place
/// fraction * (n - 1) of the sorted values. Throws Error if there are none.
double percentile(std::vector<float> values, double fraction);

/// 1 / (97th percentile over the images' sphere pixels and channels); over the largest value where that
/// percentile is 0, and 1 where all is black.
double sphere_exposure(std::span<const LitSphere> spheres);

/// min(max(exposure * value, 0), 1)^(1 / 2.2) of every value.
Image tone_map(Image image, double exposure);

/// Mean over the whole frame and the channels of the squared difference; one channel stands for every channel
/// of the other image. Throws Error if sizes or channels do not fit.
double mean_squared_error(const Image& a, const Image& b);

/// Peak signal-to-noise ratio in dB of values in [0, 1]: -10 log10(mse); infinite for 0.
double psnr(double mean_squared_error) noexcept;

/// Structural similarity of two images of values in [0, 1], at least 6 x 6: Gaussian window of sigma 1.5 cut
/// at 4 sigma (13 x 13) and normalized, population moments, K = 0.01 and 0.03, L = 1, averaged over every
/// pixel of the frame and the channels. Beyond the edges an image goes on as its mirror image, the edge pixel
/// twice. Throws as mean_squared_error. Source: [Wang 2004].
double ssim(const Image& a, const Image& b);

/// Options of the picture of a single sphere.
struct LitSphereOptions {
  int size = 512;                       ///< pixels
  double light_angle = radians(30);     ///< from the view, radians
  std::optional<double> exposure = {};  ///< unset: that of the BRDF's own scored images
  int supersampling = 3;                ///< samples a pixel along each axis
};

/// A picture of one BRDF: tone mapped, antialiased, transparent around the sphere. Throws as render_sphere.
Image8 lit_sphere(BrdfRef brdf, const LitSphereOptions& options = {});

/// Tone-mapped values as RGB bytes: three channels as they are; one, or the mean of any other count, as grey.
Image8 to_image8(const Image& shown);

}  // namespace burnish
