// A path tracer that draws its directions from a burnish material: a sphere on a floor, both of the material, under an
// even sky and a sun. One thread follows the paths of a pixel; tables and formulas are in the code:
//
//   burnish export paint.burnish --to cpp --sample -o .         # writes paint.h and paint.sample.h
//   nvcc -O3 path_tracer.cu -o path_tracer && ./path_tracer 64  # 64 paths a pixel
//
// Without CUDA the same file is a loop on the processor: g++ -std=c++17 -O2 -x c++ path_tracer.cu.
// Writes path_tracer.ppm. Prints the picture's mean, and the share of an even sky that the material reflects.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "paint.h"
#include "paint.sample.h"

using namespace burnish_shader;

#ifdef __CUDACC__
#define KERNEL __global__ void
#define DEVICE __device__ inline
#else
#define KERNEL void
#define DEVICE inline
#endif

constexpr int kSide = 96, kBounces = 4;  // pixels along a side; reflections of a path
constexpr float kPi = 3.14159265f, kSunCosine = 0.995f, kSunRadiance = 40.0f;

struct Random {  // PCG hash [Jarzynski 2020]
  unsigned state;
  DEVICE float next() {
    state = state * 747796405u + 2891336453u;
    const unsigned word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (((word >> 22u) ^ word) >> 8) * (1.0f / 16777216.0f);
  }
};

DEVICE vec3 normalized(vec3 v) { return (1.0f / sqrtf(dot(v, v))) * v; }
DEVICE vec3 sun() { return normalized(vec3(0.5f, 0.7f, 0.5f)); }
DEVICE float sky(vec3 d) { return dot(d, sun()) > kSunCosine ? kSunRadiance : 0.5f; }
DEVICE vec3 tangent(vec3 n) {
  return normalized(fabsf(n.x) < 0.9f ? cross(vec3(1.0f, 0.0f, 0.0f), n) : cross(vec3(0.0f, 1.0f, 0.0f), n));
}

// Finds the first surface of a ray: the sphere of radius 1 about the origin, or the floor y = -1 within 4 of it.
DEVICE bool hit(vec3 from, vec3 d, vec3& at, vec3& n) {
  const float b = dot(from, d), h = b * b - dot(from, from) + 1.0f;
  const float near = h > 0.0f ? -b - sqrtf(h) : -1.0f;
  if (near > 1e-4f) {
    at = from + near * d;
    n = normalized(at);
    return true;
  }
  const float down = d.y < 0.0f ? -(from.y + 1.0f) / d.y : -1.0f;
  at = from + down * d;
  n = vec3(0.0f, 1.0f, 0.0f);
  return down > 1e-4f && at.x * at.x + at.z * at.z < 16.0f;
}

// Returns the light along one path. The sun is drawn beside the material, and both are weighed by the balance heuristic
// [Veach 1995]: light that two densities can find counts by the share of its own density.
DEVICE vec3 light_along(vec3 from, vec3 d, Random& random) {
  vec3 sum(0.0f, 0.0f, 0.0f), weight(1.0f, 1.0f, 1.0f), at = from, n = d;
  const float sun_pdf = 1.0f / (2.0f * kPi * (1.0f - kSunCosine));
  float pdf = -1.0f;  // the density of d; below 0 for the camera's ray
  for (int bounce = 0; hit(from, d, at, n); ++bounce) {
    if (bounce == kBounces) return sum;
    const vec3 t = tangent(n), v = -1.0f * d, s = sun(), along = tangent(s);
    from = at + 1e-3f * n;

    // A direction to the sun: even within its cone.
    const float z = 1.0f - random.next() * (1.0f - kSunCosine), phi = 2.0f * kPi * random.next();
    const float r = sqrtf(1.0f - z * z);
    const vec3 l = z * s + r * cosf(phi) * along + r * sinf(phi) * cross(s, along);
    vec3 there = l, other = l;
    if (dot(l, n) > 0.0f && !hit(from, l, there, other)) {
      const float mine = burnish_paint_pdf_world(n, t, l, v);
      sum = sum + (kSunRadiance * dot(l, n) / (sun_pdf + mine)) * (weight * burnish_paint_world(n, t, l, v));
    }

    // A direction by the material. Its weight is f cos(theta_i) / pdf.
    const vec4 drawn = burnish_paint_sample_world(n, t, v, vec2(random.next(), random.next()));
    if (drawn.w <= 0.0f) return sum;
    d = vec3(drawn.x, drawn.y, drawn.z);
    pdf = drawn.w;
    weight = (dot(d, n) / pdf) * (weight * burnish_paint_world(n, t, d, v));
  }
  const float seen = sky(d);
  const bool both = pdf >= 0.0f && dot(d, sun()) > kSunCosine;
  return sum + (both ? seen * pdf / (pdf + sun_pdf) : seen) * weight;
}

