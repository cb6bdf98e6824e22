// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <burnish/fitting/refinement/picture_loss.h>

namespace burnish {

/// The inputs of PictureLoss::add for many values, each an array of that many floats; a multiple of 8.
struct LossInputs {
  const float *first, *second;  ///< PictureLoss::target
  const float *model, *cos_theta_i;
  const float *picture_weight, *pair_weight;  ///< one of each two is 0
};

/// PictureLoss::add in single precision, for `count` values side by side: relative error 1e-5 of terms and
/// slopes where errors are not rounded off.
void add_losses(const PictureLoss& loss, const LossInputs& in, std::size_t count,
                const ErrorTerms& derivatives, ErrorTerms& sums, float* gradient, float* curvature) noexcept;

}  // namespace burnish
