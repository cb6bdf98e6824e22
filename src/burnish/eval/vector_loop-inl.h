// SPDX-License-Identifier: Apache-2.0
// Per-target include: the loop over spans that the kernels share.
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

// Copies `count` values of each input from `begin` on, and fills the rows of `width` floats up with the first of them.
// The copies are calls shared by all kernels: a kernel with copies of its own would be half as long again.
HWY_NOINLINE void copy_rest(const float* const* from, int inputs, std::size_t begin, std::size_t count,
                            float* rows, std::size_t width) {
  for (int k = 0; k < inputs; ++k, rows += width) {
    std::fill(rows, rows + width, from[k][begin]);
    std::copy(from[k] + begin, from[k] + begin + count, rows);
  }
}
HWY_NOINLINE void store_rest(const float* row, std::size_t count, float* out) {
  std::copy(row, row + count, out);
}

/// Computes out[i] = body(from[0][i], from[1][i], …), a vector at a time, with kUnroll vectors a turn: all loads,
/// then all stores. The last values are copied, filled up to a whole turn, and take one more turn of the same loop.
/// Body takes const Lane (&)[kInputs] and holds its constants by value: a copy of it is kept in registers.
template <int kUnroll, int kInputs, class Body>
HWY_INLINE void for_each_vector(const float* const (&from)[kInputs], std::size_t count, float* out,
                                const Body& body) {
  const D d;
  constexpr std::size_t kWidth = hn::MaxLanes(D());
  // Without vectors, more values a turn gain nothing: the processor overlaps turns by itself.
  constexpr std::size_t kVectors = kWidth == 1 ? 1 : kUnroll;
  constexpr std::size_t kTurn = kVectors * kWidth;
  struct Part {
    const float* from[kInputs];
    float* out;
    std::size_t count;
  };
  const std::size_t whole = count / kTurn * kTurn;
  float rest[kInputs + 1][kTurn];  // the result is last
  Part parts[2] = {{{}, out, whole}, {{}, rest[kInputs], kTurn}};
  for (int k = 0; k < kInputs; ++k) {
    parts[0].from[k] = from[k];
    parts[1].from[k] = rest[k];
  }
  // No vector stays in a register across a call, so calls come before and after both parts.
  const bool has_rest = kTurn > 1 && whole < count;
  if (has_rest) copy_rest(from, kInputs, whole, count - whole, rest[0], kTurn);
  const Body kept = body;
  for (int p = 0; p < 1 + has_rest; ++p) {
    const Part& part = parts[p];
    for (std::size_t i = 0; i < part.count; i += kTurn) {
      Lane in[kVectors][kInputs], result[kVectors];
      for (std::size_t j = 0; j < kVectors; ++j)
        for (int k = 0; k < kInputs; ++k) in[j][k] = Lane(hn::LoadU(d, part.from[k] + i + j * kWidth));
      for (std::size_t j = 0; j < kVectors; ++j) result[j] = kept(in[j]);
      for (std::size_t j = 0; j < kVectors; ++j) hn::StoreU(result[j].raw, d, part.out + i + j * kWidth);
    }
  }
  if (has_rest) store_rest(rest[kInputs], count - whole, out + whole);
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#endif
