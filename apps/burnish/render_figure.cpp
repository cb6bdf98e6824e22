// SPDX-License-Identifier: Apache-2.0
#include "render_figure.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/file.h>
#include <burnish/fitting/fit.h>
#include <burnish/image/contact_sheet.h>
#include <burnish/image/png.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/render/gl/gl_context.h>
#include <burnish/render/mesh/shapes.h>
#include <burnish/render/picture.h>
#include <burnish/render/vertex_figure.h>

#include "json_output.h"
#include "usage.h"

namespace burnish::cli {

namespace {

// The brightest colour stands for this difference of tone-mapped values.
constexpr double kDifferenceScale = 0.25;

Scene scene_of(const std::string& mesh, int vertices) {
  const auto shape = parse_shape(mesh);
  if (!shape)
    throw CLI::ValidationError(
        fmt::format("--mesh: expected sphere, teapot, torus-knot or plane with --figure1, found '{}'", mesh));
  Scene scene;
  scene.parts = {{make_shape(*shape, vertices), 0}};
  fit_to_unit_sphere(scene.parts);
  scene.lights = {{{2, 3, 4}, 20}, {{-4, 1, 3}, 10}};
  scene.camera = camera_for_unit_sphere(radians(20), radians(20));
  return scene;
}

FactoredBrdf model_of(const FigureArguments& arguments, const Source& truth) {
  if (!arguments.model.empty()) return parse_model(read_file(arguments.model)).brdf;
  return fit(truth, {.form = Budget{.bytes = 16 << 10}, .score = false}).model();
}

std::vector<Image8> row_of(const VertexFigure& f) {
  const Image truth = tone_map(f.truth, f.exposure);
  const auto shown = [&](const Image& image) { return to_image8(tone_map(image, f.exposure)); };
  const auto difference = [&](const Image& image) {
    return heat_map(mean_difference(tone_map(image, f.exposure), truth), kDifferenceScale);
  };
  return {shown(f.at_vertices), shown(f.factored), to_image8(truth), difference(f.at_vertices),
          difference(f.factored)};
}

}  // namespace

void add_figure_arguments(CLI::App& verb, FigureArguments& arguments, bool& figure1) {
  CLI::Option* figure = verb.add_flag(
      "--figure1", figure1,
      "Draws the truth at vertices and interpolated, the factored BRDF at pixels, and the truth at pixels.");
  verb.add_option("--truth", arguments.truth, "Sets the BRDF that --figure1 takes for the truth.")
      ->needs(figure)
      ->capture_default_str();
  verb.add_option("--model", arguments.model,
                  "Sets the factored BRDF of --figure1 (default: fitted to 16 KB, some 20 s).")
      ->needs(figure);
  verb.add_option("--tessellations", arguments.tessellations, "Sets the numbers of vertices of --figure1.")
      ->needs(figure)
      ->delimiter(',')
      ->check(in_range(64, 1 << 22))
      ->capture_default_str();
  verb.add_option("--figure-size", arguments.size, "Sets the pixels of a picture of --figure1.")
      ->needs(figure)
      ->check(in_range(16, 4096))
      ->capture_default_str();
}

void draw_figure(const FigureArguments& arguments, const std::string& mesh, const std::string& out,
                 bool json) {
  if (out.empty()) throw CLI::RequiredError("--output");
  check_writable(out);
  scene_of(mesh, 64);  // an unknown name is reported before anything is fitted
  const Source truth = open_source(arguments.truth, {});
  const FactoredBrdf model = model_of(arguments, truth);
  const GlContext context;
  ContactSheet sheet{.title = fmt::format("{} on a {}", arguments.truth, mesh),
                     .column_labels = {"truth at vertices", "factored at pixels", "truth at pixels",
                                       "difference\nat vertices", "difference\nfactored"},
                     .row_labels = {},
                     .cells = {},
                     .color_bar = ColorBar{kDifferenceScale, "difference, tone mapped"}};
  auto rows = nlohmann::ordered_json::array();
  for (const int vertices : arguments.tessellations) {
    const VertexFigure f =
        compare_with_vertices(scene_of(mesh, vertices), truth.ref(), model, arguments.size);
    rows.push_back({{"vertices", f.vertices},
                    {"psnr_at_vertices", f.psnr_at_vertices},
                    {"psnr_factored", f.psnr_factored}});
    sheet.row_labels.push_back(fmt::format("{} vertices", f.vertices));
    sheet.cells.push_back(row_of(f));
  }
  write_png(out, compose(sheet));
  if (json) return print_as_json(rows);
  fmt::print("{}, {} bytes, psnr against the truth at pixels (dB)\n vertices  at vertices  factored\n",
             model_expression(model), model.bytes());
  for (const auto& row : rows)
    fmt::print("{:9}  {:11.2f}  {:8.2f}\n", row["vertices"].get<std::size_t>(),
               row["psnr_at_vertices"].get<double>(), row["psnr_factored"].get<double>());
}

}  // namespace burnish::cli
