// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <burnish/power/power.h>

namespace burnish {

/// Outcome of a proof by subdivision.
struct BoundProof {
  bool proved = false;
  std::size_t boxes = 0;  ///< boxes examined
  double attained = 0;    ///< largest error met at a box's middle: the bound cannot be below this
};

/// Proves |member - cos^exponent| <= range.bound for all cosines in [0, 1] and all real exponents of the
/// range by interval arithmetic over boxes in s = e (1 - c) and v = 1 / e, halved until each keeps the bound.
/// A false `proved` means that the bound fails or that `max_boxes` did not suffice.
BoundProof prove_power_bound(PowerMethod method, const PowerBound& range, std::size_t max_boxes = 4'000'000);

/// Proves that the member never falls as the cosine rises, for all exponents from min_exponent to
/// max_exponent, the same way from the derivative's interval. `attained` is the largest derivative by s met.
BoundProof prove_power_monotone(PowerMethod method, double min_exponent, double max_exponent,
                                std::size_t max_boxes = 4'000'000);

/// Proves |a(e) - (2 (1 - e^(-1/2)) e - 1/2)| <= factor / e for all e in [min_exponent, max_exponent].
BoundProof prove_affine_coefficient(double min_exponent, double max_exponent, double factor);

/// Largest error of the float kernels of PowerMethod::exact (power_span) in units of the last place, for every float
/// cosine in [0, 1] and every exponent in [1, 1024]. The logarithm is examined at each of the 2^23 mantissas that a float
/// can have, the power of two on a grid with a bound of its slope, roundings are counted. Takes about a second.
double proved_exact_ulps();

}  // namespace burnish
