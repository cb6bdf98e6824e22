// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <burnish/power/power.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/shaders/shader.h>

namespace burnish {

/// Phong's or Blinn's model, kd / pi + height * power(c), whose power is a member of the specular family: c
/// is the cosine between the light's mirror direction and the viewer, or between half vector and normal.
struct SpecularModel {
  bool half_vector = true;  ///< Blinn's
  Rgb diffuse, height;      ///< in 1/sr
  double exponent = 80;
  PowerMethod method = PowerMethod::exact;

  /// Returns the largest error of f_r, in 1/sr, that `method` causes at the exponent. Throws Error as power_bound.
  double bound() const;
  /// f_r in 1/sr of unit vectors, 0 below the horizon. Throws Error outside the method's exponents.
  Rgb eval(Vec3 wi, Vec3 wo) const;
};

/// Returns the specular model of phong, phong_normalized, blinn_phong and blinn_phong_normalized; nothing for other
/// models.
std::optional<SpecularModel> specular_model(const AnalyticBrdf& brdf, PowerMethod method);

/// The functions of generate_shader(FactoredBrdf) for a specular model, without textures; power_code writes
/// the power. The cost counts exp2, log2 and the like as powers. Throws Error for a name that is none, and
/// exponents outside the method's range.
Shader generate_shader(const SpecularModel& model, ShaderLanguage language, const std::string& name);

}  // namespace burnish
