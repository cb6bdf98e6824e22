// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <burnish/power/fixed_point.h>

namespace burnish {

/// The arithmetic behind a SpecularUnit: one class per method. `c` and `v` are words of cosine_bits fraction bits, c
/// + v = 1; v stays below 1 where c = 0.
class UnitCore {
 public:
  virtual ~UnitCore() = default;
  virtual std::uint32_t value(std::uint32_t exponent, std::uint64_t c, std::uint64_t v) const noexcept = 0;
  virtual std::vector<UnitTable> tables() const { return {}; }
  virtual std::vector<UnitParameter> parameters() const { return {}; }
};

// Each throws Error for what its method cannot do.
std::unique_ptr<UnitCore> make_exact_core(const UnitConfig& config);
std::unique_ptr<UnitCore> make_paper_literal_core(const UnitConfig& config);
std::unique_ptr<UnitCore> make_paper_core(const UnitConfig& config);
std::unique_ptr<UnitCore> make_w8_core(const UnitConfig& config);
std::unique_ptr<UnitCore> make_two_piece_core(const UnitConfig& config);
std::unique_ptr<UnitCore> make_schlick_core(const UnitConfig& config);
std::unique_ptr<UnitCore> make_quadratics_core(const UnitConfig& config);

constexpr std::uint64_t power_of_two(int n) noexcept {
  return std::uint64_t{1} << n;
}

/// c cut or widened to `bits` fraction bits.
constexpr std::uint64_t rescale(std::uint64_t x, int from, int to) noexcept {
  return to >= from ? x << (to - from) : x >> (from - to);
}

}  // namespace burnish
