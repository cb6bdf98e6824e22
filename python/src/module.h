// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <burnish/reflectance/bsdf_part.h>

namespace burnish::python {

namespace nb = nanobind;

// Each part of the library is bound in the file of its name.
void bind_batch(nb::module_& m);
void bind_book(nb::module_& m);
void bind_source(nb::module_& m);
void bind_eval(nb::module_& m);
void bind_exports(nb::module_& m);
void bind_fitting(nb::module_& m);
void bind_graphs(nb::module_& m);
void bind_metrics(nb::module_& m);
void bind_own_sources(nb::module_& m);
void bind_sampling(nb::module_& m);
void bind_shaders(nb::module_& m);
void bind_surfaces(nb::module_& m);
void bind_uncertainty(nb::module_& m);
void bind_writers(nb::module_& m);

/// Returns the part of that name, or nothing for an empty name. Throws Error for another name.
std::optional<BsdfPart> part_of(const std::string& name);

/// Returns a JSON text as Python objects.
inline nb::object from_json(const std::string& text) {
  return nb::module_::import_("json").attr("loads")(text);
}

/// Returns a C-contiguous NumPy array that owns the vector's values.
template <class T>
nb::object to_numpy(std::vector<T> values, std::vector<std::size_t> shape) {
  auto* kept = new std::vector<T>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, T>(kept->data(), shape.size(), shape.data(), owner));
}

}  // namespace burnish::python
