// SPDX-License-Identifier: Apache-2.0
#pragma once

// This header adds C++20 that the library uses and that libc++ 13 lacks, which Debian 12 has with Emscripten. It has
// algorithms of std::ranges, bit_cast, and numbers as text. The reading of numbers is missing in libc++ 19 of Debian 13
// too. CMakeLists.txt includes the header before everything. With a newer libc++ it is empty.
#include <version>

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 200000

#include <charconv>
#include <type_traits>

#include <fast_float/fast_float.h>

namespace std {

template <class T>
requires is_floating_point_v<T> from_chars_result from_chars(const char* begin, const char* end, T& value)
noexcept {
  const auto [stop, error] = fast_float::from_chars(begin, end, value);
  return {stop, error};
}

}  // namespace std

#endif

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 15000

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <utility>

namespace std {

template <class To, class From>
requires(sizeof(To) == sizeof(From)) constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

inline bool operator==(const from_chars_result& a, const from_chars_result& b) noexcept {
  return a.ptr == b.ptr && a.ec == b.ec;
}

/// Writes the fewest digits that read back as the value.
template <class T>
requires is_floating_point_v<T> to_chars_result to_chars(char* begin, char* end, T value, chars_format)
noexcept {
  char text[40];
  int size = 0;
  for (int digits = 0; digits <= 17; ++digits) {
    size = snprintf(text, sizeof(text), "%.*e", digits, static_cast<double>(value));
    if (static_cast<T>(strtod(text, nullptr)) == value) break;
  }
  if (end - begin < size) return {end, errc::value_too_large};
  memcpy(begin, text, static_cast<size_t>(size));
  return {begin + size, errc{}};
}

namespace ranges {

template <class R, class F>
constexpr auto for_first(R&& range, F&& is) {
  auto at = std::begin(range);
  while (at != std::end(range) && !is(*at)) ++at;
  return at;
}

template <class R, class T, class P = identity>
constexpr auto find(R&& range, const T& value, P project = {}) {
  return ranges::for_first(range, [&](auto&& x) { return std::invoke(project, x) == value; });
}

template <class R, class F, class P = identity>
constexpr auto find_if(R&& range, F is, P project = {}) {
  return ranges::for_first(range, [&](auto&& x) { return std::invoke(is, std::invoke(project, x)); });
}

template <class R, class F, class P = identity>
constexpr bool any_of(R&& range, F is, P project = {}) {
  return ranges::find_if(range, is, project) != std::end(range);
}

template <class R, class F, class P = identity>
constexpr bool none_of(R&& range, F is, P project = {}) {
  return !ranges::any_of(range, is, project);
}

template <class R, class F, class P = identity>
constexpr bool all_of(R&& range, F is, P project = {}) {
  return ranges::none_of(
      range, [&](auto&& x) { return !std::invoke(is, x); }, project);
}

template <class R, class F, class P = identity>
constexpr ptrdiff_t count_if(R&& range, F is, P project = {}) {
  ptrdiff_t n = 0;
  for (auto&& x : range) n += std::invoke(is, std::invoke(project, x)) ? 1 : 0;
  return n;
}

template <class R, class T, class P = identity>
constexpr ptrdiff_t count(R&& range, const T& value, P project = {}) {
  return ranges::count_if(
      range, [&](auto&& x) { return x == value; }, project);
}

template <class R, class T>
constexpr void fill(R&& range, const T& value) {
  std::fill(std::begin(range), std::end(range), value);
}

template <class R, class F>
constexpr void generate(R&& range, F make) {
  std::generate(std::begin(range), std::end(range), make);
}

template <class R, class O>
constexpr void copy(R&& range, O to) {
  std::copy(std::begin(range), std::end(range), to);
}

template <class R, class O>
constexpr void move(R&& range, O to) {
  std::move(std::begin(range), std::end(range), to);
}

template <class R, class O, class F>
constexpr void transform(R&& range, O to, F f) {
  std::transform(std::begin(range), std::end(range), to, f);
}

template <class C, class P>
constexpr auto by(C& compare, P& project) {
  return [&](auto&& a, auto&& b) {
    return static_cast<bool>(std::invoke(compare, std::invoke(project, a), std::invoke(project, b)));
  };
}

template <class R, class C = std::less<>, class P = identity>
constexpr void sort(R&& range, C compare = {}, P project = {}) {
  std::sort(std::begin(range), std::end(range), ranges::by(compare, project));
}

template <class R, class C = std::less<>, class P = identity>
constexpr void stable_sort(R&& range, C compare = {}, P project = {}) {
  std::stable_sort(std::begin(range), std::end(range), ranges::by(compare, project));
}

template <class R, class I>
constexpr void nth_element(R&& range, I nth) {
  std::nth_element(std::begin(range), nth, std::end(range));
}

template <class R, class C = std::less<>, class P = identity>
constexpr auto min_element(R&& range, C compare = {}, P project = {}) {
  return std::min_element(std::begin(range), std::end(range), ranges::by(compare, project));
}

template <class R, class C = std::less<>, class P = identity>
constexpr auto max_element(R&& range, C compare = {}, P project = {}) {
  return std::max_element(std::begin(range), std::end(range), ranges::by(compare, project));
}

template <class R, class C = std::less<>, class P = identity>
constexpr auto min(R&& range, C compare = {}, P project = {}) {
  return *ranges::min_element(range, compare, project);
}

template <class R, class C = std::less<>, class P = identity>
constexpr auto max(R&& range, C compare = {}, P project = {}) {
  return *ranges::max_element(range, compare, project);
}

template <class R, class T>
constexpr auto lower_bound(R&& range, const T& value) {
  return std::lower_bound(std::begin(range), std::end(range), value);
}

template <class R, class T>
constexpr auto upper_bound(R&& range, const T& value) {
  return std::upper_bound(std::begin(range), std::end(range), value);
}

template <class R, class S, class C = std::equal_to<>, class P = identity, class Q = identity>
constexpr bool equal(R&& a, S&& b, C same = {}, P project_a = {}, Q project_b = {}) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b), [&](auto&& x, auto&& y) {
    return std::invoke(same, std::invoke(project_a, x), std::invoke(project_b, y));
  });
}

template <class R, class S>
constexpr auto mismatch(R&& a, S&& b) {
  return std::mismatch(std::begin(a), std::end(a), std::begin(b), std::end(b));
}

/// The rest that unique leaves. Callers use begin() alone.
template <class I>
struct Rest {
  I first;
  constexpr I begin() const { return first; }
};

template <class R>
constexpr auto unique(R&& range) {
  const auto rest = std::unique(std::begin(range), std::end(range));
  return Rest<decltype(rest)>{rest};
}

}  // namespace ranges
}  // namespace std

#endif
