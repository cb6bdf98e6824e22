// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>
#include <nanobind/stl/string.h>

#include <burnish/error.h>

#include "rows.h"

namespace burnish::python {

/// Returns true if an array's type is float32, in NumPy or another package ("torch.float32"). An object without `dtype`
/// that lends its memory by DLPack tells its type there. Returns nothing where the value is no array.
inline std::optional<bool> is_float32(nb::handle value) {
  if (nb::hasattr(value, "dtype")) {
    const auto type = nb::cast<std::string>(nb::str(nb::handle(value.attr("dtype"))));
    return type.ends_with("float32");
  }
  nb::ndarray<nb::ro> lent;
  if (!nb::hasattr(value, "__dlpack__") || !nb::try_cast(value, lent, false)) return std::nullopt;
  return lent.dtype() == nb::dtype<float>();
}

/// Decides the common type of arguments that may be lists, integers or arrays of different types. Returns true for
/// float32: every array among them and `out` is float32. Otherwise they become float64.
inline bool is_single(std::initializer_list<nb::handle> arguments, nb::handle out = nb::none()) {
  bool any = false;
  const auto fits = [&](nb::handle argument) {
    const std::optional<bool> single = is_float32(argument);
    any |= single.has_value();
    return single.value_or(true);
  };
  for (const nb::handle argument : arguments)
    if (!fits(argument)) return false;
  return fits(out) && any;
}

/// Returns the value as a NumPy array, in the same memory where its owner lends that. Throws the owner's error where it
/// refuses.
inline nb::object as_numpy(nb::handle value) {
  const bool only_lends = nb::hasattr(value, "__dlpack__") && !nb::hasattr(value, "__array__");
  return nb::module_::import_("numpy").attr(only_lends ? "from_dlpack" : "asarray")(value);
}

/// Describes a value that NumPy makes no array of, by its owner's first line. An example is an array on a graphics
/// card.
inline std::string refusal_of(nb::handle value, const nb::python_error& error) {
  if (!is_float32(value) && !nb::hasattr(value, "__array__") && !nb::hasattr(value, "__dlpack__"))
    return "rows of unequal lengths";
  const std::string why = nb::str(error.value()).c_str();
  return fmt::format("{}: {}", nb::str(value.type().attr("__name__")).c_str(), why.substr(0, why.find('\n')));
}

/// Returns the value as a NumPy array of floats. Throws nb::type_error, naming the argument, where it is no array of
/// real numbers that the processor can read.
inline nb::object numbers_of(nb::handle value, std::string_view name, bool single) {
  const auto refuse = [&](const std::string& found) -> nb::object {
    throw nb::type_error(fmt::format("{}: expected an array of real numbers, found {}", name, found).c_str());
  };
  nb::object array;
  try {
    array = as_numpy(value);
  } catch (nb::python_error& error) {
    // NumPy refuses rows of different lengths, and arrays on another device or with gradients.
    for (PyObject* const kind : {PyExc_ValueError, PyExc_TypeError, PyExc_RuntimeError, PyExc_BufferError})
      if (error.matches(kind)) return refuse(refusal_of(value, error));
    throw;
  }
  const auto kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
  if (std::string_view("iuf").find(kind) == std::string_view::npos)
    return refuse(kind == "c"   ? std::string("complex numbers")
                  : kind == "b" ? std::string("booleans")
                                : std::string(nb::str(value.type().attr("__name__")).c_str()));
  return array.attr("astype")(single ? "f4" : "f8", nb::arg("copy") = false);
}

template <class T>
Array<const T> array_of(nb::handle value, std::string_view name) {
  return nb::cast<Array<const T>>(numbers_of(value, name, std::is_same_v<T, float>));
}

}  // namespace burnish::python
