// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <burnish/fitting/fit_request.h>

#include "module.h"

namespace burnish::python {

/// Converts keywords of `fit` or `batch`, the caller, to a request. `others` are the caller's further keywords, which
/// the error also lists. Throws Error for an unknown name or a value that the options refuse. Throws nb::type_error for
/// an object that no option takes.
FitRequest request_of(std::string_view caller, const nb::kwargs& keywords,
                      std::span<const std::string_view> others);

/// Returns "def fit(source: Source, *, NAME: TYPE = DEFAULT, ...) -> Model" with every option of fit_option_table for
/// that kind of fit. A fit with a method returns a Baseline, one without a Model.
std::string fit_signature(bool with_method);

/// Returns a line for each of these options: its name, its sentence, its default.
std::string fit_keyword_help(bool with_method);

}  // namespace burnish::python
