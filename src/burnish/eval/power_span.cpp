// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <burnish/error.h>
#include <burnish/eval/power_span.h>

#define HWY_TARGET_INCLUDE "burnish/eval/power_span.cpp"
#include <burnish/math/highway-inl.h>

#include <burnish/eval/power_lanes-inl.h>
#include <burnish/eval/vector_loop-inl.h>

#ifndef BURNISH_EVAL_SHADE_ARGUMENTS
#define BURNISH_EVAL_SHADE_ARGUMENTS
namespace burnish {
// The arguments of the Blinn-Phong kernels of all targets.
struct ShadeArguments {
  const float *x, *y, *z;
  std::size_t count;
  float diffuse, specular;
  Vec3 wi, h;
  const double* k;
};
}  // namespace burnish
#endif

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

using ConstantKernel = void (*)(const float* cosines, std::size_t count, const double* k, float* out);
using VaryingKernel = void (*)(const float* cosines, const float* exponents, std::size_t count, float* out);
using ShadeKernel = void (*)(const ShadeArguments&, float* out);

template <class Form>
void constant_kernel(const float* cosines, std::size_t count, const double* coefficients, float* out) {
  Lane k[Form::kCoefficients];
  for (int i = 0; i < Form::kCoefficients; ++i) k[i] = Lane(coefficients[i]);
  for_each_vector<4>({cosines}, count, out,
                     [=](const Lane(&in)[1]) HWY_ATTR { return Form::value(cosine(in[0]), k); });
}

// These two kernels prepare more than coefficients for a span. With 16 registers, more vectors a turn would spill.
constexpr int kNearExactUnroll = BURNISH_TARGET_IS_AVX3 ? 4 : 2;
template <>
void constant_kernel<NearExact>(const float* cosines, std::size_t count, const double* coefficients,
                                float* out) {
  const NearExactSpan k(coefficients[0]);
  for_each_vector<kNearExactUnroll>(
      {cosines}, count, out, [=](const Lane(&in)[1]) HWY_ATTR { return near_exact_of_span(in[0], k); });
}
template <>
void constant_kernel<Exact>(const float* cosines, std::size_t count, const double* coefficients, float* out) {
  const ExactSpan k(coefficients[0]);
  for_each_vector<1>({cosines}, count, out,
                     [=](const Lane(&in)[1]) HWY_ATTR { return exact_of_span(in[0], k); });
}

template <class Form>
void varying_kernel(const float* cosines, const float* exponents, std::size_t count, float* out) {
  for_each_vector<2>({cosines, exponents}, count, out, [](const Lane(&in)[2]) HWY_ATTR {
    Lane k[Form::kCoefficients];
    Form::coefficients(Exponent<Lane>{in[1], Lane(1.0)}, k);
    return Form::value(cosine(in[0]), k);
  });
}

/// No power: the cosine itself.
struct Identity {
  static constexpr int kCoefficients = 1;
  template <class P, class T>
  static T value(const P& p, const T*) {
    return p.c;
  }
};

template <class Form>
concept PowerOfClampedForm = requires {
  Form::kLog2Power;
};

// Computes diffuse + specular * power. Powers of a clamped form save their two outer multiplies: u is scaled so that
// the leading coefficient is 1, and the form so that its power includes the weight.
template <class Form>
struct Highlight {
  double u_scale = 1;
  Lane specular, k[Form::kCoefficients];

  explicit Highlight(const ShadeArguments& a) : specular(a.specular) {
    for (int i = 0; i < Form::kCoefficients; ++i) k[i] = Lane(a.k[i]);
  }
  HWY_INLINE Lane added_to(Lane diffuse, Lane u) const {
    return mul_add(specular, Form::value(Cosine<Lane>{Lane(1.0) - u, u}, k), diffuse);
  }
};
template <PowerOfClampedForm Form>
struct Highlight<Form> {
  double u_scale;
  Lane top, k[Form::kCoefficients];

  explicit Highlight(const ShadeArguments& a) {
    constexpr int kDegree = Form::kCoefficients;
    static_assert(kDegree == 1 || kDegree == 3);
    constexpr double kMin = 1e-30;  // instead of 0, which would make scaling by it impossible
    double root = std::max<double>(a.specular, kMin);
    for (int i = 0; i < Form::kLog2Power; ++i) root = std::sqrt(root);
    top = Lane(root);
    const double leading = root * a.k[kDegree - 1];
    u_scale = kDegree == 1 ? leading : std::cbrt(leading);
    for (int i = 0; i < kDegree; ++i) k[i] = Lane((root /= u_scale) * a.k[i]);
  }
  HWY_INLINE Lane added_to(Lane diffuse, Lane u) const {
    const Lane half_power = power_of_two_power<Form::kLog2Power - 1>(Form::root(u, k, top));
    return mul_add(half_power, half_power, diffuse);
  }
};

