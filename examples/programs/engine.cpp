// SPDX-License-Identifier: Apache-2.0
// Uses a model as a renderer does, with burnish::eval alone: engine MODEL.burnish. Reads the file and lights a sphere
// with it, a row of pixels at a time. Writes the picture to engine.ppm in the current folder. Prints the time from the
// program's start to the first value, and the time of a million values.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include <burnish/error.h>
#include <burnish/eval/factored_eval.h>
#include <burnish/factors/compact_file.h>
#include <burnish/file.h>

namespace {

using Clock = std::chrono::steady_clock;

// The clock starts before main; the rest of a program's start belongs to the system.
const Clock::time_point kStart = Clock::now();

constexpr int kSide = 256;                         // pixels
constexpr float kLight[3] = {0.48f, 0.64f, 0.6f};  // a unit vector to the light
constexpr float kIntensity = 3.0f;

struct Vector {
  float x, y, z;
};

float dot(Vector a, Vector b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

Vector unit(Vector a) {
  const float scale = 1 / std::sqrt(dot(a, a));
  return {a.x * scale, a.y * scale, a.z * scale};
}

Vector cross(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A row of the sphere's pixels as the model expects them: both directions in the frame of the surface, and their
// columns.
struct Row {
  std::vector<int> columns;
  std::vector<float> wi, wo, cosines;
};

void add(std::vector<float>& rows, Vector v) {
  rows.insert(rows.end(), {v.x, v.y, v.z});
}

Row row_of_sphere(int y) {
  Row row;
  const Vector light{kLight[0], kLight[1], kLight[2]}, viewer{0, 0, 1};
  for (int x = 0; x < kSide; ++x) {
    const float px = (2 * x + 1.0f) / kSide - 1, py = 1 - (2 * y + 1.0f) / kSide;
    const float square = 1 - px * px - py * py;
    if (square <= 0) continue;
    const Vector normal = unit({px, py, std::sqrt(square)});
    const Vector tangent = unit(cross({0, 1, 0}, normal));
    const Vector bitangent = cross(normal, tangent);
    const auto local = [&](Vector v) { return unit({dot(v, tangent), dot(v, bitangent), dot(v, normal)}); };
    const Vector wi = local(light);
    if (wi.z <= 0) continue;
    row.columns.push_back(x);
    add(row.wi, wi);
    add(row.wo, local(viewer));
    row.cosines.push_back(wi.z);
  }
  return row;
}

std::uint8_t encoded(float linear) {
  const float clamped = std::fmin(std::fmax(linear, 0.0f), 1.0f);
  const float srgb = clamped <= 0.0031308f ? 12.92f * clamped : 1.055f * std::pow(clamped, 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255 * srgb));
}

// Returns three bytes a pixel; a model of one channel is grey.
std::string picture(const burnish::FactoredEvaluator& evaluator) {
  const std::size_t channels = evaluator.channels();
  std::string bytes(std::size_t{3} * kSide * kSide, '\0');
  std::vector<float> values;
  for (int y = 0; y < kSide; ++y) {
    const Row row = row_of_sphere(y);
    values.resize(channels * row.columns.size());
    evaluator.eval(burnish::DirectionRows{row.wi, row.wo}, values);
    for (std::size_t i = 0; i < row.columns.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        const float radiance = values[channels * i + (channels == 3 ? c : 0)] * row.cosines[i] * kIntensity;
        const std::size_t pixel =
            static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(row.columns[i]);
        bytes[3 * pixel + c] = static_cast<char>(encoded(radiance));
      }
  }
  return bytes;
}

void write_picture(const std::string& bytes) {
  std::ofstream file("engine.ppm", std::ios::binary);
  file << "P6\n" << kSide << ' ' << kSide << "\n255\n" << bytes;
  if (!file.flush()) throw burnish::Error("engine.ppm: expected to write it, found no room or no permission");
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Returns the seconds of a million values, in blocks that fit the cache.
double seconds_of_a_million(const burnish::FactoredEvaluator& evaluator) {
  const Row row = row_of_sphere(kSide / 2);
  std::vector<float> values(evaluator.channels() * row.columns.size());
  const auto start = Clock::now();
  for (std::size_t done = 0; done < 1'000'000; done += row.columns.size())
    evaluator.eval(burnish::DirectionRows{row.wi, row.wo}, values);
  return seconds_since(start);
}

void run(const char* path) {
  const burnish::Model model = burnish::parse_compact(burnish::read_file(path));
  const burnish::FactoredEvaluator evaluator(model.brdf);
  if (evaluator.channels() != 1 && evaluator.channels() != 3)
    throw burnish::Error(std::string(path) + ": expected 1 or 3 channels, found " +
                         std::to_string(evaluator.channels()));
  std::vector<float> first(evaluator.channels());
  evaluator.eval(burnish::Vec3{0, 0, 1}, burnish::Vec3{0, 0, 1}, first);
  const double until_first = seconds_since(kStart);

  write_picture(picture(evaluator));
  std::printf("first value %g after %.2f ms; a million take %.1f ms; engine.ppm is written\n",
              static_cast<double>(first[0]), 1e3 * until_first, 1e3 * seconds_of_a_million(evaluator));
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: engine MODEL.burnish\n");
    return 2;
  }
  try {
    run(arguments[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
