// SPDX-License-Identifier: Apache-2.0
#include "evaluation_peers_bench.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <burnish/baselines/neural_brdf.h>
#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>

#define HWY_TARGET_INCLUDE "burnish/eval/evaluation_peers_bench.cpp"
#include <burnish/math/highway-inl.h>

#include <burnish/eval/lookup_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

struct Vector {
  Lane x, y, z;
};
HWY_INLINE Lane dot(const Vector& a, const Vector& b) {
  return mul_add(a.x, b.x, mul_add(a.y, b.y, a.z * b.z));
}
HWY_INLINE Lane length(const Vector& a) {
  return sqrt(dot(a, a));
}
HWY_INLINE Lane if_positive(Lane condition, Lane value, Lane other) {
  return Lane(hn::IfThenElse(hn::Gt(condition.raw, hn::Zero(D())), value.raw, other.raw));
}
HWY_INLINE Lane arctangent(Lane t) {
  return Lane(hn::Atan(D(), t.raw));
}

// Calls body(wi, wo, value) for whole vectors of directions and stores the three channels it sets.
template <class Body>
HWY_INLINE void for_each_pair(const DirectionSpans& in, std::span<float> f, const Body& body) {
  const auto load = [](std::span<const float> from, std::size_t i)
                        HWY_ATTR { return Lane(hn::LoadU(D(), from.data() + i)); };
  for (std::size_t i = 0; i < in.size(); i += kLanes) {
    Lane value[3];
    body(Vector{load(in.wi_x, i), load(in.wi_y, i), load(in.wi_z, i)},
         Vector{load(in.wo_x, i), load(in.wo_y, i), load(in.wo_z, i)}, value);
    for (std::size_t c = 0; c < 3; ++c) hn::StoreU(value[c].raw, D(), f.data() + c * in.size() + i);
  }
}

