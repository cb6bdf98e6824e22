#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <burnish/io/open_options.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// What a table's values are: f_r in 1/sr, f_r times a cosine, or the reflectance factor pi f_r.
enum class ValueKind { f, f_cos_i, f_cos_o, brf };

/// The kind that options ask for; nothing where they leave it to the names. Throws Error if they ask for two.
std::optional<ValueKind> asked_kind(const OpenOptions& options);

/// The kind that a column's name says, in lower case: "brdf", "ccbrdf" (f_r cos(theta_o)), "brf",
/// "brdf_cos_theta_i" and so on; nothing where it says none.
std::optional<ValueKind> kind_of_name(std::string_view name);

/// f_r of a value; NaN where the cosine that it contains is below 1e-6.
double f_of_value(ValueKind kind, double value, const DirectionPair& pair) noexcept;

/// One sentence for Findings::conventions; `why` says who decided, such as "as asked".
std::string kind_sentence(ValueKind kind, std::string_view why);

}  // namespace burnish
