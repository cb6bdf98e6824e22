// SPDX-License-Identifier: Apache-2.0
// Highway 1.4's own powers for comparison. Only its headers are used, in a namespace of their own, because the
// library is built with the system's version of Highway.
#include "power_rivals_bench.h"

#if BURNISH_HAVE_HIGHWAY_RIVAL && defined(__x86_64__)

#define hwy burnish_rival_hwy
#define HWY_DISABLED_TARGETS (~(HWY_SSE2 | HWY_AVX2 | HWY_AVX3))
#define HWY_TARGET_INCLUDE "burnish/eval/power_rivals_bench.cpp"
#include "rival/contrib/math/fast_math-inl.h"
#include "rival/contrib/math/math-inl.h"
#include "rival/foreach_target.h"
#include "rival/highway.h"

HWY_BEFORE_NAMESPACE();
namespace burnish_rivals {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

template <class Power>
HWY_ATTR void over(std::span<const float> cosines, float exponent, std::span<float> out, const Power& power) {
  const D d;
  const std::size_t width = hn::Lanes(d);
  const V e = hn::Set(d, exponent);
  for (std::size_t i = 0; i + width <= cosines.size(); i += width)
    hn::StoreU(power(hn::LoadU(d, &cosines[i]), e), d, &out[i]);
}

void fast(std::span<const float> c, float e, std::span<float> out) {
  over(c, e, out, [](V x, V y) HWY_ATTR { return hn::FastPow<false>(D(), x, y); });
}
void fast_subnormal(std::span<const float> c, float e, std::span<float> out) {
  over(c, e, out, [](V x, V y) HWY_ATTR { return hn::FastPow<true>(D(), x, y); });
}
void exp_log(std::span<const float> c, float e, std::span<float> out) {
  over(c, e, out, [](V x, V y) HWY_ATTR { return hn::Exp(D(), hn::Mul(y, hn::Log(D(), x))); });
}

}  // namespace HWY_NAMESPACE
}  // namespace burnish_rivals
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

std::vector<PowerBaseline> highway_rivals() {
  namespace avx2 = burnish_rivals::N_AVX2;
  namespace avx3 = burnish_rivals::N_AVX3;
  return {{"highway_fastpow_false_avx2", &avx2::fast, 1e-4},
          {"highway_fastpow_true_avx2", &avx2::fast_subnormal, 1e-4},
          {"highway_exp_log_avx2", &avx2::exp_log, 5e-7},
          {"highway_fastpow_false_avx512", &avx3::fast, 1e-4},
          {"highway_fastpow_true_avx512", &avx3::fast_subnormal, 1e-4},
          {"highway_exp_log_avx512", &avx3::exp_log, 5e-7}};
}

std::string highway_rival_version() {
  return std::to_string(HWY_MAJOR) + "." + std::to_string(HWY_MINOR) + "." + std::to_string(HWY_PATCH);
}

}  // namespace burnish
#endif

#else

namespace burnish {

std::vector<PowerBaseline> highway_rivals() {
  return {};
}

std::string highway_rival_version() {
  return "absent";
}

}  // namespace burnish

#endif