// Returns twice the difference vector, in the frame of the half vector; its z is |wi + wo|.
HWY_INLINE Vector doubled_difference(const Vector& wi, const Vector& wo, const Vector& sum) {
  const Vector d{wi.x - wo.x, wi.y - wo.y, wi.z - wo.z};
  const Lane total = length(sum), across = sqrt(mul_add(sum.x, sum.x, sum.y * sum.y));
  const Lane cos_phi = if_positive(across, sum.x / across, Lane(1.0));
  const Lane sin_phi = if_positive(across, sum.y / across, Lane(0.0));
  const Lane along = mul_add(cos_phi, d.x, sin_phi * d.y);
  return {neg_mul_add(across, d.z, sum.z * along) / total, neg_mul_add(sin_phi, d.x, cos_phi * d.y), total};
}
HWY_INLINE Vector sum_of(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
// Returns the polar angle of a vector with this length.
HWY_INLINE Lane polar_angle(const Vector& v, Lane total) {
  return Lane(2.0) * arctangent(sqrt(mul_add(v.x, v.x, v.y * v.y)) / (total + v.z));
}

// Computes y = kernel^T x + bias. The weights are stored row by row, then the biases. With kCutOff, negative results
// become 0.
template <int kInputs, int kOutputs, bool kCutOff>
HWY_INLINE const float* affine(const float* weights, const Lane (&x)[kInputs], Lane (&y)[kOutputs]) {
  const D d;
  for (int o = 0; o < kOutputs; ++o) y[o] = Lane(hn::Set(d, weights[kInputs * kOutputs + o]));
#pragma GCC unroll 21
  for (int i = 0; i < kInputs; ++i)
#pragma GCC unroll 21
    for (int o = 0; o < kOutputs; ++o)
      y[o] = mul_add(Lane(hn::Set(d, weights[i * kOutputs + o])), x[i], y[o]);
  if (kCutOff)
    for (int o = 0; o < kOutputs; ++o) y[o] = clamp_negative(y[o]);
  return weights + (kInputs + 1) * kOutputs;
}

void neural(std::span<const float> weights, const DirectionSpans& in, std::span<float> f) {
  constexpr int kInputs = NeuralBrdf::kInputs, kHidden = NeuralBrdf::kHidden;
  for_each_pair(in, f, [&](const Vector& wi, const Vector& wo, Lane(&value)[3]) HWY_ATTR {
    const Vector sum = sum_of(wi, wo), d = doubled_difference(wi, wo, sum);
    const Lane inverse = Lane(1.0) / d.z, half(0.5);
    const Lane inputs[kInputs] = {sqrt(mul_add(sum.x, sum.x, sum.y * sum.y)) * inverse,
                                  Lane(0.0),
                                  sum.z * inverse,
                                  half * d.x,
                                  half * d.y,
                                  half * d.z};
    Lane first[kHidden], second[kHidden];
    const float* w = affine<kInputs, kHidden, true>(weights.data(), inputs, first);
    w = affine<kHidden, kHidden, true>(w, first, second);
    affine<kHidden, 3, false>(w, second, value);
    for (Lane& v : value) v = clamp_negative(Lane(hn::Exp(D(), v.raw)) - Lane(1.0));
  });
}

void tabulated(const TabulatedMicrofacets& b, const DirectionSpans& in, std::span<float> f) {
  constexpr double kScale = (TabulatedMicrofacets::kAngles - 1) / kHalfPi;
  const auto lookup = [](const std::vector<float>& table, const LaneCell& cell) HWY_ATTR {
    const auto node = node_of(cell);
    return mix(Lane(hn::GatherIndex(D(), table.data(), node)),
               Lane(hn::GatherIndex(D(), table.data() + 1, node)), cell.fraction);
  };
  const auto cell = [](const Vector& v, Lane total) HWY_ATTR {
    return cell_of(min(Lane(kScale) * polar_angle(v, total), Lane(TabulatedMicrofacets::kAngles - 1.001)));
  };
  for_each_pair(in, f, [&](const Vector& wi, const Vector& wo, Lane(&value)[3]) HWY_ATTR {
    const Vector sum = sum_of(wi, wo), across{wi.x - wo.x, wi.y - wo.y, wi.z - wo.z};
    const Lane total = length(sum), one(1.0);
    const LaneCell h = cell(sum, total), i = cell(wi, one), o = cell(wo, one);
    const LaneCell d = cell({length(across), Lane(0.0), total}, Lane(2.0));
    const Lane scale = Lane(0.25) / (wi.z * wo.z);
    for (std::size_t c = 0; c < 3; ++c)
      value[c] = mul_add(lookup(b.d[c], h) * lookup(b.f[c], d) * scale, lookup(b.g[c], i) * lookup(b.g[c], o),
                         Lane(b.diffuse[c]));
  });
}

void ggx(const Ggx& b, const DirectionSpans& in, std::span<float> f) {
  const double alpha = b.distribution.alpha_x;
  const Lane a2(alpha * alpha), rest(1 - alpha * alpha), one(1.0);
  const double f0[] = {b.f0.r, b.f0.g, b.f0.b}, kd[] = {b.kd.r, b.kd.g, b.kd.b};
  for_each_pair(in, f, [&](const Vector& wi, const Vector& wo, Lane(&value)[3]) HWY_ATTR {
    const Vector sum = sum_of(wi, wo);
    const Lane square = dot(sum, sum), cos_d = Lane(0.5) * sqrt(square);
    const Lane across = mul_add(sum.x, sum.x, sum.y * sum.y);
    // q is (x^2 + y^2) / alpha^2 + z^2 of h, times alpha^2 square.
    const Lane q = mul_add(a2 * sum.z, sum.z, across);
    const auto area = [&](Lane z) HWY_ATTR {  // twice the projected area
      return z + sqrt(mul_add(rest * z, z, a2));
    };
    const Lane visible =
        mul_add(area(wi.z), wo.z, neg_mul_add(Lane(2.0) * wi.z, wo.z, area(wo.z) * wi.z));  // doubled
    const Lane specular = Lane(0.5 * std::numbers::inv_pi) * a2 * square * square / (q * q * visible);
    const Lane m = one - cos_d, m2 = m * m, m5 = m2 * m2 * m;
    for (int c = 0; c < 3; ++c) {
      const Lane fresnel = mul_add(m5, Lane(1 - f0[c]), Lane(f0[c]));
      value[c] = mul_add(specular, fresnel, Lane(kd[c] * std::numbers::inv_pi));
    }
  });
}

void nearest(const HalfDiffTable& t, const DirectionSpans& in, std::span<float> f) {
  const DI di;
  const auto index = [&](Lane position, int count) HWY_ATTR {
    return hn::Min(hn::ConvertTo(di, position.raw), hn::Set(di, count - 1));
  };
  for_each_pair(in, f, [&](const Vector& wi, const Vector& wo, Lane(&value)[3]) HWY_ATTR {
    const Vector sum = sum_of(wi, wo), d = doubled_difference(wi, wo, sum);
    const Lane theta_h = polar_angle(sum, d.z), theta_d = polar_angle(d, Lane(2.0));
    const Lane half_phi = arctangent(d.y / d.x) * Lane(1 / kPi);
    const Lane circle = if_positive(half_phi, half_phi, half_phi + Lane(1.0));
    const auto h = index(sqrt(theta_h * Lane(1 / kHalfPi)) * Lane(t.theta_h_count), t.theta_h_count);
    const auto e = index(theta_d * Lane(t.theta_d_count / kHalfPi), t.theta_d_count);
    const auto p = index(circle * Lane(t.phi_d_count), t.phi_d_count);
    const auto row = hn::Add(hn::Mul(h, hn::Set(di, t.theta_d_count)), e);
    const auto entry = hn::Mul(hn::Add(hn::Mul(row, hn::Set(di, t.phi_d_count)), p), hn::Set(di, 3));
    for (int c = 0; c < 3; ++c) value[c] = Lane(hn::GatherIndex(D(), t.values.data() + c, entry));
  });
}

float load_all(std::span<const float> table, std::span<const std::int32_t> node) {
  const hn::CappedTag<float, 8> d8;
  constexpr std::size_t kTogether = 8;
  hn::Vec<hn::CappedTag<float, 8>> sum[kTogether];
  for (auto& s : sum) s = hn::Zero(d8);
  for (std::size_t i = 0; i + kTogether <= node.size(); i += kTogether)
    for (std::size_t k = 0; k < kTogether; ++k)
      for (std::size_t part = 0; part < 8; part += hn::MaxLanes(d8))
        sum[k] = hn::Add(sum[k], hn::LoadU(d8, table.data() + node[i + k] + part));
  for (std::size_t k = 1; k < kTogether; ++k) sum[0] = hn::Add(sum[0], sum[k]);
  return hn::GetLane(hn::SumOfLanes(d8, sum[0]));
}

std::size_t fuse_all(std::size_t steps, float factor, float* last) {
  constexpr std::size_t kTogether = 16;
  Lane sum[kTogether];
  for (std::size_t k = 0; k < kTogether; ++k) sum[k] = Lane(static_cast<double>(k));
  const Lane by(static_cast<double>(factor));
  for (std::size_t i = 0; i < steps; ++i)
    for (Lane& s : sum) s = Lane(hn::MulAdd(s.raw, by.raw, by.raw));
  for (std::size_t k = 1; k < kTogether; ++k) sum[0] = sum[0] + sum[k];
  hn::StoreU(sum[0].raw, D(), last);
  return steps * kTogether * kLanes;
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

HWY_EXPORT(neural);
HWY_EXPORT(tabulated);
HWY_EXPORT(ggx);
HWY_EXPORT(nearest);
HWY_EXPORT(load_all);
HWY_EXPORT(fuse_all);

void eval_neural(std::span<const float> weights, const DirectionSpans& directions, std::span<float> f) {
  HWY_DYNAMIC_DISPATCH(neural)(weights, directions, f);
}
void eval_tabulated(const TabulatedMicrofacets& brdf, const DirectionSpans& directions, std::span<float> f) {
  HWY_DYNAMIC_DISPATCH(tabulated)(brdf, directions, f);
}
void eval_ggx(const Ggx& brdf, const DirectionSpans& directions, std::span<float> f) {
  HWY_DYNAMIC_DISPATCH(ggx)(brdf, directions, f);
}
void eval_nearest(const HalfDiffTable& table, const DirectionSpans& directions, std::span<float> f) {
  HWY_DYNAMIC_DISPATCH(nearest)(table, directions, f);
}

float load_nodes(std::span<const float> table, std::span<const std::int32_t> node) {
  return HWY_DYNAMIC_DISPATCH(load_all)(table, node);
}
std::size_t multiply_add(std::size_t steps, float factor, std::span<float, 64> last) {
  return HWY_DYNAMIC_DISPATCH(fuse_all)(steps, factor, last.data());
}

bool TabulatedMicrofacets::eval(Vec3 wi, Vec3 wo, std::span<double> value) const noexcept {
  const auto lookup = [](const std::vector<float>& table, double theta) {
    const double position = std::min(theta / kHalfPi * (kAngles - 1), kAngles - 1.001);
    const auto node = static_cast<std::size_t>(position);
    return std::lerp(static_cast<double>(table[node]), static_cast<double>(table[node + 1]),
                     position - static_cast<double>(node));
  };
  const HalfDiff angles = to_half_diff(wi, wo);
  for (std::size_t c = 0; c < 3; ++c)
    value[c] = diffuse[c] + lookup(d[c], angles.theta_h) * lookup(f[c], angles.theta_d) *
                                lookup(g[c], theta_of(wi)) * lookup(g[c], theta_of(wo)) / (4 * wi.z * wo.z);
  return true;
}

}  // namespace burnish
#endif
