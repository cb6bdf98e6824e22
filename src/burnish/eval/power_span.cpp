#include <algorithm>
#include <array>
#include <cmath>

#include <burnish/error.h>
#include <burnish/eval/power_span.h>

// Vectors whose size is unknown when compiling cannot be members of a struct; those processors have a fixed
// set too. SSSE3 and AVX3_DL bring nothing over their neighbours here.
#define HWY_DISABLED_TARGETS \
  (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "burnish/eval/power_span.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include <burnish/eval/power_lanes-inl.h>

#ifndef BURNISH_EVAL_SHADE_ARGUMENTS
#define BURNISH_EVAL_SHADE_ARGUMENTS
namespace burnish {
// What the Blinn-Phong kernels of all targets take.
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
namespace burnish {
namespace HWY_NAMESPACE {
namespace {

using ConstantKernel = void (*)(const float* cosines, std::size_t count, const double* k, float* out);
using VaryingKernel = void (*)(const float* cosines, const float* exponents, std::size_t count, float* out);
using ShadeKernel = void (*)(const ShadeArguments&, float* out);

// Runs body(i, width) over whole vectors, then the rest through buffers of one vector each.
template <class Form>
void constant_kernel(const float* cosines, std::size_t count, const double* coefficients, float* out) {
  const D d;
  Lane k[Form::kCoefficients];
  for (int i = 0; i < Form::kCoefficients; ++i) k[i] = Lane(coefficients[i]);
  const auto one = [&](const float* c, float* to)
                       HWY_ATTR { hn::StoreU(Form::value(cosine(Lane(hn::LoadU(d, c))), k).raw, d, to); };
  const std::size_t width = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + width <= count; i += width) one(cosines + i, out + i);
  if (i < count) {
    std::array<float, hn::MaxLanes(D())> rest{};
    std::copy(cosines + i, cosines + count, rest.begin());
    one(rest.data(), rest.data());
    std::copy(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(count - i), out + i);
  }
}

template <class Form>
void varying_kernel(const float* cosines, const float* exponents, std::size_t count, float* out) {
  const D d;
  const auto one = [&](const float* c, const float* e, float* to) HWY_ATTR {
    Lane k[Form::kCoefficients];
    Form::coefficients(Exponent<Lane>{Lane(hn::LoadU(d, e)), Lane(1.0)}, k);
    hn::StoreU(Form::value(cosine(Lane(hn::LoadU(d, c))), k).raw, d, to);
  };
  const std::size_t width = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + width <= count; i += width) one(cosines + i, exponents + i, out + i);
  if (i < count) {
    std::array<float, hn::MaxLanes(D())> rest{}, rest_exponents;
    rest_exponents.fill(exponents[i]);
    std::copy(cosines + i, cosines + count, rest.begin());
    std::copy(exponents + i, exponents + count, rest_exponents.begin());
    one(rest.data(), rest_exponents.data(), rest.data());
    std::copy(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(count - i), out + i);
  }
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
void shade_kernel(const ShadeArguments& a, float* out) {
  const D d;
  Lane k[Form::kCoefficients];
  for (int i = 0; i < Form::kCoefficients; ++i) k[i] = Lane(a.k[i]);
  const Lane lx(a.wi.x), ly(a.wi.y), lz(a.wi.z), hx(a.h.x), hy(a.h.y), hz(a.h.z);
  const Lane diffuse(a.diffuse), specular(a.specular);
  const auto one = [&](const float* px, const float* py, const float* pz, float* to) HWY_ATTR {
    const Lane x(hn::LoadU(d, px)), y(hn::LoadU(d, py)), z(hn::LoadU(d, pz));
    const Lane squared = mul_add(x, x, mul_add(y, y, z * z));
    const Lane inverse = Lane(1.0) / sqrt(squared);
    const Lane to_light = clamp_negative(mul_add(x, lx, mul_add(y, ly, z * lz))) * inverse;
    const Lane to_half = clamp_negative(mul_add(x, hx, mul_add(y, hy, z * hz)));
    // 1 - c first: one operation, and never negative by rounding.
    const Lane u = clamp_negative(neg_mul_add(to_half, inverse, Lane(1.0)));
    const Lane glossy = Form::value(Cosine<Lane>{Lane(1.0) - u, u}, k);
    hn::StoreU(mul_add(specular, glossy, diffuse * to_light).raw, d, to);
  };
  const std::size_t width = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + width <= a.count; i += width) one(a.x + i, a.y + i, a.z + i, out + i);
  if (i < a.count) {
    constexpr std::size_t kMax = hn::MaxLanes(D());
    std::array<float, kMax> x{}, y{}, z, to;
    z.fill(1);
    std::copy(a.x + i, a.x + a.count, x.begin());
    std::copy(a.y + i, a.y + a.count, y.begin());
    std::copy(a.z + i, a.z + a.count, z.begin());
    one(x.data(), y.data(), z.data(), to.data());
    std::copy(to.begin(), to.begin() + static_cast<std::ptrdiff_t>(a.count - i), out + i);
  }
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

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace burnish
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

void shade_blinn_phong(const BlinnPhong& material, const NormalSpans& normals, std::span<float> out) {
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
  // Their a comes from the near-exact power times the exponent.
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
