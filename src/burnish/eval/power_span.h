// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <burnish/math/vec3.h>
#include <burnish/power/power.h>

namespace burnish {

// Float kernels of the members of PowerMethod, for the widest vectors of the processor. They are written once, with
// the formulas of the definition. `exact` is within kExactUlps units of the last place of the power, denormals
// included. near_exact and the Gaussians return 2^-125 instead of smaller values; the other members may return
// denormals.

/// out[i] = cosines[i]^exponent by `method`. Domain: cosines in [0, 1], exponent in the member's range. `out` is as
/// long as `cosines` and may be the same memory. Beyond the member's own error the result is within
/// power_span_rounding(method, false) of the definition. Throws Error for another exponent or length.
void power_span(PowerMethod method, std::span<const float> cosines, double exponent, std::span<float> out);

/// Uses coefficients that are already made, for a material that is used for many spans.
void power_span(const PowerCoefficients& coefficients, std::span<const float> cosines, std::span<float> out);

/// Uses one exponent a value, and computes the coefficients in the kernel. Domain: every exponent in the member's
/// range (not checked). Throws Error for lengths that differ.
void power_span(PowerMethod method, std::span<const float> cosines, std::span<const float> exponents,
                std::span<float> out);

/// Returns the largest |kernel - definition| for exponents to 1024. It comes from float rounding and, for the
/// Gaussians, from their short exponential; with one exponent a value the coefficients are rounded too. For
/// quadratic_raw it is relative to 1 + exponent (1 - c), the size of its terms. The values are measured on dense
/// samples, not proved.
double power_span_rounding(PowerMethod method, bool exponent_per_value) noexcept;

/// Blinn-Phong reflection of one directional light seen by a distant viewer.
struct BlinnPhongShading {
  float diffuse = 0.5f, specular = 0.5f;   ///< at least 0
  std::optional<PowerCoefficients> power;  ///< none: the cosine itself
  Vec3 wi{0, 0, 1}, wo{0, 0, 1};           ///< directions
};

/// Interpolated normals, one a point, of any length above 1e-6 (they are normalized here).
struct NormalSpans {
  std::span<const float> x, y, z;
};

/// out[i] = diffuse max(0, n.wi) + specular max(0, n.h)^exponent with n the normalized normal and h the half
/// vector, ^exponent by material.power. Throws Error for lengths that differ.
void shade_blinn_phong(const BlinnPhongShading& material, const NormalSpans& normals, std::span<float> out);

/// Returns the names of the compiled instruction sets that this processor has, best first.
std::vector<std::string> simd_targets();

/// Limits the kernels to the named one of simd_targets() until the object dies. For tests and benchmarks; not while
/// other threads evaluate.
class SimdTargetLimit {
 public:
  explicit SimdTargetLimit(const std::string& name);
  ~SimdTargetLimit();
  SimdTargetLimit(const SimdTargetLimit&) = delete;
  SimdTargetLimit& operator=(const SimdTargetLimit&) = delete;
};

}  // namespace burnish
