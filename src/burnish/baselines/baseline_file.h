// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

#include <burnish/baselines/dgf_brdf.h>
#include <burnish/baselines/separable_brdf.h>
#include <burnish/file.h>
#include <burnish/reflectance/analytic.h>

namespace burnish {

using BaselineBrdf = std::variant<SeparableBrdf, DgfBrdf, AnalyticBrdf>;

/// A compressed BRDF that is no product of positive factors, and how it came about.
struct Baseline {
  std::string kind;  ///< "svd", "nd" or "nmf" (separable), "dgf", "analytic"
  BaselineBrdf brdf;
  std::string notes = "{}";  ///< a JSON object: source, fit options, errors
};

/// Refers into `brdf`, which must outlive it and stay where it is.
BrdfRef baseline_ref(const BaselineBrdf& brdf) noexcept;
std::size_t baseline_bytes(const BaselineBrdf& brdf) noexcept;

/// Returns the tables in one line, such as "u(theta_h 32, theta_d 8) v(phi_d 5), 2 terms".
std::string baseline_expression(const BaselineBrdf& brdf);

/// JSON {kind, parameters, tables, notes}. parse_baseline restores the baseline to the last bit.
std::string format_baseline(const Baseline& baseline);

/// True if the text's first character that is no blank opens a JSON object.
bool looks_like_baseline(std::string_view text) noexcept;

/// Throws Error if the file is over 64 MiB, no such JSON, or describes what SeparableBrdf, DgfBrdf or
/// AnalyticBrdf refuse.
Baseline parse_baseline(const FileBytes& file);

}  // namespace burnish