template <class Form>
void shade_kernel(const ShadeArguments& a, float* out) {
  const Highlight<Form> highlight(a);
  const Lane lx(a.diffuse * a.wi.x), ly(a.diffuse * a.wi.y), lz(a.diffuse * a.wi.z);
  const double scale = highlight.u_scale;
  const Lane hx(scale * a.h.x), hy(scale * a.h.y), hz(scale * a.h.z), u_at_0(scale);
  for_each_vector<1>({a.x, a.y, a.z}, a.count, out, [=](const Lane(&n)[3]) HWY_ATTR {
    const Lane inverse = Lane(1.0) / sqrt(mul_add(n[0], n[0], mul_add(n[1], n[1], n[2] * n[2])));
    const Lane diffuse = clamp_negative(mul_add(n[0], lx, mul_add(n[1], ly, n[2] * lz))) * inverse;
    const Lane to_half = clamp_negative(mul_add(n[0], hx, mul_add(n[1], hy, n[2] * hz)));
    // 1 - c comes first: it takes one operation, and rounding never makes it negative.
    const Lane u = clamp_negative(neg_mul_add(to_half, inverse, u_at_0));
    return highlight.added_to(diffuse, u);
  });
}

template <class... Forms>
struct Kernels {
  static constexpr ConstantKernel kConstant[] = {&constant_kernel<Forms>...};
  static constexpr VaryingKernel kVarying[] = {&varying_kernel<Forms>...};
  static constexpr ShadeKernel kShade[] = {&shade_kernel<Forms>..., &shade_kernel<Identity>};
};
using AllKernels = AllForms<Kernels>;

void run_constant(int method, const float* cosines, std::size_t count, const double* k, float* out) {
  AllKernels::kConstant[method](cosines, count, k, out);
}
void run_varying(int method, const float* cosines, const float* exponents, std::size_t count, float* out) {
  AllKernels::kVarying[method](cosines, exponents, count, out);
}
void run_shade(int method, const ShadeArguments& arguments, float* out) {
  AllKernels::kShade[method](arguments, out);
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

HWY_EXPORT(run_constant);
HWY_EXPORT(run_varying);
HWY_EXPORT(run_shade);

namespace {

void require_length(std::size_t expected, std::size_t found, const char* what) {
  if (expected != found)
    throw Error(std::string(what) + ": expected " + std::to_string(expected) + " values, found " +
                std::to_string(found));
}

}  // namespace

void power_span(const PowerCoefficients& coefficients, std::span<const float> cosines, std::span<float> out) {
  require_length(cosines.size(), out.size(), "power results");
  HWY_DYNAMIC_DISPATCH(run_constant)
  (static_cast<int>(coefficients.method), cosines.data(), cosines.size(), coefficients.k.data(), out.data());
}

void power_span(PowerMethod method, std::span<const float> cosines, double exponent, std::span<float> out) {
  power_span(power_coefficients(method, exponent), cosines, out);
}

void power_span(PowerMethod method, std::span<const float> cosines, std::span<const float> exponents,
                std::span<float> out) {
  require_length(cosines.size(), out.size(), "power results");
  require_length(cosines.size(), exponents.size(), "exponents");
  HWY_DYNAMIC_DISPATCH(run_varying)
  (static_cast<int>(method), cosines.data(), exponents.data(), cosines.size(), out.data());
}

void shade_blinn_phong(const BlinnPhongShading& material, const NormalSpans& normals, std::span<float> out) {
  require_length(out.size(), normals.x.size(), "normals x");
  require_length(out.size(), normals.y.size(), "normals y");
  require_length(out.size(), normals.z.size(), "normals z");
  const PowerCoefficients k = material.power.value_or(PowerCoefficients{});
  const ShadeArguments arguments{
      normals.x.data(), normals.y.data(),  normals.z.data(), out.size(),
      material.diffuse, material.specular, material.wi,      half_vector(material.wi, material.wo),
      k.k.data()};
  const int kernel = material.power ? static_cast<int>(k.method) : kPowerMethods;  // Identity is last
  HWY_DYNAMIC_DISPATCH(run_shade)(kernel, arguments, out.data());
}

double power_span_rounding(PowerMethod method, bool exponent_per_value) noexcept {
  using M = PowerMethod;
  if (method == M::gaussian || method == M::gaussian2) return 7.2e-5;  // NearExact::exp2_near_zero_short
  // The coefficient a of these methods comes from the near-exact power times the exponent.
  const bool by_equation_7 =
      method == M::quadratic || method == M::quadratic_raw || method == M::two_piece_paper;
  if (by_equation_7 && exponent_per_value) return 2e-5;
  if (method == M::angle16 || method == M::w16 || method == M::angle8)
    return 3e-6;  // four or three squarings
  return 1e-6;
}

std::vector<std::string> simd_targets() {
  std::vector<std::string> names;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets())
    names.emplace_back(hwy::TargetName(target));
  return names;
}

SimdTargetLimit::SimdTargetLimit(const std::string& name) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets())
    if (name == hwy::TargetName(target)) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      return;
    }
  throw Error("SIMD target: expected one of simd_targets(), found " + name);
}

SimdTargetLimit::~SimdTargetLimit() {
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace burnish
#endif
