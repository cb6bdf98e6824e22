// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <burnish/metrics/sphere_images.h>
#include <burnish/render/cpu_renderer.h>
#include <burnish/render/gl/gl_renderer.h>
#include <burnish/render/picture.h>
#include <burnish/render/vertex_figure.h>

namespace burnish {

VertexFigure compare_with_vertices(const Scene& scene, BrdfRef truth, const FactoredBrdf& factored,
                                   int size) {
  VertexFigure figure;
  for (const MeshPart& part : scene.parts) figure.vertices += part.mesh.vertices.size();
  const std::array materials{truth};
  const std::array shaders{surface_shader(factored, ShaderFilter::exact, TableFormat::single)};
  const auto draw = [](const GlRenderer& renderer) {
    renderer.draw();
    return renderer.read();
  };
  figure.at_vertices = draw(GlRenderer(scene, shade_vertices(scene, materials), size, size));
  figure.factored = draw(GlRenderer(scene, shaders, size, size));
  figure.truth = render_cpu(scene, materials, {.width = size, .height = size});
  figure.exposure = automatic_exposure(figure.truth, scene.background);
  const Image shown = tone_map(figure.truth, figure.exposure);
  const auto score = [&](const Image& image) {
    return psnr(mean_squared_error(tone_map(image, figure.exposure), shown));
  };
  figure.psnr_at_vertices = score(figure.at_vertices);
  figure.psnr_factored = score(figure.factored);
  return figure;
}

}  // namespace burnish
