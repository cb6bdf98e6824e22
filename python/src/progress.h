// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

#include "module.h"

namespace burnish::python {

/// Lets Ctrl-C end a fit, which passes on exceptions of this function. `callback` is None or a callable; the caller
/// keeps it alive.
inline std::function<void(std::string_view, double)> progress_of(nb::handle callback) {
  return [callback](std::string_view stage, double fraction) {
    const nb::gil_scoped_acquire acquired;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    if (!callback.is_none()) callback(nb::str(stage.data(), stage.size()), fraction);
  };
}

}  // namespace burnish::python
