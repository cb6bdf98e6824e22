// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/baselines/separable_brdf.h>
#include <burnish/metrics/error_figures.h>

namespace burnish {

/// The cost of negative values in a sum of signed terms, measured on the pairs and pictures of a Scorer. There are
/// three ways to remove them: the sum clamped at 0 (as SeparableBrdf does), every table clamped at 0 (unsigned
/// textures without a bias), and a constant added that lifts the sum above 0.
struct NegativeLobes {
  double negative_share = 0;  ///< share of pairs and channels whose sum is below 0
  double bias = 0;            ///< what must be added to f, largest channel, 1/sr
  ErrorFigures sum_clamped, tables_clamped, biased;
};

NegativeLobes negative_lobes(const SeparableBrdf& brdf, const Scorer& scorer);

}  // namespace burnish
