// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/power/power.h>

namespace burnish {

/// Languages code can be written in: "c", "cuda", "glsl", "glsl_es" (3.00), "hlsl", "msl", "rust",
/// "slang", "wgsl".
std::vector<std::string_view> code_languages();

struct CodeOptions {
  std::string language = "c";
  /// Constants for this exponent, function of the cosine alone; without it the function takes the exponent
  /// too and computes the coefficients.
  std::optional<double> exponent;
  /// Multiplies by power_normalization(): needs the exponent.
  bool normalize = false;
};

/// A function `power_NAME` of floats, cosine in [0, 1], from the same formula as the definition, with a
/// comment that states range and bound. Throws Error for an unknown language, an exponent outside the
/// member's range, or `normalize` without exponent.
std::string power_code(PowerMethod method, const CodeOptions& options);

/// The paper's coefficient a(e) for e = 1 .. count as text. Formats:
/// - "csv": header `exponent,a`, 17 digits;
/// - "c": a C header with a float array `burnish_quadratic_a`, index 0 unused (a(0) = 0);
/// - "mem": a PROM image for $readmemh: word e holds round(a(e) 2^fraction_bits) as an unsigned hexadecimal
///   number, addresses 0 .. count, comment lines first.
/// Domain: count in [1, 1024], fraction_bits in [0, 20]. Throws Error otherwise.
std::string quadratic_table(std::string_view format, int count = 1000, int fraction_bits = 8);

}  // namespace burnish
