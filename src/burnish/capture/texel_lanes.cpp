#include <burnish/capture/texel_lanes.h>

#define HWY_TARGET_INCLUDE "burnish/capture/texel_lanes.cpp"
#include <burnish/math/highway-inl.h>

BURNISH_BEGIN_TARGET;

using D = hn::CappedTag<float, kTexelLanes>;

void sum_all(const TexelPixels& pixels, const TexelRow* weights, float* total) {
  const D d;
  for (std::size_t i = 0; i < kTexelLanes; i += hn::Lanes(d)) {
    auto sum = hn::Zero(d);
    for (std::size_t j = 0; j < pixels.lobes; ++j)
      sum = hn::MulAdd(hn::LoadU(d, weights[j].data() + i),
                       hn::LoadU(d, pixels.model + j * pixels.stride + i), sum);
    hn::StoreU(sum, d, total + i);
  }
}

void omega_of(float exposure, float floor, const float* at, const float* share, float* omega) {
  const D d;
  const auto one = hn::Set(d, 1.0f), e = hn::Set(d, exposure),
             scale = hn::Set(d, 0.25f * exposure * exposure);
  for (std::size_t i = 0; i < kTexelLanes; i += hn::Lanes(d)) {
    const auto x = hn::Max(hn::Mul(e, hn::LoadU(d, at + i)), hn::Set(d, floor));
    const auto under = hn::Mul(x, hn::Max(one, hn::Mul(x, x)));
    hn::StoreU(hn::Div(hn::Mul(scale, hn::LoadU(d, share + i)), under), d, omega + i);
  }
}

void add_all(const TexelPixels& pixels, const float* omega, TexelRow* matrix, TexelRow* vector) {
  const D d;
  for (std::size_t i = 0; i < kTexelLanes; i += hn::Lanes(d)) {
    const auto weight = hn::LoadU(d, omega + i), value = hn::LoadU(d, pixels.value + i);
    std::size_t at = 0;
    for (std::size_t j = 0; j < pixels.lobes; ++j) {
      const auto scaled = hn::Mul(weight, hn::LoadU(d, pixels.model + j * pixels.stride + i));
      float* const right = vector[j].data() + i;
      hn::StoreU(hn::MulAdd(scaled, value, hn::LoadU(d, right)), d, right);
      for (std::size_t l = 0; l <= j; ++l, ++at) {
        float* const to = matrix[at].data() + i;
        hn::StoreU(hn::MulAdd(scaled, hn::LoadU(d, pixels.model + l * pixels.stride + i), hn::LoadU(d, to)),
                   d, to);
      }
    }
  }
}

BURNISH_END_TARGET;

#if HWY_ONCE
namespace burnish {

HWY_EXPORT(sum_all);
HWY_EXPORT(omega_of);
HWY_EXPORT(add_all);

void sum_lobes(const TexelPixels& pixels, const TexelRow* weights, float* total) noexcept {
  HWY_DYNAMIC_DISPATCH(sum_all)(pixels, weights, total);
}

void find_omega(float exposure, float floor, const float* at, const float* share, float* omega) noexcept {
  HWY_DYNAMIC_DISPATCH(omega_of)(exposure, floor, at, share, omega);
}

void add_normal_equations(const TexelPixels& pixels, const float* omega, TexelRow* matrix,
                          TexelRow* vector) noexcept {
  HWY_DYNAMIC_DISPATCH(add_all)(pixels, omega, matrix, vector);
}

}  // namespace burnish
#endif
