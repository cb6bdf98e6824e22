// A CUDA kernel that shades a million pairs of directions with a burnish material, its tables in the code:
//
//   burnish export paint.burnish --to cpp -o .          # writes paint.h
//   nvcc -O3 cuda_kernel.cu -o cuda_kernel && ./cuda_kernel
//
// Without CUDA the same file is a loop on the processor: g++ -std=c++17 -x c++ cuda_kernel.cu.
// Prints the mean and one value, which `burnish eval` gives for the same pair.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "paint.h"

using burnish_shader::vec3;

#ifdef __CUDACC__
#define KERNEL __global__ void
#define DEVICE __device__
#else
#define KERNEL void
#define DEVICE
#endif

// The i-th pair of count: directions on two spirals over the hemisphere, so that every run has the same.
DEVICE inline vec3 direction(int i, int count, float turns) {
  const float z = (i + 0.5f) / count, r = sqrtf(1.0f - z * z), phi = turns * i;
  return vec3(r * cosf(phi), r * sinf(phi), z);
}

// f_r cos(theta_i) of pair i; pair 0 is (0.6, 0, 0.8) and the normal.
DEVICE inline vec3 shaded(int i, int count) {
  const vec3 wi = i ? direction(i, count, 2.3999632f) : vec3(0.6f, 0.0f, 0.8f);
  const vec3 wo = i ? direction(count - 1 - i, count, 1.9416110f) : vec3(0.0f, 0.0f, 1.0f);
  const vec3 f = burnish_shader::burnish_paint(wi, wo);
  return wi.z * f;
}

KERNEL shade(float* rgb, int count
#ifndef __CUDACC__
             , int i
#endif
) {
#ifdef __CUDACC__
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= count) return;
#endif
  const vec3 value = shaded(i, count);
  rgb[3 * i] = value.x;
  rgb[3 * i + 1] = value.y;
  rgb[3 * i + 2] = value.z;
}

#ifdef __CUDACC__
static void check(cudaError_t status) {
  if (status == cudaSuccess) return;
  std::fprintf(stderr, "cuda_kernel: %s\n", cudaGetErrorString(status));
  std::exit(1);
}
#endif

int main() {
  const int count = 1 << 20;
  std::vector<float> rgb(3 * static_cast<std::size_t>(count));
#ifdef __CUDACC__
  float* there = nullptr;
  check(cudaMalloc(&there, rgb.size() * sizeof(float)));
  shade<<<(count + 255) / 256, 256>>>(there, count);
  check(cudaGetLastError());
  check(cudaMemcpy(rgb.data(), there, rgb.size() * sizeof(float), cudaMemcpyDeviceToHost));
  check(cudaFree(there));
#else
  for (int i = 0; i < count; ++i) shade(rgb.data(), count, i);
#endif
  double sum = 0;
  for (const float value : rgb) sum += value;
  std::printf("mean %.6f\n", sum / static_cast<double>(rgb.size()));
  std::printf("pair 0: %.6f %.6f %.6f\n", rgb[0], rgb[1], rgb[2]);
}
