// SPDX-License-Identifier: Apache-2.0
// Maps a position along a table's axis to nodes and weights. Each formula is written once, for the number types and
// with the functions of parameterization/projection-inl.h, and
//   whole(x)   the integer part of x >= 0, as a number
// No include guard: see there.

/// The cell of nodes 0 to `last` that a position, in cells, falls into: its first node and how far; the last
/// cell takes the last node.
template <class T>
struct Cell {
  T node, fraction;
};
template <class T>
FORMULA_INLINE Cell<T> cell_of(const T& position, const T& last) {
  const T at = named("u", min(max(position, T(0.0)), last));
  const T node = named("base", min(whole(at), last - T(1.0)));
  return {node, named("f", at - node)};
}

/// Interpolates linearly between two values.
template <class V, class T>
FORMULA_INLINE V mix(const V& low, const V& high, const T& fraction) {
  return named("value", mul_add(fraction, high - low, low));
}
