// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <burnish/factors/factored_brdf.h>
#include <burnish/render/scene.h>

namespace burnish {

/// One picture three ways, linear.
struct VertexFigure {
  std::size_t vertices = 0;
  Image at_vertices;    ///< the truth at the vertices, interpolated over triangles [Gouraud 1971]
  Image factored;       ///< the factored BRDF at every pixel
  Image truth;          ///< the truth at every pixel
  double exposure = 1;  ///< of the pictures that are compared, see automatic_exposure
  double psnr_at_vertices = 0, psnr_factored = 0;  ///< against the truth, tone mapped, dB
};

/// Figure 1 of [HomomorphicBrdf]: a scene's only material drawn by OpenGL from values at vertices and from a
/// factored BRDF, and by the reference renderer. Needs a GlContext that is current. The exposure makes the
/// 97th percentile of what is lit in the truth white. Throws Error as the renderers do.
VertexFigure compare_with_vertices(const Scene& scene, BrdfRef truth, const FactoredBrdf& factored, int size);

}  // namespace burnish
