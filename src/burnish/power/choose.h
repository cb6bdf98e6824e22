// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <burnish/power/power.h>

namespace burnish {

/// The member to use over a range of exponents.
struct PowerChoice {
  double min_exponent, max_exponent;
  PowerMethod method;
  double bound;  ///< proved over this range, before rounding; 0 where the member is exact
};

/// The cheapest members (PowerCost::weight, then the smaller bound) whose proved error is at most
/// `max_error`, over consecutive ranges that cover [min_exponent, max_exponent]. Where nothing cheaper will
/// do, the power itself. Throws Error for max_error < 0 or exponents that are not 1 <= min <= max <= 1024.
std::vector<PowerChoice> choose_power(double max_error, double min_exponent, double max_exponent);

}  // namespace burnish
