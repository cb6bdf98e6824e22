// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/baselines/neural_brdf.h>
#include <burnish/reflectance/analytic/cosine_lobes.h>
#include <burnish/reflectance/analytic/microfacet.h>
#include <burnish/reflectance/half_diff_table.h>
#include <burnish/render/gl/gl_renderer.h>

namespace burnish::reports {

// These functions return GLSL of BRDFs that factored ones are compared with. Terms of the view alone are computed once
// a pixel.

SurfaceShader shader_of(const Ggx& ggx);

/// Evaluates f_r = kd / pi + ks s (n·h)^exponent. The power is computed by `pow` or as member w8 of the specular
/// family.
SurfaceShader shader_of(const BlinnPhong& phong, bool by_w8);

/// Reads the table as a 3-D texture, filtered linearly between the centres of its entries.
SurfaceShader shader_of(const HalfDiffTable& table);

/// Holds the weights as constants of the shader, four units a multiplication.
SurfaceShader shader_of(const NeuralBrdf& network);

}  // namespace burnish::reports
