// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/power/fixed_point_blinn.h>

namespace burnish {
namespace {

constexpr int kIndexFirst = 64;    // cells of 1/64 over [1, 4)
constexpr int kRestBits = 10;      // of the mantissa within a cell, as far as the slope uses them
constexpr int kStartBits = 17;     // fraction bits of the first 1/sqrt
constexpr int kSlopeBits = 10;     // of its fall over a cell
constexpr int kMantissaBits = 24;  // fraction bits of the mantissa in [1, 4)
constexpr int kRootBits = 26;      // fraction bits of 1/sqrt

std::int64_t dot(const FixedVec3& a, const FixedVec3& b) noexcept {
  return std::int64_t{a[0]} * b[0] + std::int64_t{a[1]} * b[1] + std::int64_t{a[2]} * b[2];
}

}  // namespace

FixedVec3 fixed_vec3(Vec3 v) noexcept {
  const auto word = [](double x) {
    return static_cast<std::int32_t>(std::lround(std::ldexp(x, kFixedVec3FractionBits)));
  };
  return {word(v.x), word(v.y), word(v.z)};
}

BlinnFront::BlinnFront(int versine_bits) : versine_bits_(versine_bits) {
  if (versine_bits < 12 || versine_bits > 24)
    throw Error(fmt::format("versine bits: expected 12 to 24, found {}", versine_bits));
  for (int i = kIndexFirst; i < 256; ++i) {
    const double begin = i / 64.0, end = (i + 1) / 64.0;
    const double fall = 1 / std::sqrt(begin) - 1 / std::sqrt(end);
    const double sag = (1 / std::sqrt(begin) + 1 / std::sqrt(end)) / 2 - 1 / std::sqrt((begin + end) / 2);
    const auto cell = static_cast<std::size_t>(i);
    start_[cell] =
        static_cast<std::uint32_t>(std::lround(std::ldexp(1 / std::sqrt(begin) - sag / 2, kStartBits)));
    slope_[cell] = static_cast<std::uint32_t>(std::lround(std::ldexp(fall, kStartBits)));
  }
}

std::uint32_t BlinnFront::versine(const FixedVec3& n, const FixedVec3& l, const FixedVec3& v) const noexcept {
  const FixedVec3 h = {l[0] + v[0], l[1] + v[1], l[2] + v[2]};
  const std::int64_t nh = dot(n, h);
  // |n|^2 |h|^2 with 48 fraction bits as m 4^k, m in [1, 4)
  const auto q = static_cast<std::uint64_t>(dot(n, n) >> 8) * static_cast<std::uint64_t>(dot(h, h) >> 8);
  if (q == 0) return 0;
  if (nh <= 0) return 1U << versine_bits_;
  const int k = (std::bit_width(q) - 1) / 2;
  const std::uint64_t m =
      2 * k >= kMantissaBits ? q >> (2 * k - kMantissaBits) : q << (kMantissaBits - 2 * k);

  // 1/sqrt(m): table with slopes to 2^-15, then one step of Newton
  const std::uint64_t cell = m >> 18, rest = (m >> 8) & ((1U << kRestBits) - 1);
  const std::uint64_t root = start_[cell] - ((slope_[cell] * rest) >> kRestBits);
  const std::uint64_t square = (root * root) >> 8;  // 26 fraction bits
  const std::int64_t off =
      (std::int64_t{1} << 28) - static_cast<std::int64_t>((m * square) >> 22);  // 1 - m root^2
  const std::int64_t fine = (static_cast<std::int64_t>(root) << (kRootBits - kStartBits)) +
                            ((static_cast<std::int64_t>(root) * off) >> (kStartBits + 28 + 1 - kRootBits));

  // n.h 2^(24 - k) with 26 fraction bits, below 2 by Cauchy and Schwarz
  const auto scaled = static_cast<std::uint64_t>(k >= 18 ? nh >> (k - 18) : nh << (18 - k));
  const std::uint64_t cosine =
      (scaled * static_cast<std::uint64_t>(fine)) >> (2 * kRootBits - versine_bits_ - 1);
  const std::uint64_t rounded = (cosine + 1) >> 1, one = std::uint64_t{1} << versine_bits_;
  return static_cast<std::uint32_t>(one - std::min(rounded, one));
}

UnitTable BlinnFront::table() const {
  UnitTable table{"rsqrt", kStartBits + 1 + kSlopeBits, {}};
  for (std::size_t i = 0; i < start_.size(); ++i)
    table.words.push_back(std::uint64_t{start_[i]} << kSlopeBits | slope_[i]);
  return table;
}

}  // namespace burnish
