#include "environment.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
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

namespace burnish {
namespace {

struct Material {
  const char *name, *source, *model;
  Rgb diffuse;  // a second lobe
};
constexpr Material kMaterials[] = {
    {"gold", "ggx:alpha_x=0.15,alpha_y=0.15,f0=0.9/0.7/0.4", "pqp", 0},
    {"plastic", "ggx:alpha_x=0.3,alpha_y=0.3,f0=0.05,kd=0.4/0.1/0.05", "pqpr", 0},
    {"ceramic", "ggx:alpha_x=0.1,alpha_y=0.1,f0=0.05", "pqpr", {0.05, 0.1, 0.3}},
};
// Anisotropic ones: taps.
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

constexpr int kSize = 64;       // of the pictures
constexpr int kSamples = 4096;  // a pixel

// The sphere of metrics/sphere_images.h, each pixel by `radiance` of its normal.
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

// What Monte Carlo draws of one material in one environment.
struct Truth {
  double exposure;
  Image shown;

  double decibels(const Image& image) const {
    return psnr(mean_squared_error(tone_map(image, exposure), shown));
  }
};

// Prints the start of a table's row.
Truth begin_row(const Material& material, const FactoredBrdf& brdf, const Environment& environment) {
  const GgxProxy guide = fit_ggx_proxy(brdf, true);
  const auto monte_carlo = [&](int samples, std::uint64_t seed) {
    return moments_in_environment(brdf, guide, {}, environment,
                                  {.size = kSize, .samples = samples, .seed = seed})
        .mean;
  };
  const Image image = monte_carlo(kSamples, 1);
  const double exposure = exposure_of(image);
  Truth truth{.exposure = exposure, .shown = tone_map(image, exposure)};
  fmt::print("| {} | {} | {} | {:.1f} |", material.name, brdf.lobes().size(), environment.name,
             truth.decibels(monte_carlo(kSamples / 4, 2)));
  return truth;
}

void print_taps(const std::vector<Environment>& all) {
  fmt::print(
      "\n### Anisotropic materials\n\nThe same for taps on one blurred environment for all materials, by the "
      "shader's definition "
      "in doubles; `picture` is the studio as an OpenEXR picture would have it, 512 x 256.\n\n"
      "| material | lobes | environment | truth |");
  for (const int taps : kTaps) fmt::print(" {} taps |", taps);
  fmt::print("\n|---|---|---|---|---|---|---|---|\n");
  for (const Environment& environment : all) {
    const BlurredEnvironment blurred = blur(environment);
    for (const Material& material : kBrushed) {
      const FactoredBrdf brdf = factored(material);
      const Truth truth = begin_row(material, brdf, environment);
      for (const int taps : kTaps) fmt::print(" {:.1f} |", truth.decibels(by_taps(tap(brdf, taps), blurred)));
      fmt::print("\n");
      std::fflush(stdout);
    }
  }
}

// The environment without its formulas: a picture of it.
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

}  // namespace

void print_environment_light(const std::filesystem::path& figures) {
  fmt::print(
      "\n## Environment light\n\nPSNR in dB of a sphere of {0}^2 pixels, exposed and tone mapped as "
      "[results.md](results.md) says, against Monte Carlo: {1} draws of the material and as many of every "
      "lamp a "
      "pixel, stratified; `truth` is the PSNR of such a picture with other random numbers and a quarter of "
      "the draws. Maps of "
      "halves, "
      "read by the generated shader on the OpenGL at hand; in brackets the shader's definition in "
      "doubles.\n\n"
      "| material | lobes | environment | truth |",
      kSize, kSamples);
  for (const Tabulation& t : kTabulations) fmt::print(" {} |", t.name);
  fmt::print("\n|---|---|---|---|---|---|---|---|\n");
  std::string costs;
  const auto all = environments();
  Image8 sheet(kSize * 3 * static_cast<int>(all.size()), kSize * static_cast<int>(std::size(kMaterials)), 3);
  int row = 0;
  for (const Material& material : kMaterials) {
    const FactoredBrdf brdf = factored(material);
    int column = 0;
    for (const Environment& environment : all) {
      const Truth truth = begin_row(material, brdf, environment);
      for (const Tabulation& t : kTabulations) {
        const ImageBasedLight light = prefilter(brdf, environment, t.options);
        const Image found = on_gpu(light);
        fmt::print(" {:.1f} ({:.1f}) |", truth.decibels(found),
                   truth.decibels(sphere([&](Vec3 n, Vec3 v) { return light.radiance(n, v); })));
        if (column == 0)
          costs += fmt::format("| {} | {} | {} | {} | {} |\n", material.name, t.name, light.lobes.size(),
                               light.fetches(), light.bytes() / 1024);
        if (&t != &kTabulations[2]) continue;
        paste(sheet, truth.shown, 3 * column, row);
        Image difference = tone_map(found, truth.exposure);
        paste(sheet, difference, 3 * column + 1, row);
        for (std::size_t i = 0; i < difference.pixels.size(); ++i)
          difference.pixels[i] = std::min(1.0f, 10 * std::abs(difference.pixels[i] - truth.shown.pixels[i]));
        paste(sheet, difference, 3 * column + 2, row);
      }
      fmt::print("\n");
      std::fflush(stdout);
      ++column;
    }
    ++row;
  }
  fmt::print(
      "\n| material | kernels | lobes | filtered reads a pixel | KiB of maps |\n|---|---|---|---|---|\n{}",
      costs);
  write_png(figures / "environment-light.png", sheet);
  print_taps({all[0], all[1], pictured(all[1])});
}

}  // namespace burnish
