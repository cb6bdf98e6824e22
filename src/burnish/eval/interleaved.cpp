// SPDX-License-Identifier: Apache-2.0
#include <burnish/eval/interleaved.h>

#define HWY_TARGET_INCLUDE "burnish/eval/interleaved.cpp"
#include <burnish/math/highway-inl.h>

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

using D = hn::ScalableTag<float>;

void run_to_planes(const float* rows, std::size_t count, float* x, float* y, float* z) {
  const D d;
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
    hn::Vec<D> a, b, c;
    hn::LoadInterleaved3(d, rows + 3 * i, a, b, c);
    hn::StoreU(a, d, x + i);
    hn::StoreU(b, d, y + i);
    hn::StoreU(c, d, z + i);
  }
  for (; i < count; ++i) {
    x[i] = rows[3 * i];
    y[i] = rows[3 * i + 1];
    z[i] = rows[3 * i + 2];
  }
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

HWY_EXPORT(run_to_planes);

void to_planes(const float* rows, std::size_t count, float* x, float* y, float* z) noexcept {
  HWY_DYNAMIC_DISPATCH(run_to_planes)(rows, count, x, y, z);
}

}  // namespace burnish
#endif
