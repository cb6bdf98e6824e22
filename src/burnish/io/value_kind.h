// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <burnish/io/open_options.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// The quantity in a table: f_r in 1/sr, f_r times a cosine, or the reflectance factor pi f_r.
enum class ValueKind { f, f_cos_i, f_cos_o, brf };

/// Returns the kind that the options request, or nothing if they leave it to the names. Throws Error if they
/// request two.
std::optional<ValueKind> asked_kind(const OpenOptions& options);

/// Returns the kind that a column's name in lower case states, or nothing. Names are "brdf", "ccbrdf" (f_r
/// cos(theta_o)), "brf", "brdf_cos_theta_i" and so on.
std::optional<ValueKind> kind_of_name(std::string_view name);

/// Returns f_r of a value; NaN if the cosine that the value contains is below 1e-6.
double f_of_value(ValueKind kind, double value, const DirectionPair& pair) noexcept;

/// Returns one sentence for Findings::conventions; `why` states the reason, such as "as asked".
std::string kind_sentence(ValueKind kind, std::string_view why);

}  // namespace burnish
