// SPDX-License-Identifier: Apache-2.0
#include "environment_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <burnish/fitting/fit.h>
#include <burnish/image/png.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/reflectance/ggx_proxy.h>
#include <burnish/render/light/image_based_light.h>
#include <burnish/render/light/tapped_light.h>

namespace burnish::reports {

namespace {

struct Material {
  const char *name, *source, *model;
  Rgb diffuse;  // adds a second lobe
};
constexpr Material kMaterials[] = {
    {"gold", "ggx:alpha_x=0.15,alpha_y=0.15,f0=0.9/0.7/0.4", "pqp", 0},
    {"plastic", "ggx:alpha_x=0.3,alpha_y=0.3,f0=0.05,kd=0.4/0.1/0.05", "pqpr", 0},
    {"ceramic", "ggx:alpha_x=0.1,alpha_y=0.1,f0=0.05", "pqpr", {0.05, 0.1, 0.3}},
};
// Anisotropic materials, which are lit by taps.
constexpr Material kBrushed[] = {
    {"brushed gold", "ggx:alpha_x=0.1,alpha_y=0.3,f0=0.9/0.7/0.4", "pqp", 0},
    {"silk", "ggx:alpha_x=0.15,alpha_y=0.4,f0=0.3", "pqp", {0.02, 0.05, 0.2}},
    {"satin", "ggx:alpha_x=0.15,alpha_y=0.4,f0=0.05,kd=0.4/0.1/0.05", "pqp", 0},
};
constexpr int kTaps[] = {24, 48, 96, 192};

FactoredBrdf factored(const Material& material) {
  const FactoredBrdf one = fit(open_source(material.source, {}),
                               {.form = OneLobe{.model = material.model}, .samples = 100'000, .score = false})
                               .model();
  std::vector<Lobe> lobes(one.lobes().begin(), one.lobes().end());
  const auto [r, g, b] = material.diffuse;
  if (g > 0) lobes.push_back({.scale = {r / kPi, g / kPi, b / kPi}, .factors = {}});
  return {3, {one.tables().begin(), one.tables().end()}, std::move(lobes)};
}

struct Tabulation {
  const char* name;
  PrefilterOptions options;
};
const Tabulation kTabulations[] = {{"round kernels", {.side = 32, .harmonics = 0}},
                                   {"two orders", {.side = 32, .harmonics = 2}},
                                   {"four orders", {}},
                                   {"four orders, 64 texels", {.side = 64}}};

constexpr int kSize = 64;  // pixels along a picture's side

int samples_of(const Page& page) {  // samples in each pixel
  return page.options().quick ? 16 : 4096;
}

// Draws the sphere of metrics/sphere_images.h with `radiance(normal, view)` in each pixel.
Image sphere(const std::function<Rgb(Vec3 n, Vec3 v)>& radiance) {
  Image image(kSize, kSize, 3);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      if (const auto n = sphere_normal(kSize, x + 0.5, y + 0.5)) {
        const Rgb value = radiance(*n, {0, 0, 1});
        const auto pixel = image.at(x, y);
        pixel[0] = static_cast<float>(value.r);
        pixel[1] = static_cast<float>(value.g);
        pixel[2] = static_cast<float>(value.b);
      }
  return image;
}

Image by_taps(const TappedBrdf& tapped, const BlurredEnvironment& blurred) {
  return sphere([&](Vec3 n, Vec3 v) { return tapped.radiance(blurred, sphere_frame(n), v); });
}

Image on_gpu(const ImageBasedLight& light) {
  std::vector<GlVectors> calls;
  sphere([&](Vec3 n, Vec3 v) {
    const auto single = [](double x) { return static_cast<float>(x); };
    calls.push_back({{single(n.x), single(n.y), single(n.z)}, {single(v.x), single(v.y), single(v.z)}});
    return Rgb{};
  });
  const std::vector<float> values = GlImageBasedLight(light).radiance(calls);
  std::size_t i = 0;
  return sphere([&](Vec3, Vec3) {
    i += 3;
    return Rgb{values[i - 3], values[i - 2], values[i - 1]};
  });
}

double exposure_of(const Image& image) {
  const LitSphere lit{image, {}};
  return sphere_exposure({&lit, 1});
}

void paste(Image8& sheet, const Image& shown, int column, int row) {
  const Image8 part = to_image8(shown);
  for (int y = 0; y < kSize; ++y)
    std::ranges::copy_n(part.at(0, y).begin(), 3 * kSize, sheet.at(column * kSize, row * kSize + y).begin());
}

// The Monte Carlo picture of one material in one environment.
struct Truth {
  double exposure;
  Image shown;
  double own_decibels;  // psnr of a second picture with other random numbers and a quarter of the draws

  double decibels(const Image& image) const {
    return psnr(mean_squared_error(tone_map(image, exposure), shown));
  }
};

Truth truth_of(const FactoredBrdf& brdf, const Environment& environment, int samples) {
  const GgxProxy guide = fit_ggx_proxy(brdf, true);
  const Image image =
      moments_in_environment(brdf, guide, {}, environment, {.size = kSize, .samples = samples, .seed = 1})
          .mean;
  const double exposure = exposure_of(image);
  Truth truth{.exposure = exposure, .shown = tone_map(image, exposure), .own_decibels = 0};
  truth.own_decibels = truth.decibels(
      moments_in_environment(brdf, guide, {}, environment, {.size = kSize, .samples = samples / 4, .seed = 2})
          .mean);
  return truth;
}

// Returns the first cells of a row.
std::vector<std::string> row_head(const Material& material, const FactoredBrdf& brdf,
                                  const Environment& environment, const Truth& truth) {
  return {material.name, std::to_string(brdf.lobes().size()), environment.name,
          fmt::format("{:.1f}", truth.own_decibels)};
}
const std::vector<std::string> kHead{"material", "lobes", "environment", "truth"};

// Returns a picture of the environment, without its formulas.
Environment pictured(const Environment& environment) {
  const SkyImage grid(Image(512, 256, 3));
  Image image = grid.image();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb value = environment.radiance(grid.direction(x, y));
      const auto texel = image.at(x, y);
      texel[0] = static_cast<float>(value.r);
      texel[1] = static_cast<float>(value.g);
      texel[2] = static_cast<float>(value.b);
    }
  return {.name = "picture", .picture = std::make_shared<const SkyImage>(std::move(image))};
}

Table taps_table(std::span<const Environment> all, int samples) {
  Table table(joined(kHead, cells("{} taps", kTaps)));
  for (const Environment& environment : all) {
    const BlurredEnvironment blurred = blur(environment);
    for (const Material& material : kBrushed) {
      const FactoredBrdf brdf = factored(material);
      const Truth truth = truth_of(brdf, environment, samples);
      std::vector<double> decibels;
      for (const int taps : kTaps) decibels.push_back(truth.decibels(by_taps(tap(brdf, taps), blurred)));
      table.add(joined(row_head(material, brdf, environment, truth), cells("{:.1f}", decibels)));
    }
  }
  return table;
}

// Pastes the truth, the picture found, and ten times their difference.
void paste_row(Image8& sheet, const Truth& truth, const Image& found, int column, int row) {
  paste(sheet, truth.shown, column, row);
  Image difference = tone_map(found, truth.exposure);
  paste(sheet, difference, column + 1, row);
  for (std::size_t i = 0; i < difference.pixels.size(); ++i)
    difference.pixels[i] = std::min(1.0f, 10 * std::abs(difference.pixels[i] - truth.shown.pixels[i]));
  paste(sheet, difference, column + 2, row);
}

// Reports isotropic materials: every tabulation in every environment, and the cost of each.
void report_prefiltered(Page& page, std::span<const Environment> all) {
  std::vector<std::string> names;
  for (const Tabulation& t : kTabulations) names.emplace_back(t.name);
  Table table(joined(kHead, names)),
      costs({"material", "kernels", "lobes", "filtered reads a pixel", "KiB of maps"});
  Image8 sheet(kSize * 3 * static_cast<int>(all.size()), kSize * static_cast<int>(std::size(kMaterials)), 3);
  for (int row = 0; const Material& material : kMaterials) {
    tell(fmt::format("shaders: {}", material.name));
    const FactoredBrdf brdf = factored(material);
    for (int column = 0; const Environment& environment : all) {
      const Truth truth = truth_of(brdf, environment, samples_of(page));
      std::vector<std::string> line = row_head(material, brdf, environment, truth);
      for (const Tabulation& t : kTabulations) {
        const ImageBasedLight light = prefilter(brdf, environment, t.options);
        const Image found = on_gpu(light);
        line.push_back(
            fmt::format("{:.1f} ({:.1f})", truth.decibels(found),
                        truth.decibels(sphere([&](Vec3 n, Vec3 v) { return light.radiance(n, v); }))));
        if (column == 0)
          costs.add(joined({material.name, t.name},
                           cells("{}", std::array<std::size_t, 3>{light.lobes.size(),
                                                                  static_cast<std::size_t>(light.fetches()),
                                                                  light.bytes() / 1024})));
        if (&t == &kTabulations[2]) paste_row(sheet, truth, found, 3 * column, row);
      }
      table.add(line);
      ++column;
    }
    ++row;
  }
  page["environment"] = table.markdown();
  page["environment_costs"] = costs.markdown();
  page.write_figure("environment-light.png", encode_png(sheet));
}

}  // namespace

void report_environment_light(Page& page) {
  const std::span<const Environment> all = environments();
  page["picture_size"] = std::to_string(kSize);
  page["draws"] = std::to_string(samples_of(page));
  report_prefiltered(page, all);
  page["taps"] = taps_table(std::array{all[0], all[1], pictured(all[1])}, samples_of(page)).markdown();
}

}  // namespace burnish::reports
