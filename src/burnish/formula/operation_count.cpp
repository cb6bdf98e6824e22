// SPDX-License-Identifier: Apache-2.0
#include <burnish/formula/operation_count.h>

namespace burnish {

OperationCount& OperationCount::operator+=(const OperationCount& other) noexcept {
  multiplies += other.multiplies;
  adds += other.adds;
  compares += other.compares;
  divisions += other.divisions;
  roots += other.roots;
  transcendentals += other.transcendentals;
  fetches += other.fetches;
  return *this;
}

OperationCount count_of(Op op, ValueType type) noexcept {
  if (type == ValueType::integer && op != Op::element) return {};
  const int n = type == ValueType::vector ? 3 : 1;
  switch (op) {
    case Op::constant:
    case Op::input:
    case Op::negate:
    case Op::abs:
    case Op::vector:
    case Op::component:
    case Op::to_integer:
    case Op::to_real:
    case Op::call:
      return {};
    case Op::add:
    case Op::subtract:
      return {.adds = n};
    case Op::multiply:
    case Op::scale_by_two:
      return {.multiplies = n};
    case Op::mul_add:
    case Op::neg_mul_add:
      return {.multiplies = n, .adds = n};
    case Op::divide:
      return {.divisions = n};
    case Op::max:
    case Op::min:
    case Op::floor:
    case Op::exponent_of:
    case Op::if_less:
      return {.compares = n};
    case Op::sqrt:
      return {.roots = n};
    case Op::power:
    case Op::exp2:
    case Op::log2:
    case Op::acos:
    case Op::cos:
    case Op::sin:
      return {.transcendentals = n};
    case Op::element:
    case Op::texel:
    case Op::sample:
      return {.fetches = 1};
  }
  return {};
}

}  // namespace burnish
