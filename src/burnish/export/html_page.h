// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/factors/factored_brdf.h>
#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/render/gl/surface_environment.h>
#include <burnish/shaders/specular_shader.h>

namespace burnish {

/// An HTML page that shows the model on a torus knot, a teapot or a sphere under a light that follows the
/// pointer, and light from all around where `light` is given: WebGL2, everything inside, nothing loaded;
/// web/page.html and web/page.js. Throws Error as generate_shader does, and for a light whose textures leave
/// none to the model.
std::string html_page(const FactoredBrdf& brdf, const std::string& name, const SurfaceLight* light = nullptr);
/// The same for a surface, on a plane first.
std::string html_page(const SpatialBrdf& surface, const std::string& name);
/// The same for a specular model that is called `expression` there.
std::string html_page(const SpecularModel& model, const std::string& expression, const std::string& name);
/// The same for OpenPBR.
std::string html_page(const OpenPbr& material, const std::string& name);

}  // namespace burnish
