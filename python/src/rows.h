// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/error.h>
#include <burnish/eval/interleaved.h>
#include <burnish/math/vec3.h>

#include "module.h"

namespace burnish::python {

template <class T>
using Array = nb::ndarray<T, nb::device::cpu>;

/// N vectors in a NumPy array, with any strides. A single vector stands for all rows.
template <class T>
struct Rows {
  T* data = nullptr;
  std::int64_t row = 0, component = 1;  // strides in elements
  std::size_t count = 0;
  bool one = false;  // a single vector, shape (K,)

  T* at(std::size_t i, std::size_t k) const noexcept {
    return data + static_cast<std::int64_t>(i) * row + static_cast<std::int64_t>(k) * component;
  }
  /// Returns true if each component lies in one piece, which kernels read and write in place.
  bool planes() const noexcept { return row == 1; }
  /// Returns true if rows of that width follow one another, NumPy's usual order.
  bool in_rows(std::size_t width) const noexcept {
    return component == 1 && row == static_cast<std::int64_t>(width);
  }
};

/// Reads shape (N, width) or (width,). Throws Error for another shape.
template <class T>
Rows<const T> rows_of(const Array<const T>& array, const char* name, std::size_t width) {
  const std::size_t n = array.ndim();
  if ((n != 1 && n != 2) || array.shape(n - 1) != width)
    throw Error(fmt::format("{}: expected shape (N, {}) or ({},), found ({}{})", name, width, width,
                            fmt::join(std::span(array.shape_ptr(), n), ", "), n == 1 ? "," : ""));
  if (n == 1) return {array.data(), 0, array.stride(0), 1, true};
  return {array.data(), array.stride(0), array.stride(1), array.shape(0), false};
}

/// Returns the common count of rows. Shapes (1, K) and (K,) stand for every row of the other. Throws Error if counts
/// differ.
template <class A, class B>
std::size_t match(Rows<A>& a, Rows<B>& b, const char* names) {
  if (a.count != b.count && a.count != 1 && b.count != 1)
    throw Error(fmt::format("{}: expected equal counts, found {} and {}", names, a.count, b.count));
  const std::size_t count = a.count == 1 ? b.count : a.count;
  if (a.count != count) a.row = 0;
  if (b.count != count) b.row = 0;
  return count;
}

/// Does the same for three arrays.
template <class A, class B, class C>
std::size_t match(Rows<A>& a, Rows<B>& b, Rows<C>& c, const char* names) {
  std::size_t count = 1;
  for (const std::size_t rows : {a.count, b.count, c.count}) {
    if (rows == 1) continue;
    if (count != 1 && rows != count)
      throw Error(
          fmt::format("{}: expected equal counts, found {}, {} and {}", names, a.count, b.count, c.count));
    count = rows;
  }
  if (a.count != count) a.row = 0;
  if (b.count != count) b.row = 0;
  if (c.count != count) c.row = 0;
  return count;
}

template <class T>
Vec3 vector_at(const Rows<const T>& rows, std::size_t i) noexcept {
  return {static_cast<double>(*rows.at(i, 0)), static_cast<double>(*rows.at(i, 1)),
          static_cast<double>(*rows.at(i, 2))};
}

/// Returns true for unit vectors to 1 %, the tolerance of readers of directions. Returns false for NaN.
inline bool is_direction(Vec3 w) noexcept {
  return std::abs(dot(w, w) - 1) < 0.02;
}

/// A result: `array` is the object for Python.
template <class T>
struct Result {
  nb::object array;
  Rows<T> rows;
};

/// Returns a new NumPy array of shape (count, width), in planes where the inputs are, or `out`, checked. With `width` 0
/// a row has one value, and the shape is (count,).
template <class T>
Result<T> make_result(const nb::object& out, std::size_t count, std::size_t width, bool planes) {
  nb::object array = out;
  const nb::tuple shape = width > 0 ? nb::make_tuple(count, width) : nb::make_tuple(count);
  if (out.is_none())
    array =
        nb::module_::import_("numpy").attr("empty")(shape, sizeof(T) == 4 ? "f4" : "f8", planes ? "F" : "C");
  Array<T> view;
  if (!nb::try_cast(array, view, false))
    throw nb::type_error(
        fmt::format("out: expected a writable array of {}", sizeof(T) == 4 ? "float32" : "float64").c_str());
  if (view.ndim() != shape.size() || view.shape(0) != count || (width > 0 && view.shape(1) != width))
    throw Error(fmt::format("out: expected shape {}, found ({})", nb::repr(shape).c_str(),
                            fmt::join(std::span(view.shape_ptr(), view.ndim()), ", ")));
  return {array, {view.data(), view.stride(0), width > 0 ? view.stride(1) : 0, count, false}};
}

/// The number of directions that go through buffers together.
inline constexpr std::size_t kBlock = 512;
using Buffer = float[kBlock];

/// Returns the first kWidth components of rows [begin, begin + count) as floats. They stay in place if each is in one
/// piece, else they are copied to `buffers`.
template <std::size_t kWidth, class T>
std::array<std::span<const float>, kWidth> components(const Rows<const T>& rows, std::size_t begin,
                                                      std::size_t count, Buffer* buffers) noexcept {
  std::array<std::span<const float>, kWidth> result;
  for (std::size_t k = 0; k < kWidth; ++k) result[k] = {buffers[k], count};
  if constexpr (std::is_same_v<T, float>) {
    if (rows.planes()) {
      for (std::size_t k = 0; k < kWidth; ++k) result[k] = {rows.at(begin, k), count};
      return result;
    }
    if (kWidth == 3 && rows.in_rows(3)) {
      to_planes(rows.at(begin, 0), count, buffers[0], buffers[1], buffers[2]);
      return result;
    }
  }
  for (std::size_t k = 0; k < kWidth; ++k)
    for (std::size_t i = 0; i < count; ++i) buffers[k][i] = static_cast<float>(*rows.at(begin + i, k));
  return result;
}

/// Returns rows [begin, begin + count), three components each, one after the other. They stay in place if they lie so,
/// else they are copied to `buffer`, which has 3 * kBlock floats.
inline std::span<const float> in_rows(const Rows<const float>& rows, std::size_t begin, std::size_t count,
                                      float* buffer) noexcept {
  if (rows.in_rows(3)) return {rows.at(begin, 0), 3 * count};
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 3; ++k) buffer[3 * i + k] = *rows.at(begin + i, k);
  return {buffer, 3 * count};
}

}  // namespace burnish::python
