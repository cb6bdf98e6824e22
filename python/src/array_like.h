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

/// True of an array's type, NumPy's or another package's ("torch.float32"), if it is float32; none where the value is no
/// array. What has no type but lends its memory (DLPack) says it there.
inline std::optional<bool> is_float32(nb::handle value) {
  if (nb::hasattr(value, "dtype")) {
    const auto type = nb::cast<std::string>(nb::str(nb::handle(value.attr("dtype"))));
    return type.ends_with("float32");
  }
  nb::ndarray<nb::ro> lent;
  if (!nb::hasattr(value, "__dlpack__") || !nb::try_cast(value, lent, false)) return std::nullopt;
  return lent.dtype() == nb::dtype<float>();
}

/// A function's arguments that may be lists, integers or arrays of different types, as arrays of one: float32 where
/// every array among them and `out` is, else float64.
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

/// As NumPy has it, in the same memory where its owner lends that. Throws what the owner does where it refuses.
inline nb::object as_numpy(nb::handle value) {
  const bool only_lends = nb::hasattr(value, "__dlpack__") && !nb::hasattr(value, "__array__");
  return nb::module_::import_("numpy").attr(only_lends ? "from_dlpack" : "asarray")(value);
}

/// What is said of a value that NumPy makes no array of: its owner's first line, as of an array on a graphics card.
inline std::string refusal_of(nb::handle value, const nb::python_error& error) {
  if (!is_float32(value) && !nb::hasattr(value, "__array__") && !nb::hasattr(value, "__dlpack__"))
    return "rows of unequal lengths";
  const std::string why = nb::str(error.value()).c_str();
  return fmt::format("{}: {}", nb::str(value.type().attr("__name__")).c_str(), why.substr(0, why.find('\n')));
}

/// What NumPy makes of the value, as floats. Throws nb::type_error naming the argument where it is no array of real
/// numbers that the processor can read.
inline nb::object numbers_of(nb::handle value, std::string_view name, bool single) {
  const auto refuse = [&](const std::string& found) -> nb::object {
    throw nb::type_error(fmt::format("{}: expected an array of real numbers, found {}", name, found).c_str());
  };
  nb::object array;
  try {
    array = as_numpy(value);
  } catch (nb::python_error& error) {
    // rows of different lengths; what is on another device, or is differentiated
    for (PyObject* const kind : {PyExc_ValueError, PyExc_TypeError, PyExc_RuntimeError, PyExc_BufferError})
      if (error.matches(kind)) return refuse(refusal_of(value, error));
    throw;
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
