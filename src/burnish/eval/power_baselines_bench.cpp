// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>

#if defined(__x86_64__)
#include <immintrin.h>
#endif
#include "power_baselines_bench.h"

namespace burnish {
namespace {

// Returns a table over the cosine, made once an exponent.
template <int kEntries>
const std::vector<float>& table_of(float e) {
  static std::map<float, std::vector<float>> tables;
  std::vector<float>& table = tables[e];
  if (table.empty())
    for (int i = 0; i <= kEntries + 1; ++i)
      table.push_back(static_cast<float>(std::pow(std::min(1.0, static_cast<double>(i) / kEntries), e)));
  return table;
}
}  // namespace
}  // namespace burnish

// The loops get the same vectors as the kernels; power_baselines() checks that the processor has them.
#if defined(__x86_64__)
#pragma GCC push_options
#pragma GCC target("avx2,fma,avx512f,avx512dq,avx512bw,avx512vl,prefer-vector-width=512")
#endif

namespace burnish {
namespace {

using Cosines = std::span<const float>;
constexpr int kChain = 16;

void std_pow(Cosines c, float e, std::span<float> out) {
  for (std::size_t i = 0; i < c.size(); ++i)
    out[i] = static_cast<float>(std::pow(static_cast<double>(c[i]), static_cast<double>(e)));
}

void powf_loop(Cosines c, float e, std::span<float> out) {
  for (std::size_t i = 0; i < c.size(); ++i) out[i] = std::pow(c[i], e);
}

#if defined(__x86_64__)

extern "C" __m256 _ZGVdN8vv_powf(__m256, __m256);
extern "C" __m512 _ZGVeN16vv_powf(__m512, __m512);
#if BURNISH_HAVE_SLEEF
extern "C" __m256 Sleef_powf8_u10avx2(__m256, __m256);
extern "C" __m512 Sleef_powf16_u10avx512f(__m512, __m512);
extern "C" __m256 Sleef_fastpowf8_u3500avx2(__m256, __m256);
extern "C" __m512 Sleef_fastpowf16_u3500avx512f(__m512, __m512);
#endif

template <__m512 (*pow16)(__m512, __m512)>
void by_sixteens(Cosines c, float e, std::span<float> out) {
  const __m512 exponent = _mm512_set1_ps(e);
  for (std::size_t i = 0; i + 16 <= c.size(); i += 16)
    _mm512_storeu_ps(&out[i], pow16(_mm512_loadu_ps(&c[i]), exponent));
}
template <__m256 (*pow8)(__m256, __m256)>
void by_eights(Cosines c, float e, std::span<float> out) {
  const __m256 exponent = _mm256_set1_ps(e);
  for (std::size_t i = 0; i + 8 <= c.size(); i += 8)
    _mm256_storeu_ps(&out[i], pow8(_mm256_loadu_ps(&c[i]), exponent));
}

#endif

// c^e for a whole e: square and multiply, a block of values at a time.
void repeated_squaring(Cosines c, float e, std::span<float> out) {
  constexpr std::size_t kBlock = 64;
  const auto whole = static_cast<unsigned>(e);
  for (std::size_t i = 0; i + kBlock <= c.size(); i += kBlock) {
    float base[kBlock], result[kBlock];
    std::copy_n(c.begin() + static_cast<std::ptrdiff_t>(i), kBlock, base);
    std::fill_n(result, kBlock, 1.0f);
    for (unsigned bits = whole; bits; bits >>= 1) {
      if (bits & 1)
        for (std::size_t j = 0; j < kBlock; ++j) result[j] *= base[j];
      for (std::size_t j = 0; j < kBlock; ++j) base[j] *= base[j];
    }
    for (std::size_t j = 0; j < kBlock; ++j) out[i + j] = result[j];
  }
}

template <int kEntries>
void table_nearest(Cosines c, float e, std::span<float> out) {
  const float* table = table_of<kEntries>(e).data();
  for (std::size_t i = 0; i < c.size(); ++i)
    out[i] = table[static_cast<std::int32_t>(c[i] * kEntries + 0.5f)];
}
template <int kEntries>
void table_linear(Cosines c, float e, std::span<float> out) {
  const float* table = table_of<kEntries>(e).data();
  for (std::size_t i = 0; i < c.size(); ++i) {
    const float x = c[i] * kEntries;
    const auto k = static_cast<std::int32_t>(x);
    out[i] = table[k] + (x - static_cast<float>(k)) * (table[k + 1] - table[k]);
  }
}

#if defined(__x86_64__)
// The limits of a loop over memory: a copy, and one multiply-add a value.
void copy_avx2(Cosines c, float, std::span<float> out) {
  for (std::size_t i = 0; i + 8 <= c.size(); i += 8) _mm256_storeu_ps(&out[i], _mm256_loadu_ps(&c[i]));
}
void copy_avx512(Cosines c, float, std::span<float> out) {
  for (std::size_t i = 0; i + 16 <= c.size(); i += 16) _mm512_storeu_ps(&out[i], _mm512_loadu_ps(&c[i]));
}
void fma_avx2(Cosines c, float a, std::span<float> out) {
  const __m256 k = _mm256_set1_ps(a);
  for (std::size_t i = 0; i + 8 <= c.size(); i += 8)
    _mm256_storeu_ps(&out[i], _mm256_fmadd_ps(k, _mm256_loadu_ps(&c[i]), k));
}
void fma_avx512(Cosines c, float a, std::span<float> out) {
  const __m512 k = _mm512_set1_ps(a);
  for (std::size_t i = 0; i + 16 <= c.size(); i += 16)
    _mm512_storeu_ps(&out[i], _mm512_fmadd_ps(k, _mm512_loadu_ps(&c[i]), k));
}
// Sixteen multiply-adds a value in eight chains measure the limit of the arithmetic alone.
void fma_chain_avx2(Cosines c, float a, std::span<float> out) {
  const __m256 k = _mm256_set1_ps(a);
  for (std::size_t i = 0; i + 64 <= c.size(); i += 64) {
    __m256 x[8];
    for (int j = 0; j < 8; ++j) x[j] = _mm256_loadu_ps(&c[i + 8 * static_cast<std::size_t>(j)]);
    for (int step = 0; step < kChain; ++step)
      for (__m256& v : x) v = _mm256_fmadd_ps(k, v, k);
    for (int j = 0; j < 8; ++j) _mm256_storeu_ps(&out[i + 8 * static_cast<std::size_t>(j)], x[j]);
  }
}
void fma_chain_avx512(Cosines c, float a, std::span<float> out) {
  const __m512 k = _mm512_set1_ps(a);
  for (std::size_t i = 0; i + 128 <= c.size(); i += 128) {
    __m512 x[8];
    for (int j = 0; j < 8; ++j) x[j] = _mm512_loadu_ps(&c[i + 16 * static_cast<std::size_t>(j)]);
    for (int step = 0; step < kChain; ++step)
      for (__m512& v : x) v = _mm512_fmadd_ps(k, v, k);
    for (int j = 0; j < 8; ++j) _mm512_storeu_ps(&out[i + 16 * static_cast<std::size_t>(j)], x[j]);
  }
}
#endif

}  // namespace

}  // namespace burnish
#if defined(__x86_64__)
#pragma GCC pop_options
#endif

