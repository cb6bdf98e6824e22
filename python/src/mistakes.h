// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "module.h"

namespace burnish::python {

/// Makes calls that fit no signature of a bound function or method raise a TypeError of one line. The line names the
/// mistake, and the nearest name of a misspelt keyword. Call it once, after all bindings.
void explain_mistakes(nb::module_& m);

}  // namespace burnish::python
