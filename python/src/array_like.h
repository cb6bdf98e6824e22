#pragma once

#include <array>
#include <initializer_list>
#include <string_view>

#include <fmt/format.h>
#include <nanobind/stl/string.h>

#include <burnish/error.h>

#include "rows.h"

namespace burnish::python {

/// A function's arguments that may be lists, integers or arrays of different types, as arrays of one: float32 where
/// every array among them and `out` is, else float64.
inline bool is_single(std::initializer_list<nb::handle> arguments, nb::handle out = nb::none()) {
  bool any = false;
  const auto fits = [&](nb::handle argument) {
    if (!nb::hasattr(argument, "dtype")) return true;
    any = true;
    return nb::cast<std::string>(nb::str(nb::handle(argument.attr("dtype")))) == "float32";
  };
  for (const nb::handle argument : arguments)
    if (!fits(argument)) return false;
  return fits(out) && any;
}

/// What NumPy makes of the value, as floats. Throws nb::type_error naming the argument where it is no array of real
/// numbers.
inline nb::object numbers_of(nb::handle value, std::string_view name, bool single) {
  const auto refuse = [&](const std::string& found) -> nb::object {
    throw nb::type_error(fmt::format("{}: expected an array of real numbers, found {}", name, found).c_str());
  };
  nb::object array;
  try {
    array = nb::module_::import_("numpy").attr("asarray")(value);
  } catch (nb::python_error& error) {  // rows of different lengths, or what its owner cannot make an array of
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw;
    return refuse("rows of unequal lengths");
  }
  const auto kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
  if (std::string_view("iuf").find(kind) == std::string_view::npos)
    return refuse(kind == "c"   ? std::string("complex ones")
                  : kind == "b" ? std::string("truth values")
                                : std::string(nb::str(value.type().attr("__name__")).c_str()));
  return array.attr("astype")(single ? "f4" : "f8", nb::arg("copy") = false);
}

template <class T>
Array<const T> array_of(nb::handle value, std::string_view name) {
  return nb::cast<Array<const T>>(numbers_of(value, name, std::is_same_v<T, float>));
}

}  // namespace burnish::python
