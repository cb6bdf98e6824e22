// SPDX-License-Identifier: Apache-2.0
#include "mistakes.h"

#include <algorithm>
#include <array>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#if PY_VERSION_HEX < 0x030C0000
#include <structmember.h>  // has PyMemberDef, which is in Python.h since 3.12
#endif

#include <burnish/math/closest_name.h>
#include <burnish/short_message.h>

namespace burnish::python {

namespace {

// nanobind calls its functions by one of a few pointers. They stand in the objects at the place of Python's vectorcall
// protocol. A function of ours replaces each pointer: it calls the pointer and looks at the error alone.
constexpr std::size_t kMostKinds = 12;
std::array<vectorcallfunc, kMostKinds> called_by{};

// Replaces the present error by one line, where a call fits no signature.
void explain(PyObject* function, PyObject* const* arguments, std::size_t count, PyObject* keywords) {
  if (!PyErr_ExceptionMatches(PyExc_TypeError)) return;
  const nb::python_error error;  // takes the error
  const auto restore = [&] { PyErr_SetObject(error.type().ptr(), error.value().ptr()); };
  try {
    const auto message = nb::cast<std::string>(nb::str(error.value()));
    if (message.find("(): incompatible function arguments.") == std::string::npos) return restore();
    nb::list positional;
    nb::dict named;
    const bool makes_one = nb::cast<std::string>(nb::handle(function).attr("__name__")) == "__init__";
    if (makes_one) positional.append(nb::none());  // the object does not exist yet
    for (std::size_t i = makes_one; i < count; ++i) positional.append(nb::handle(arguments[i]));
    for (Py_ssize_t i = 0; keywords && i < PyTuple_Size(keywords); ++i)
      named[nb::handle(PyTuple_GetItem(keywords, i))] =
          nb::handle(arguments[count + static_cast<std::size_t>(i)]);
    const nb::object line =
        nb::module_::import_("burnish._mistakes").attr("explain")(nb::handle(function), positional, named);
    PyErr_SetString(PyExc_TypeError, short_message(nb::cast<std::string>(line)).c_str());
  } catch (const std::exception&) {
    restore();
  }
}

template <std::size_t kKind>
PyObject* call(PyObject* function, PyObject* const* arguments, std::size_t flags, PyObject* keywords) {
  PyObject* const result = called_by[kKind](function, arguments, flags, keywords);
  if (!result) explain(function, arguments, static_cast<std::size_t>(PyVectorcall_NARGS(flags)), keywords);
  return result;
}

template <std::size_t... kKinds>
constexpr std::array<vectorcallfunc, kMostKinds> all_calls(std::index_sequence<kKinds...>) {
  return {&call<kKinds>...};
}
constexpr auto kCalls = all_calls(std::make_index_sequence<kMostKinds>());

// Returns the offset of the vectorcall pointer in objects of a type, or 0 where they have none. The offset is read from
// the members that the type was made from, since the stable interface of Python 3.12 hides the type itself.
std::size_t place_of_call(nb::handle type) {
  const auto* member = static_cast<const PyMemberDef*>(
      PyType_GetSlot(reinterpret_cast<PyTypeObject*>(type.ptr()), Py_tp_members));
  for (; member && member->name; ++member)
    if (std::string_view(member->name) == "__vectorcalloffset__")
      return static_cast<std::size_t>(member->offset);
  return 0;
}

void explain_one(PyObject* function, std::size_t place) {
  auto* const slot = reinterpret_cast<vectorcallfunc*>(reinterpret_cast<char*>(function) + place);
  if (!*slot || std::ranges::find(kCalls, *slot) != kCalls.end()) return;
  for (std::size_t kind = 0; kind < kMostKinds; ++kind) {
    if (called_by[kind] && called_by[kind] != *slot) continue;
    called_by[kind] = *slot;
    *slot = kCalls[kind];
    return;
  }
}

bool is_bound(nb::handle value) {
  const nb::handle type = value.type();
  const auto name = nb::cast<std::string>(type.attr("__name__"));
  return nb::cast<std::string>(type.attr("__module__")) == "nanobind" &&
         (name == "nb_func" || name == "nb_method");
}

void explain_all(nb::handle members) {
  for (const nb::handle value : nb::list(members.attr("values")()))
    if (is_bound(value)) {
      if (const std::size_t place = place_of_call(value.type())) explain_one(value.ptr(), place);
    }
}

}  // namespace

void explain_mistakes(nb::module_& m) {
  m.def(
      "_expected_one_of",
      [](const std::vector<std::string>& names, const std::string& word) {
        return expected_one_of(std::vector<std::string_view>(names.begin(), names.end()), word);
      },
      "Returns \"expected one of A, B, found 'WORD'; did you mean 'A'?\".");
  const nb::handle members = m.attr("__dict__");
  explain_all(members);
  for (const nb::handle value : nb::list(members.attr("values")()))
    if (PyType_Check(value.ptr())) explain_all(value.attr("__dict__"));
}

}  // namespace burnish::python
