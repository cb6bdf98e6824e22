// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/closest_name.h>
#include <burnish/power/fixed_point.h>
#include <burnish/power/fixed_point_core.h>

namespace burnish {
namespace {

constexpr std::array kInfos = {
    UnitInfo{UnitMethod::exact, "exact", "2^(e log2 c)", PowerMethod::exact, 3, 20, 16, 1, 1},
    UnitInfo{UnitMethod::paper_literal, "paper_literal", "a (c^2 - c) + c, clamped", PowerMethod::quadratic,
             3, 8, 16, 1, 4},
    UnitInfo{UnitMethod::paper, "paper", "c max(0, 1 - a v)", PowerMethod::quadratic, 3, 8, 16, 1, 1},
    UnitInfo{UnitMethod::w8, "w8", "max(0, 1 - k v)^8", PowerMethod::w8, 2, 11, 16, 5, 1},
    UnitInfo{UnitMethod::two_piece, "two_piece", "max(0, m - n e v)^2 + o", PowerMethod::two_piece, 2, 9, 12,
             1, 1},
    UnitInfo{UnitMethod::schlick, "schlick", "c / (c + e v)", PowerMethod::schlick, 2, 13, 12, 1, 1},
    UnitInfo{UnitMethod::quadratics, "quadratics", "2^(e log2 c), quadratics", PowerMethod::exact, 3, 16, 16,
             1, 1024},
};

void check(const char* what, int value, int min, int max) {
  if (value < min || value > max)
    throw Error(fmt::format("{}: expected {} to {}, found {}", what, min, max, value));
}

std::unique_ptr<UnitCore> make_core(const UnitConfig& config) {
  switch (config.method) {
    case UnitMethod::exact:
      return make_exact_core(config);
    case UnitMethod::paper_literal:
      return make_paper_literal_core(config);
    case UnitMethod::paper:
      return make_paper_core(config);
    case UnitMethod::w8:
      return make_w8_core(config);
    case UnitMethod::two_piece:
      return make_two_piece_core(config);
    case UnitMethod::schlick:
      return make_schlick_core(config);
    case UnitMethod::quadratics:
      return make_quadratics_core(config);
  }
  throw Error("hardware method: unknown");
}

}  // namespace

std::span<const UnitInfo> unit_methods() {
  return kInfos;
}

const UnitInfo& unit_info(UnitMethod method) {
  return kInfos[static_cast<std::size_t>(method)];
}

UnitMethod unit_method(std::string_view name) {
  std::vector<std::string_view> known;
  for (const UnitInfo& info : kInfos) {
    if (info.name == name) return info.method;
    known.push_back(info.name);
  }
  throw Error("hardware method: " + expected_one_of(known, name));
}

SpecularUnit::SpecularUnit(const UnitConfig& config) : config_(config) {
  const UnitInfo& info = unit_info(config.method);
  if (config_.depth == 0) config_.depth = info.min_depth;
  if (config_.coefficient_bits == 0) config_.coefficient_bits = info.coefficient_bits;
  const bool exact = config.method == UnitMethod::exact || config.method == UnitMethod::quadratics;
  check("output bits", config.output_bits, 8, 12);
  check("cosine bits", config.cosine_bits, std::max(12, config.output_bits + (exact ? 2 : 5)),
        exact ? config.output_bits + 12 : 24);
  check("coefficient bits", config_.coefficient_bits, exact ? 16 : 12, exact ? 16 : 24);
  check("pipeline depth", config_.depth, info.min_depth, info.max_depth);
  core_ = make_core(config_);
}

std::uint32_t SpecularUnit::value(std::uint32_t exponent, std::uint32_t input) const noexcept {
  const std::uint64_t one = power_of_two(config_.cosine_bits);
  const std::uint64_t x = std::min<std::uint64_t>(input, one);
  const std::uint64_t c = config_.input == UnitInput::cosine ? x : one - x;
  return core_->value(exponent, c, std::min(one - c, one - 1));
}

std::vector<UnitTable> SpecularUnit::tables() const {
  return core_->tables();
}

std::vector<UnitParameter> SpecularUnit::parameters() const {
  return core_->parameters();
}

double SpecularUnit::cosine(std::uint32_t input) const noexcept {
  const double x = std::ldexp(static_cast<double>(input), -config_.cosine_bits);
  return config_.input == UnitInput::cosine ? x : 1 - x;
}

std::uint32_t SpecularUnit::input(double cosine) const noexcept {
  const double x = config_.input == UnitInput::cosine ? cosine : 1 - cosine;
  return static_cast<std::uint32_t>(std::lround(std::ldexp(x, config_.cosine_bits)));
}

UnitError measure_unit_error(const SpecularUnit& unit, int min_exponent, int max_exponent,
                             std::uint32_t input_step, int exponent_step) {
  const double scale = static_cast<double>((1U << unit.config().output_bits) - 1);
  const std::uint32_t one = 1U << unit.config().cosine_bits;
  const bool versine = unit.config().input == UnitInput::versine;
  UnitError error;
  std::uint64_t correct = 0;
  for (int exponent = min_exponent; exponent <= max_exponent; exponent += exponent_step) {
    std::uint32_t previous = 0;
    for (std::uint64_t distance = 0; distance <= one; distance += input_step) {
      // from c = 1 downwards
      const auto input = static_cast<std::uint32_t>(versine ? distance : one - distance);
      const std::uint32_t value = unit.value(static_cast<std::uint32_t>(exponent), input);
      const double exact = scale * std::pow(unit.cosine(input), exponent);
      const double off = std::abs(value - exact);
      if (off > error.max_error) {
        error.max_error = off;
        error.worst_exponent = exponent;
        error.worst_input = input;
      }
      correct += off <= 0.5;
      ++error.vectors;
      if (distance > 0) error.falls += value > previous;
      previous = value;
    }
  }
  error.correct = static_cast<double>(correct) / static_cast<double>(error.vectors);
  return error;
}

double measure_rounded_input_error(const SpecularUnit& unit, int exponent, int points) {
  // cosines that the input's format does not have, in the highlight
  const double scale = static_cast<double>((1U << unit.config().output_bits) - 1);
  double largest = 0;
  for (int i = 0; i < points; ++i) {
    const double cosine = 1 - std::min(1.0, 12.0 / exponent) * i / points;
    const std::uint32_t value = unit.value(static_cast<std::uint32_t>(exponent), unit.input(cosine));
    largest = std::max(largest, std::abs(value - scale * std::pow(cosine, exponent)));
  }
  return largest;
}

}  // namespace burnish
