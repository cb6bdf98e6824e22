#pragma once

#include "module.h"

namespace burnish::python {

/// From now on a call that fits no signature of a bound function or method raises a TypeError of one line, which names
/// what is wrong and the nearest name of a misspelt keyword. To be called once, when all else is bound.
void explain_mistakes(nb::module_& m);

}  // namespace burnish::python
