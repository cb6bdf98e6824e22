// SPDX-License-Identifier: Apache-2.0
// Per-target include: the loop over spans that the kernels share. A benchmark's plainest kernel uses the same loop.
#if defined(BURNISH_EVAL_VECTOR_LOOP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BURNISH_EVAL_VECTOR_LOOP_INL_H_
#undef BURNISH_EVAL_VECTOR_LOOP_INL_H_
#else
#define BURNISH_EVAL_VECTOR_LOOP_INL_H_
#endif

#include <algorithm>
#include <cstddef>

#include <burnish/eval/lanes-inl.h>

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

// The last values, through buffers of one vector filled up with the first of them. Not inlined: vectors
// cannot stay in registers across the calls that copy a few floats.
template <int kInputs, class Body>
HWY_NOINLINE void rest_through_buffers(const float* const (&from)[kInputs], std::size_t begin,
                                       std::size_t count, float* out, const Body& body) {
  const D d;
  const std::size_t width = hn::Lanes(d);
  for (std::size_t i = begin; i < count; i += width) {
    const std::size_t rest = std::min(width, count - i);
    float buffer[hn::MaxLanes(D())];
    Lane in[kInputs];
    for (int k = 0; k < kInputs; ++k) {
      std::fill(buffer, buffer + width, from[k][i]);
      std::copy(from[k] + i, from[k] + i + rest, buffer);
      in[k] = Lane(hn::LoadU(d, buffer));
    }
    hn::StoreU(body(in).raw, d, buffer);
    std::copy(buffer, buffer + rest, out + i);
  }
}

/// Computes out[i] = body(from[0][i], from[1][i], …), a vector at a time, with kUnroll vectors a turn: all loads,
/// then all stores. Body takes const Lane (&)[kInputs] and holds its constants by value: a copy of it is kept in
/// registers.
template <int kUnroll, int kInputs, class Body>
HWY_INLINE void for_each_vector(const float* const (&from)[kInputs], std::size_t count, float* out,
                                const Body& body) {
  const D d;
  const std::size_t width = hn::Lanes(d);
  const Body kept = body;
  std::size_t i = 0;
  for (; i + kUnroll * width <= count; i += kUnroll * width) {
    Lane in[kUnroll][kInputs], result[kUnroll];
    for (int j = 0; j < kUnroll; ++j)
      for (int k = 0; k < kInputs; ++k)
        in[j][k] = Lane(hn::LoadU(d, from[k] + i + static_cast<std::size_t>(j) * width));
    for (int j = 0; j < kUnroll; ++j) result[j] = kept(in[j]);
    for (int j = 0; j < kUnroll; ++j)
      hn::StoreU(result[j].raw, d, out + i + static_cast<std::size_t>(j) * width);
  }
  if (i < count) rest_through_buffers(from, i, count, out, body);
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#endif
