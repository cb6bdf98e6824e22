// SPDX-License-Identifier: Apache-2.0
#include <set>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/power/choose.h>

namespace burnish {
namespace {

PowerChoice cheapest(double max_error, double lo, double hi) {
  PowerChoice best{lo, hi, PowerMethod::exact, 0};
  int least = power_info(PowerMethod::exact).cost.weight();
  for (const PowerInfo& info : power_methods())
    for (const PowerBound& b : info.bounds) {
      if (lo < b.min_exponent || hi > b.max_exponent || b.bound > max_error) continue;
      const int weight = info.cost.weight();
      if (weight < least || (weight == least && b.bound < best.bound)) {
        least = weight;
        best = {lo, hi, info.method, b.bound};
      }
    }
  return best;
}

}  // namespace

std::vector<PowerChoice> choose_power(double max_error, double min_exponent, double max_exponent) {
  if (!(max_error >= 0)) throw Error(fmt::format("largest error: expected at least 0, found {}", max_error));
  if (!(min_exponent >= 1 && min_exponent <= max_exponent && max_exponent <= kMaxExponent))
    throw Error(fmt::format("exponents: expected 1 <= first <= last <= {}, found {} to {}", kMaxExponent,
                            min_exponent, max_exponent));
  // c and c^2 are the parabola with a = 0 and a = 1.
  if (min_exponent == max_exponent && (min_exponent == 1 || min_exponent == 2))
    return {{min_exponent, max_exponent, PowerMethod::quadratic, 0}};

  // Between the ends of all proved ranges the candidates do not change.
  std::set<double> ends{min_exponent, max_exponent};
  for (const PowerInfo& info : power_methods())
    for (const PowerBound& b : info.bounds)
      for (double e : {b.min_exponent, b.max_exponent})
        if (e > min_exponent && e < max_exponent) ends.insert(e);

  std::vector<PowerChoice> choices;
  double lo = min_exponent;
  for (double hi : ends) {
    if (hi == lo && min_exponent != max_exponent) continue;
    const PowerChoice choice = cheapest(max_error, lo, hi);
    if (!choices.empty() && choices.back().method == choice.method) {
      choices.back().max_exponent = hi;
      choices.back().bound = std::max(choices.back().bound, choice.bound);
    } else {
      choices.push_back(choice);
    }
    lo = hi;
  }
  return choices;
}

}  // namespace burnish
