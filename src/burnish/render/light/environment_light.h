// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/image/image.h>
#include <burnish/math/random.h>
#include <burnish/math/rgb.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/reflectance/sampling.h>
#include <burnish/render/light/sky_image.h>

namespace burnish {

/// A far disc of even radiance.
struct DistantDisc {
  Vec3 direction;   ///< of its middle, unit
  double radius;    ///< radians
  double radiance;  ///< added to what is behind, white
};

/// Light from all around: a sky from horizon to zenith over a dark ground, y up, or a picture, and discs.
struct Environment {
  std::string name;
  Rgb zenith, horizon, ground;
  std::vector<DistantDisc> discs;
  std::shared_ptr<const SkyImage> picture{};  ///< where there is one, in place of the colours

  Rgb radiance(Vec3 w) const noexcept;
};

/// Points that stand for the discs, 64 each, even over its solid angle.
struct DiscPoint {
  Vec3 direction;
  Rgb light;  ///< radiance times solid angle
};
std::vector<DiscPoint> disc_points(const Environment& environment);

/// The environment of that name ("sun", "studio"); nothing for others.
std::optional<Environment> find_environment(std::string_view name);

/// The environment of that name, or else the picture in that file, which gives it its name. Throws Error as
/// read_file and parse_sky do.
Environment open_environment(const std::string& name_or_file);

/// "sun": a clear sky with a sun of radius 1 degree that gives the most of the light; "studio": three lamps
/// of 6 to 20 degrees in a dim room.
std::span<const Environment> environments();

/// The discs turned about the vertical by `angle` (radians), from the viewer to the right.
Environment turned(Environment environment, double angle);

/// A frame of the world's: unit vectors at right angles.
struct LightFrame {
  Vec3 n, t, s;

  Vec3 local(Vec3 w) const noexcept { return {dot(t, w), dot(s, w), dot(n, w)}; }
  Vec3 world(Vec3 w) const noexcept { return w.x * t + w.y * s + w.z * n; }
};

/// The frame of metrics/sphere_images.h at normal n.
LightFrame sphere_frame(Vec3 n) noexcept;

/// Radiance towards v, unit, that a surface of one or three channels reflects, without shadows: stratified
/// draws of `guide`, `side`^2 of them, and as many of every disc and of the picture, by the balance heuristic
/// [Veach 1995].
Rgb radiance_in_environment(BrdfRef brdf, SamplerRef guide, const Environment& environment,
                            const LightFrame& frame, Vec3 v, int side, Pcg32& random);

/// A picture of one Monte Carlo run.
struct LightRender {
  Image mean;      ///< radiance towards the viewer, 0 outside the sphere
  Image variance;  ///< of one sample, estimated from the same samples; 0 outside
};

/// Options of rendering.
struct LightOptions {
  int size = 64;     ///< pixels, in [4, 4096]
  int samples = 64;  ///< a pixel, in [2, 2^24]
  std::uint64_t seed = 1;
  bool stratified = false;  ///< the points u jittered in a square grid; samples must be a square
};

/// The sphere of metrics/sphere_images.h under an environment, direct light by `samples` directions a pixel:
/// the mean of f_r cos(theta_i) radiance / pdf. At the middle of every pixel; one or three channels of the
/// BRDF. Random numbers depend on pixel and seed alone. Throws Error for options out of range or other
/// channels.
LightRender render_in_environment(BrdfRef brdf, SamplerRef sampler, const Environment& environment,
                                  const LightOptions& options);

/// A picture and how much samples of it scatter.
struct LightMoments {
  Image mean;                   ///< radiance towards the viewer, 0 outside the sphere
  std::vector<Image> variance;  ///< of one sample drawn by each sampler, per pixel and channel
};

/// The picture that render_in_environment approaches, nearly without noise, and the variance of one sample
/// that each of `samplers` has, integral of (f_r cos(theta_i) radiance)^2 / pdf less the mean's square,
/// without drawing from them: what a small sun contributes to the variance takes millions of samples to be
/// seen. Integrated by options.samples stratified draws of `guide`, a square number, and as many of every
/// disc and of the picture, combined by the balance heuristic [Veach 1995]. Directions that a sampler never
/// draws are left out of its variance. Throws as render_in_environment.
LightMoments moments_in_environment(BrdfRef brdf, SamplerRef guide, std::span<const SamplerRef> samplers,
                                    const Environment& environment, const LightOptions& options);

}  // namespace burnish
