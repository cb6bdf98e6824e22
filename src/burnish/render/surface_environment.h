#pragma once

#include <burnish/render/environment_light.h>
#include <burnish/render/gl_renderer.h>

namespace burnish {

/// Adds the light of an environment to a surface's shader: by prefilter where the BRDF is isotropic, by tap
/// and blur where it is not. Takes a second or two. Throws Error as these and generate_shader do.
void add_environment(SurfaceShader& surface, const FactoredBrdf& brdf, const Environment& environment);

}  // namespace burnish
