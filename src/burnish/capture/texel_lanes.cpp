#include <burnish/capture/texel_lanes.h>
#include <burnish/surface/spatial_brdf.h>

#define HWY_TARGET_INCLUDE "burnish/capture/texel_lanes.cpp"
#include <burnish/math/highway-inl.h>
#include <hwy/contrib/math/math-inl.h>

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

/// Of `kLobes` lobes, so that sums stay in registers; 0: of any number.
template <std::size_t kLobes>
void equations_of(const TexelPictures& pictures, const TexelPass& pass, const TexelRow* weights, float* trust,
                  TexelRow* matrix, TexelRow* vector) {
  const D d;
  using V = hn::Vec<D>;
  constexpr std::size_t kMax = kLobes > 0 ? kLobes : kMaxSurfaceLobes, kChannels = 3;
  const std::size_t lobes = kLobes > 0 ? kLobes : pictures.lobes, stride = pictures.channels * kTexelLanes;
  const auto one = hn::Set(d, 1.0f), zero = hn::Zero(d), exposure = hn::Set(d, pass.exposure),
             floor = hn::Set(d, pass.floor), half = hn::Set(d, 0.5f),
             scale = hn::Set(d, 0.25f * pass.exposure * pass.exposure),
             square_reach = hn::Set(d, pass.reach * pass.reach), brighter = hn::Set(d, pass.brighter);
  for (std::size_t i = 0; i < kTexelLanes; i += hn::Lanes(d)) {
    V sums[kMax * (kMax + 1) / 2], right[kMax], weight[kMax];
    for (std::size_t j = 0; j < lobes; ++j) {
      right[j] = zero;
      weight[j] = hn::LoadU(d, weights[j].data() + i);
    }
    for (std::size_t at = 0; at < lobes * (lobes + 1) / 2; ++at) sums[at] = zero;
    for (std::size_t k = 0; k < pictures.pictures; ++k) {
      const float* const model = pictures.model + k * lobes * stride + i;
      const float* const values = pictures.value + k * stride + i;
      const auto there = hn::LoadU(d, pictures.there + k * kTexelLanes + i);
      // how the channels count
      V omega[kChannels];
      auto worst = zero;
      for (std::size_t c = 0; c < pictures.channels; ++c) {
        const auto value = hn::LoadU(d, values + c * kTexelLanes);
        auto at = value, share = there, rest = zero;
        if (!pass.of_measured) {
          auto total = zero;
          for (std::size_t j = 0; j < lobes; ++j)
            total = hn::MulAdd(weight[j], hn::LoadU(d, model + j * stride + c * kTexelLanes), total);
          at = hn::Mul(half, hn::Add(value, total));
          rest = hn::Sub(value, total);
          if (pictures.clipped) {
            const auto clipped = hn::LoadU(d, pictures.clipped + k * stride + c * kTexelLanes + i);
            share = hn::IfThenElse(hn::And(hn::Gt(clipped, zero), hn::Gt(total, value)), zero, share);
          }
        }
        const auto x = hn::Max(hn::Mul(exposure, at), floor);
        omega[c] = hn::Div(hn::Mul(scale, share), hn::Mul(x, hn::Max(one, hn::Mul(x, x))));
        if (pass.of_measured) continue;
        const auto counts = hn::IfThenElse(hn::Lt(rest, zero), one, brighter);
        worst = hn::Max(worst, hn::Mul(hn::Mul(hn::Mul(counts, omega[c]), rest), rest));
      }
      auto trusted = one;
      if (!pass.of_measured) {
        const auto doubt = hn::Add(one, hn::Div(worst, square_reach));
        trusted = hn::IfThenElse(hn::Gt(there, zero), hn::Div(one, hn::Mul(doubt, doubt)), zero);
        hn::StoreU(trusted, d, trust + k * kTexelLanes + i);
      }
      // the sums
      for (std::size_t c = 0; c < pictures.channels; ++c) {
        const auto value = hn::LoadU(d, values + c * kTexelLanes), counts = hn::Mul(omega[c], trusted);
        std::size_t at = 0;
        for (std::size_t j = 0; j < lobes; ++j) {
          const auto scaled = hn::Mul(counts, hn::LoadU(d, model + j * stride + c * kTexelLanes));
          right[j] = hn::MulAdd(scaled, value, right[j]);
          for (std::size_t l = 0; l <= j; ++l, ++at)
            sums[at] = hn::MulAdd(scaled, hn::LoadU(d, model + l * stride + c * kTexelLanes), sums[at]);
        }
      }
    }
    for (std::size_t j = 0; j < lobes; ++j) hn::StoreU(right[j], d, vector[j].data() + i);
    for (std::size_t at = 0; at < lobes * (lobes + 1) / 2; ++at)
      hn::StoreU(sums[at], d, matrix[at].data() + i);
  }
}

void all_equations(const TexelPictures& pictures, const TexelPass& pass, const TexelRow* weights,
                   float* trust, TexelRow* matrix, TexelRow* vector) {
  const auto find = pictures.lobes == 1   ? equations_of<1>
                    : pictures.lobes == 2 ? equations_of<2>
                    : pictures.lobes == 3 ? equations_of<3>
                    : pictures.lobes == 4 ? equations_of<4>
                    : pictures.lobes == 5 ? equations_of<5>
                    : pictures.lobes == 6 ? equations_of<6>
                    : pictures.lobes == 8 ? equations_of<8>
                                          : equations_of<0>;
  find(pictures, pass, weights, trust, matrix, vector);
}

void seen_of(float exposure, const float* value, float* seen) {
  const D d;
  constexpr float kGrey = 1 / 2.2f, kMin = 1e-30f;
  const auto one = hn::Set(d, 1.0f), least = hn::Set(d, kMin), e = hn::Set(d, exposure);
  for (std::size_t i = 0; i < kTexelLanes; i += hn::Lanes(d)) {
    const auto x = hn::Min(hn::Mul(e, hn::LoadU(d, value + i)), one);
    const auto root = hn::Exp(d, hn::Mul(hn::Set(d, kGrey), hn::Log(d, hn::Max(x, least))));
    hn::StoreU(hn::IfThenElse(hn::Gt(x, least), root, hn::Zero(d)), d, seen + i);
  }
}

BURNISH_END_TARGET;

#if HWY_ONCE
namespace burnish {

HWY_EXPORT(sum_all);
HWY_EXPORT(omega_of);
HWY_EXPORT(all_equations);
HWY_EXPORT(seen_of);

void sum_lobes(const TexelPixels& pixels, const TexelRow* weights, float* total) noexcept {
  HWY_DYNAMIC_DISPATCH(sum_all)(pixels, weights, total);
}

void find_omega(float exposure, float floor, const float* at, const float* share, float* omega) noexcept {
  HWY_DYNAMIC_DISPATCH(omega_of)(exposure, floor, at, share, omega);
}

void find_normal_equations(const TexelPictures& pictures, const TexelPass& pass, const TexelRow* weights,
                           float* trust, TexelRow* matrix, TexelRow* vector) noexcept {
  HWY_DYNAMIC_DISPATCH(all_equations)(pictures, pass, weights, trust, matrix, vector);
}

void find_seen(float exposure, const float* value, float* seen) noexcept {
  HWY_DYNAMIC_DISPATCH(seen_of)(exposure, value, seen);
}

}  // namespace burnish
#endif
