// SPDX-License-Identifier: Apache-2.0
#include <burnish/fitting/refinement/picture_loss_lanes.h>

#define HWY_TARGET_INCLUDE "burnish/fitting/refinement/picture_loss_lanes.cpp"
#include <burnish/math/highway-inl.h>
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

using D = hn::CappedTag<float, 8>;
using V = hn::Vec<D>;

V number(double v) {
  return hn::Set(D(), static_cast<float>(v));
}

// The sums of errors, slope and curvature of a vector of values.
struct Part {
  V pictures, dimmed, relative, log_cos, absolute;  // of ErrorTerms
  V gradient, curvature;
};

void add_pictures(const PictureLoss& loss, const ErrorTerms& derivatives, V target, V lit, V weight,
                  Part& part) {
  const D d;
  // This is PictureLoss::add for pixels: (exposure f cos theta_i)^(1/2.2) by logarithm and exponential.
  const V one = number(1), gamma = number(PictureLoss::kInverseGamma);
  const V shown = hn::Max(hn::Mul(lit, number(loss.exposure)), number(1e-30));
  const V modelled = hn::Exp(d, hn::Mul(gamma, hn::Log(d, shown)));
  for (std::size_t e = 0; e < PictureLoss::kDim.size(); ++e) {
    const V dim = number(PictureLoss::kDim[e]);
    const V a = hn::Mul(target, dim), b = hn::Mul(modelled, dim);
    const V error = hn::Sub(hn::Min(b, one), hn::Min(a, one));
    V& term = e == 0 ? part.pictures : part.dimmed;
    const double derivative = e == 0 ? derivatives.pictures : derivatives.dimmed;
    const V share = hn::Mul(weight, number(e == 0 ? 1 : 0.5)), slope = hn::Mul(share, number(2 * derivative));
    const auto white = hn::Gt(b, one);
    // If both are white, dimmer exposures tell them apart.
    const V rise =
        hn::IfThenZeroElse(hn::And(hn::Ge(b, one), hn::Ge(a, one)),
                           hn::Mul(gamma, hn::IfThenElse(white, number(PictureLoss::kSaturatedSlope), b)));
    term = hn::MulAdd(share, hn::Mul(error, error), term);
    part.gradient = hn::MulAdd(slope, hn::Mul(error, rise), part.gradient);
    part.curvature = hn::MulAdd(slope, hn::Mul(rise, rise), part.curvature);
  }
}

void add_absolute(V error, V rise, double round, V weight, double derivative, V& term, Part& part) {
  // size - round is written as error^2 / (size + round), which does not cancel for small errors in floats.
  const V square = hn::Mul(error, error), rounding = number(round);
  const V size = hn::Sqrt(hn::MulAdd(rounding, rounding, square));
  term = hn::MulAdd(weight, hn::Div(square, hn::Add(size, rounding)), term);
  const V over = hn::Div(hn::Mul(hn::Mul(weight, number(derivative)), rise), size);
  part.gradient = hn::MulAdd(over, error, part.gradient);
  part.curvature = hn::MulAdd(over, rise, part.curvature);
}

void add_pairs(const ErrorTerms& derivatives, V first, V second, V model, V lit, V weight, Part& part) {
  const D d;
  // This is PictureLoss::add for pairs: the errors of ln(f + 1e-3), of ln(1 + f cos theta_i) and of f.
  const V raised = hn::Add(model, number(PictureLoss::kFloor)), brighter = hn::Add(lit, number(1));
  add_absolute(hn::Sub(hn::Log(d, raised), first), hn::Div(model, raised), PictureLoss::kRelativeRound,
               weight, derivatives.relative, part.relative, part);
  add_absolute(hn::Sub(hn::Log1p(d, lit), second), hn::Div(lit, brighter), PictureLoss::kLogCosRound, weight,
               derivatives.log_cos, part.log_cos, part);

  // The curvature takes max(f^, f), so that a model far below steps by no more than the ratio. In lanes of pixels
  // `first` is no logarithm and is set to 0.
  const V log_f = hn::IfThenElseZero(hn::Gt(weight, hn::Zero(d)), first);
  const V f = hn::Sub(hn::Exp(d, log_f), number(PictureLoss::kFloor)), error = hn::Sub(model, f);
  part.absolute = hn::MulAdd(weight, hn::Mul(error, error), part.absolute);
  const V slope = hn::Mul(hn::Mul(weight, number(2 * derivatives.absolute)), model);
  part.gradient = hn::MulAdd(slope, error, part.gradient);
  part.curvature = hn::MulAdd(slope, hn::Max(model, f), part.curvature);
}

void add(const PictureLoss& loss, const LossInputs& in, std::size_t count, const ErrorTerms& derivatives,
         ErrorTerms& sums, float* gradient, float* curvature) {
  const D d;
  const V zero = hn::Zero(d);
  Part part{zero, zero, zero, zero, zero, zero, zero};
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V model = hn::LoadU(d, in.model + i), lit = hn::Mul(model, hn::LoadU(d, in.cos_theta_i + i));
    const V first = hn::LoadU(d, in.first + i), second = hn::LoadU(d, in.second + i);
    const V pictures = hn::LoadU(d, in.picture_weight + i), pairs = hn::LoadU(d, in.pair_weight + i);
    part.gradient = part.curvature = zero;
    if (!hn::AllFalse(d, hn::Gt(pictures, zero))) add_pictures(loss, derivatives, first, lit, pictures, part);
    if (!hn::AllFalse(d, hn::Gt(pairs, zero))) add_pairs(derivatives, first, second, model, lit, pairs, part);
    hn::StoreU(part.gradient, d, gradient + i);
    hn::StoreU(part.curvature, d, curvature + i);
  }
  const auto sum_of = [d](V lanes)
                          HWY_ATTR { return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, lanes))); };
  sums += {.pictures = sum_of(part.pictures),
           .dimmed = sum_of(part.dimmed),
           .relative = sum_of(part.relative),
           .log_cos = sum_of(part.log_cos),
           .absolute = sum_of(part.absolute)};
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

HWY_EXPORT(add);

void add_losses(const PictureLoss& loss, const LossInputs& in, std::size_t count,
                const ErrorTerms& derivatives, ErrorTerms& sums, float* gradient, float* curvature) noexcept {
  HWY_DYNAMIC_DISPATCH(add)(loss, in, count, derivatives, sums, gradient, curvature);
}

}  // namespace burnish
#endif