// Computes pixel i of the picture. If i is the number of pixels, it computes the light of an even sky of radiance 1
// that the material reflects along the normal.
DEVICE vec3 pixel(int i, int paths) {
  Random random{9781u * static_cast<unsigned>(i) + 1u};
  vec3 sum(0.0f, 0.0f, 0.0f);
  for (int k = 0; k < paths; ++k) {
    const float x = random.next(), y = random.next();
    if (i < kSide * kSide) {
      const vec3 d(2.0f * (i % kSide + x) / kSide - 1.0f, 1.0f - 2.0f * (i / kSide + y) / kSide, -2.4f);
      sum = sum + light_along(vec3(0.0f, 0.3f, 5.0f), normalized(d), random);
    } else {
      const vec3 wo(0.0f, 0.0f, 1.0f);
      const vec4 drawn = burnish_paint_sample(wo, vec2(x, y));
      if (drawn.w > 0.0f) sum = sum + (drawn.z / drawn.w) * burnish_paint(vec3(drawn.x, drawn.y, drawn.z), wo);
    }
  }
  return (1.0f / paths) * sum;
}

#ifdef __CUDACC__
KERNEL draw(float* rgb, int paths) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i > kSide * kSide) return;
#else
KERNEL draw(float* rgb, int paths, int i) {
#endif
  const vec3 value = pixel(i, i < kSide * kSide ? paths : 65536);
  rgb[3 * i] = value.x;
  rgb[3 * i + 1] = value.y;
  rgb[3 * i + 2] = value.z;
}

int main(int count, char** words) {
  const int paths = count > 1 ? std::atoi(words[1]) : 16, pixels = kSide * kSide;
  std::vector<float> rgb(3 * static_cast<std::size_t>(pixels + 1));  // the last is that of the sky
#ifdef __CUDACC__
  float* there = nullptr;
  cudaMalloc(&there, rgb.size() * sizeof(float));
  draw<<<pixels / 64 + 1, 64>>>(there, paths);
  if (cudaMemcpy(rgb.data(), there, rgb.size() * sizeof(float), cudaMemcpyDeviceToHost) != cudaSuccess) return 1;
#else
  for (int i = 0; i <= pixels; ++i) draw(rgb.data(), paths, i);
#endif
  std::FILE* const file = std::fopen("path_tracer.ppm", "wb");
  std::fprintf(file, "P6 %d %d 255\n", kSide, kSide);
  double sum = 0;
  for (int k = 0; k < 3 * pixels; ++k) {
    sum += rgb[k];
    std::fputc(static_cast<int>(255.0f * powf(rgb[k] < 1.0f ? rgb[k] : 1.0f, 1.0f / 2.2f)), file);
  }
  std::fclose(file);
  const float* const even = &rgb[3 * static_cast<std::size_t>(pixels)];
  std::printf("mean %.4f\nsky: %.5f %.5f %.5f\n", sum / (3 * pixels), even[0], even[1], even[2]);
}