namespace burnish {

std::vector<PowerBaseline> power_limits() {
  std::vector<PowerBaseline> all;
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx512dq") || !__builtin_cpu_supports("avx512vl")) return all;
  all = {{"copy_avx2", &copy_avx2, -1},         {"fma_avx2", &fma_avx2, -1},
         {"fma_x16_avx2", &fma_chain_avx2, -1}, {"copy_avx512", &copy_avx512, -1},
         {"fma_avx512", &fma_avx512, -1},       {"fma_x16_avx512", &fma_chain_avx512, -1}};
#endif
  return all;
}

std::vector<PowerBaseline> power_baselines() {
  std::vector<PowerBaseline> all;
#if defined(__x86_64__)
  // Without AVX-512 there are no baselines, since slower loops would make no fair comparison.
  if (!__builtin_cpu_supports("avx512dq") || !__builtin_cpu_supports("avx512vl")) return all;
#endif
  all = {{"std::pow(double)", &std_pow, 1e-7}, {"powf", &powf_loop, 1e-7}};
#if defined(__x86_64__)
  all.push_back({"libmvec_avx2", &by_eights<_ZGVdN8vv_powf>, 5e-7});
  all.push_back({"libmvec_avx512", &by_sixteens<_ZGVeN16vv_powf>, 5e-7});
#if BURNISH_HAVE_SLEEF
  all.push_back({"sleef_u10_avx2", &by_eights<Sleef_powf8_u10avx2>, 5e-7});
  all.push_back({"sleef_u10_avx512", &by_sixteens<Sleef_powf16_u10avx512f>, 5e-7});
  all.push_back({"sleef_fast_avx2", &by_eights<Sleef_fastpowf8_u3500avx2>, 2e-4});
  all.push_back({"sleef_fast_avx512", &by_sixteens<Sleef_fastpowf16_u3500avx512f>, 2e-4});
#endif
#endif
  all.push_back({"repeated_squaring", &repeated_squaring, 5e-6});
  all.push_back({"table_1024_nearest", &table_nearest<1024>, 0.03});
  all.push_back({"table_1024_linear", &table_linear<1024>, 5e-4});
  return all;
}

}  // namespace burnish
