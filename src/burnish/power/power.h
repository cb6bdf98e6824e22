// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace burnish {

/// The approximations of cos^exponent. The formulas are in forms-inl.h, each once for all number types.
enum class PowerMethod {
  exact,
  schlick,
  lyon,
  angle2,
  angle4,
  angle8,
  angle16,
  quadratic_raw,
  quadratic,
  w2,
  w4,
  w8,
  w16,
  two_piece,
  two_piece_paper,
  cubic2,
  cubic4,
  rational,
  rational2,
  rational4,
  gaussian,
  gaussian2,
  near_exact,
};
inline constexpr int kPowerMethods = static_cast<int>(PowerMethod::near_exact) + 1;

/// The cost of one value once the coefficients are known, counted from the formula itself.
struct PowerCost {
  int multiplies = 0, adds = 0, compares = 0, divisions = 0, roots = 0, transcendentals = 0;
  int table_words = 0;  ///< coefficients that depend on the exponent
  /// One figure to order members by:
  /// multiplies + adds + compares + 5 divisions + 5 roots + 20 transcendentals.
  int weight() const noexcept {
    return multiplies + adds + compares + 5 * divisions + 5 * roots + 20 * transcendentals;
  }
};

/// |approximation - cos^exponent| <= bound for all cosines in [0, 1] and all real exponents of the range, of
/// the formula in exact arithmetic. prove_power_bound() proves it.
struct PowerBound {
  double min_exponent, max_exponent, bound;
};

struct PowerInfo {
  PowerMethod method;
  std::string_view name;     ///< as on the command line
  std::string_view formula;  ///< plain text, u = 1 - c
  std::string_view source;   ///< key of references.bib, or "burnish"
  /// Rising in the cosine over all exponents from this one up; none where it is not.
  std::optional<double> monotone_from;
  /// Disjoint or nested ranges, the widest first; its ends are the exponents the member may be used for.
  std::vector<PowerBound> bounds;
  PowerCost cost;

  double min_exponent() const noexcept { return bounds.front().min_exponent; }
  double max_exponent() const noexcept { return bounds.front().max_exponent; }
};

inline constexpr double kMaxExponent = 1024;
/// The float kernels of PowerMethod::exact are within this of the power, in units of the last place of a float.
/// proved_exact_ulps() proves it.
inline constexpr double kExactUlps = 0.6;

/// All members, in the order of PowerMethod.
std::span<const PowerInfo> power_methods();
const PowerInfo& power_info(PowerMethod method);
/// Throws Error naming the known members.
PowerMethod power_method(std::string_view name);

/// The member's smallest proved bound that holds at this exponent. Throws Error outside its range.
double power_bound(PowerMethod method, double exponent);

/// Coefficients of a member at one exponent; the meaning of each is in forms-inl.h.
struct PowerCoefficients {
  PowerMethod method = PowerMethod::exact;
  int count = 0;
  std::array<double, 6> k{};
};

/// Domain: exponent in the member's range. Throws Error outside it, NaN included.
PowerCoefficients power_coefficients(PowerMethod method, double exponent);

/// The definition all other code is tested against. Domain: cosine in [0, 1]. Allocates nothing.
double power(const PowerCoefficients& coefficients, double cosine) noexcept;

/// power(power_coefficients(method, exponent), cosine).
double power(PowerMethod method, double cosine, double exponent);

/// Coefficient a(e) of the paper's parabola a c^2 + (1 - a) c. Domain: exponent >= 1; a(1) = 0, a(2) = 1,
/// a / e -> 2 (1 - e^(-1/2)) = 0.7869. Relative error 1e-14. Source: [QuadraticBrdf, eq. 7].
double quadratic_coefficient(double exponent) noexcept;

/// 2 (1 - e^(-1/2)) exponent - 1/2: a(e) without a table, within 0.15 / exponent for exponents in [2, 1024].
double quadratic_coefficient_affine(double exponent) noexcept;

/// Integral over the cosine from 0 to 1 (the solid angle integral over 2 pi); the power itself has 1/(e+1).
/// Relative error 1e-7.
double power_integral(PowerMethod method, double exponent);

/// Factor that gives the member the energy of the power: 1 / ((exponent + 1) power_integral()), so that a
/// material keeps its brightness when its power is replaced.
double power_normalization(PowerMethod method, double exponent);

/// Largest |approximation / power - 1| where the power is at least `level`, found by sampling.
/// Domain: level in (0, 1]. The paper's figure 3 is this at level 0.56.
double max_relative_error(PowerMethod method, double exponent, double level);

/// Largest |approximation - power| over cosines in [0, 1] at one exponent, found by sampling.
double max_absolute_error(PowerMethod method, double exponent);

}  // namespace burnish
