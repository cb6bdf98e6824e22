// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/power/power.h>

namespace burnish {

// The specular unit of hw/ as integer arithmetic: what hw/rtl computes, bit for bit, without its clock.

enum class UnitMethod {
  exact,          ///< 2^(e log2 c) from two small tables
  paper_literal,  ///< a (c^2 - c) + c, the paper's figure 1
  paper,          ///< the same parabola as c max(0, 1 - a v)
  w8,             ///< max(0, 1 - k v)^8
  two_piece,      ///< max(0, m - n s)^2 + o, s = e v, with small tables of m, n and o
  schlick,        ///< c / (c + e v), with a divider
  quadratics,     ///< 2^(e log2 c) as graphics processors form it: both functions as 64 quadratics
};

enum class UnitInput {
  cosine,   ///< c in steps of 2^-cosine_bits
  versine,  ///< v = 1 - c = |n - h|^2 / 2 in steps of 2^-cosine_bits
};

struct UnitInfo {
  UnitMethod method;
  std::string_view name;     ///< on the command line; the module is burnish_NAME
  std::string_view formula;  ///< v = 1 - c
  PowerMethod definition;    ///< what it computes, in double precision
  int min_depth, max_depth;  ///< clocks from input to output that its pipeline can be set to
  int coefficient_bits;      ///< unless asked otherwise
  /// From this exponent on a cosine of 0 gives 0; below it the definition itself is not 0 there.
  int zero_from;
  /// From this exponent on the output never falls as the cosine rises. Below it two roundings of
  /// paper_literal cross.
  int monotone_from;
};

inline constexpr int kUnitMaxExponent = 1023;  ///< ten bits

struct UnitConfig {
  UnitMethod method = UnitMethod::exact;
  UnitInput input = UnitInput::cosine;
  int cosine_bits =
      15;  ///< fraction bits of the input, 12 to 24 (exact: output_bits + 12), output_bits + 5 (2) or more
  int coefficient_bits = 0;  ///< width of a coefficient (PROM word), 12 to 24; 0: the method's. exact: 16
  int output_bits = 8;       ///< 8 to 12; the output over 2^output_bits - 1 is the value
  int depth = 0;             ///< pipeline stages; 0: the fewest
};

/// Contents of a table as the hardware reads it.
struct UnitTable {
  std::string name;
  int width;  ///< bits a word
  std::vector<std::uint64_t> words;
};

/// A parameter of the SystemVerilog module beyond those of UnitConfig.
struct UnitParameter {
  std::string name;
  std::int64_t value;
};

std::span<const UnitInfo> unit_methods();
const UnitInfo& unit_info(UnitMethod method);
/// Throws Error naming the known units.
UnitMethod unit_method(std::string_view name);

/// min(floor(a b / 2^drop), 2^bits - 1), and whether that cut it: what hw/rtl/burnish_product.sv computes.
struct UnitProduct {
  std::uint64_t value;
  bool overflow;
};
constexpr UnitProduct unit_product(std::uint64_t a, std::uint64_t b, int drop, int bits) noexcept {
  const std::uint64_t product = (a * b) >> drop, limit = (std::uint64_t{1} << bits) - 1;
  return product > limit ? UnitProduct{limit, true} : UnitProduct{product, false};
}

/// z / 2^fraction_bits in [0, 1] as a whole number of 1 / (2^output_bits - 1), rounded: within 0.5 + 2^-4 for
/// fraction_bits = output_bits + 4. hw/rtl/burnish_scale.sv computes the same.
constexpr std::uint32_t unit_scale(std::uint64_t z, int fraction_bits, int output_bits) noexcept {
  const std::uint64_t half = std::uint64_t{1} << (fraction_bits - output_bits - 1);
  return static_cast<std::uint32_t>((z + half - (z >> output_bits)) >> (fraction_bits - output_bits));
}

class UnitCore;

/// One unit: its tables and its function. Copies share the tables.
class SpecularUnit {
 public:
  /// Throws Error naming the field that is outside its domain.
  explicit SpecularUnit(const UnitConfig& config);

  /// The output word. Domain: exponent in [1, 1023], input in [0, 2^cosine_bits] (what lies above counts as
  /// 2^cosine_bits). 2^output_bits - 1 at c = 1, 0 at c = 0 from the exponent UnitInfo::zero_from on, never
  /// falling as c rises from monotone_from on. Allocates nothing.
  std::uint32_t value(std::uint32_t exponent, std::uint32_t input) const noexcept;

  /// Returns the configuration that was asked for, with the defaults filled in.
  const UnitConfig& config() const noexcept { return config_; }
  std::vector<UnitTable> tables() const;
  std::vector<UnitParameter> parameters() const;

  /// The cosine that an input word stands for, in [0, 1].
  double cosine(std::uint32_t input) const noexcept;
  /// The input word nearest to a cosine in [0, 1].
  std::uint32_t input(double cosine) const noexcept;

 private:
  UnitConfig config_;
  std::shared_ptr<const UnitCore> core_;
};

/// The error of a unit against c^e over every exponent of a range (by steps) and every input (by steps), in units of
/// its last place. `correct` is the share of outputs that are c^e correctly rounded.
struct UnitError {
  double max_error = 0, correct = 0;
  int worst_exponent = 0;
  std::uint32_t worst_input = 0;
  std::uint64_t vectors = 0, falls = 0;  ///< falls: outputs below their neighbour at the next smaller cosine
};
UnitError measure_unit_error(const SpecularUnit& unit, int min_exponent = 1, int max_exponent = 1000,
                             std::uint32_t input_step = 1, int exponent_step = 1);

/// Largest difference, in units of the last place, between the unit's output for the input word nearest to a
/// cosine and c^exponent of that very cosine, over `points` cosines evenly spread where exponent (1 - c) <=
/// 12: what rounding the input costs is in it.
double measure_rounded_input_error(const SpecularUnit& unit, int exponent, int points = 1 << 20);

}  // namespace burnish
