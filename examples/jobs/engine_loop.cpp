// SPDX-License-Identifier: Apache-2.0
// This is the frame of an engine that shades on the processor. A material is loaded once. Each frame then collects the
// pairs of directions that its lights need, evaluates all of them in one call, and adds them up.
//
//     engine_loop paint.burnish [FRAMES]
//
// Build it against an installed burnish: find_package(burnish), target_link_libraries(app burnish::burnish).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include <burnish/burnish.h>
#include <burnish/file.h>
#include <burnish/math/vec3.h>

namespace {

constexpr int kSide = 96;  // pixels of the picture along a side

struct Light {
  burnish::Vec3 direction;  // unit vector of the world, towards the light
  float strength;
};

// The data of a deferred renderer at a pixel: the normal, and a tangent that the material's grain follows.
struct Pixel {
  burnish::Vec3 normal, tangent;
};

// Returns the pixels of a sphere seen along -z; pixels beside it are missing.
std::vector<Pixel> visible_pixels() {
  std::vector<Pixel> pixels;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      const double x = 2 * (column + 0.5) / kSide - 1, y = 1 - 2 * (row + 0.5) / kSide;
      const double zz = 1 - x * x - y * y;
      if (zz <= 0) continue;
      const double z = std::sqrt(zz), length = std::sqrt(z * z + x * x);
      pixels.push_back({{x, y, z}, {z / length, 0, -x / length}});
    }
  return pixels;
}

// The rows that one frame evaluates. They are kept from frame to frame, so that nothing is allocated again.
struct Batch {
  std::vector<float> wi, wo, f;
  std::vector<std::size_t> pixel;  // the pair's pixel
  std::vector<float> weight;       // cosine times the light's strength

  void clear() {
    wi.clear();
    wo.clear();
    pixel.clear();
    weight.clear();
  }

  void add(const Pixel& at, std::size_t index, const Light& light) {
    const double cosine = dot(at.normal, light.direction);
    if (cosine <= 0) return;
    // Directions go into the local frame of the pixel: tangent, bitangent, normal.
    const burnish::Vec3 bitangent = cross(at.normal, at.tangent), view{0, 0, 1};
    for (const auto& axis : {at.tangent, bitangent, at.normal}) {
      wi.push_back(static_cast<float>(dot(axis, light.direction)));
      wo.push_back(static_cast<float>(dot(axis, view)));
    }
    pixel.push_back(index);
    weight.push_back(static_cast<float>(cosine) * light.strength);
  }
};

// Adds a frame's light to the picture, one row of channels a pixel. Returns how many pairs it took.
std::size_t shade(const burnish::FactoredEvaluator& material, const std::vector<Pixel>& pixels,
                  const std::vector<Light>& lights, Batch& batch, std::vector<float>& picture) {
  const std::size_t channels = material.channels();
  batch.clear();
  for (const Light& light : lights)
    for (std::size_t i = 0; i < pixels.size(); ++i) batch.add(pixels[i], i, light);
  batch.f.resize(channels * batch.pixel.size());
  material.eval(burnish::DirectionRows{batch.wi, batch.wo}, batch.f);
  picture.assign(channels * pixels.size(), 0);
  for (std::size_t pair = 0; pair < batch.pixel.size(); ++pair)
    for (std::size_t c = 0; c < channels; ++c)
      picture[channels * batch.pixel[pair] + c] += batch.weight[pair] * batch.f[channels * pair + c];
  return batch.pixel.size();
}

// Returns the largest relative difference of a frame's values from the model's definition in double precision.
double largest_error(const burnish::FactoredBrdf& definition, const Batch& batch) {
  double largest = 0;
  std::vector<double> exact(definition.channels());
  const auto at = [](const std::vector<float>& rows, std::size_t i) {
    return burnish::Vec3{rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]};
  };
  for (std::size_t i = 0; i < batch.pixel.size(); ++i) {
    definition.eval(at(batch.wi, i), at(batch.wo, i), exact);
    for (std::size_t c = 0; c < exact.size(); ++c)
      if (exact[c] > 0) largest = std::max(largest, std::abs(batch.f[exact.size() * i + c] / exact[c] - 1));
  }
  return largest;
}

void run(const char* file, int frames) {
  const burnish::Model model = burnish::parse_model(burnish::read_file(file));
  const burnish::FactoredEvaluator material(model.brdf);  // made once a material; threads may share it
  const std::vector<Pixel> pixels = visible_pixels();
  std::vector<float> picture;
  Batch batch;
  for (int frame = 0; frame < frames; ++frame) {
    const double turn = 0.2 * frame;
    const std::vector<Light> lights{
        {{std::sin(turn), 0, std::cos(turn)}, 3}, {{0, 0.8, 0.6}, 1}, {{-0.6, 0, 0.8}, 1}};
    const std::size_t pairs = shade(material, pixels, lights, batch, picture);
    double sum = 0;
    for (const float value : picture) sum += value;
    std::printf("frame %d: %zu pairs, mean %.4f\n", frame, pairs, sum / static_cast<double>(picture.size()));
  }
  const double error = largest_error(model.brdf, batch), bound = material.rounding_bound();
  std::printf("largest error %.1e, bound %.1e\n", error, bound);
  if (error > bound) std::exit(1);
}

}  // namespace

int main(int count, char** words) try {
  run(count > 1 ? words[1] : "paint.burnish", count > 2 ? std::atoi(words[2]) : 3);
} catch (const std::exception& error) {
  std::fprintf(stderr, "engine_loop: %s\n", error.what());
  return 1;
}
