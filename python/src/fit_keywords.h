#pragma once

#include <span>
#include <string>
#include <string_view>

#include <burnish/fitting/fit_request.h>

#include "module.h"

namespace burnish::python {

/// What keywords of `fit` and `batch`, the caller, ask for. `others` are what the caller takes besides, which
/// stand among the names of the error. Throws Error for what is no name or what the options refuse, and
/// nb::type_error for an object that no option takes.
FitRequest request_of(std::string_view caller, const nb::kwargs& keywords,
                      std::span<const std::string_view> others);

/// "def fit(source: Source, *, NAME: TYPE = DEFAULT, ...) -> Model", with every option of fit_option_table that a fit
/// of that kind takes: one with a method, which gives a Baseline, or one without.
std::string fit_signature(bool with_method);

/// A line for each of these options: its name, its sentence, what stands where it is left out.
std::string fit_keyword_help(bool with_method);

}  // namespace burnish::python
