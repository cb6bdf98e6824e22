// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/eval/factored_eval.h>
#include <burnish/factors/compact_file.h>
#include <burnish/factors/model_file.h>
#include <burnish/file.h>
#include <burnish/image/png.h>
#include <burnish/math/angles.h>
#include <burnish/render/cpu_renderer.h>
#include <burnish/render/gl/gl_context.h>
#include <burnish/render/gl/gl_renderer.h>
#include <burnish/render/gl/surface_environment.h>
#include <burnish/render/mesh/mesh_file.h>
#include <burnish/render/mesh/shapes.h>
#include <burnish/render/picture.h>
#include <burnish/surface/surface_file.h>

#include "commands.h"
#include "environment_argument.h"
#include "json_output.h"
#include "progress.h"
#include "render_figure.h"
#include "source_arguments.h"
#include "usage.h"

namespace burnish::cli {

namespace {

struct RenderArguments {
  std::string mesh = "sphere", out, renderer = "auto", tone = "srgb", size = "512", exposure = "auto",
              background = "0,0,0";
  std::vector<std::string> materials, lights;
  OpenOptions open;
  std::vector<double> view{0, 0};
  std::string environment;
  int vertices = 40000, samples = 2, draws = 64;
  bool exact = false, shadows = false, figure1 = false, json = false;
  FigureArguments figure;
};

// Parses `least` to `most` numbers with commas between them.
std::vector<double> numbers(const std::string& text, std::size_t least, std::size_t most,
                            const char* option) {
  std::vector<double> values;
  for (const std::string& part : CLI::detail::split(text, ',')) {
    double value = 0;
    if (!CLI::detail::lexical_cast(part, value) || !std::isfinite(value)) values.resize(most + 1);
    values.push_back(value);
    if (values.size() > most) break;
  }
  if (values.size() < least || values.size() > most)
    throw CLI::ValidationError(
        fmt::format("{}: expected {} numbers, found '{}'", option,
                    least == most ? fmt::format("{}", least) : fmt::format("{} or {}", least, most), text));
  return values;
}

Rgb color(const std::string& text, const char* option) {
  const auto v = numbers(text, 1, 3, option);
  if (v.size() == 2 || *std::ranges::min_element(v) < 0)
    throw CLI::ValidationError(
        fmt::format("{}: expected one or three numbers >= 0, found '{}'", option, text));
  return v.size() == 1 ? Rgb(v[0]) : Rgb(v[0], v[1], v[2]);
}

PointLight light(const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto p = numbers(text.substr(0, colon), 3, 3, "--lights");
  return {{p[0], p[1], p[2]}, colon == text.npos ? Rgb(20) : color(text.substr(colon + 1), "--lights")};
}

std::array<int, 2> picture_size(const std::string& text) {
  const std::size_t cross = text.find('x');
  int width = 0, height = 0;
  const bool read = CLI::detail::lexical_cast(text.substr(0, cross), width) &&
                    CLI::detail::lexical_cast(cross == text.npos ? text : text.substr(cross + 1), height);
  if (!read || width < 1 || height < 1 || width > 8192 || height > 8192)
    throw CLI::ValidationError(fmt::format("--size: expected N or WxH in [1, 8192], found '{}'", text));
  return {width, height};
}

double exposure_of(const std::string& text) {
  double value = 0;
  if (!CLI::detail::lexical_cast(text, value) || !(value > 0))
    throw CLI::ValidationError(fmt::format("--exposure: expected auto or a number > 0, found '{}'", text));
  return value;
}

// Reads the parts of a mesh, which number their materials. Numbers above the last given material mean the last one.
std::vector<MeshPart> parts_of(const RenderArguments& arguments) {
  std::vector<MeshPart> parts;
  if (const auto shape = parse_shape(arguments.mesh))
    parts.push_back({make_shape(*shape, arguments.vertices), 0});
  else
    parts = read_mesh(arguments.mesh).parts;
  for (MeshPart& part : parts)
    part.material = std::min(part.material, static_cast<int>(arguments.materials.size()) - 1);
  fit_to_unit_sphere(parts);
  return parts;
}

bool is_file(const std::string& material) {
  std::error_code none;
  return std::filesystem::is_regular_file(material, none);
}

// Returns the surface that a material's file holds, if it holds one.
std::optional<SpatialBrdf> surface_of(const std::string& material) {
  if (!is_file(material)) return {};
  const FileBytes file = read_file(material);
  if (!looks_like_surface(file.bytes)) return {};
  return parse_surface(file).brdf;
}

// Returns true if OpenGL can draw all materials. It takes factored tables as textures, and surfaces without environment
// lighting. It casts no shadows.
bool is_drawn_by_gl(const RenderArguments& arguments) {
  return !arguments.shadows && std::ranges::all_of(arguments.materials, [&](const std::string& material) {
    if (!is_file(material)) return false;
    const FileBytes file = read_file(material);
    if (looks_like_surface(file.bytes)) return arguments.environment.empty();
    return looks_like_model(file.bytes) || looks_like_compact(file.bytes);
  });
}

Image render_gl(const Scene& scene, const std::optional<Environment>& environment,
                const RenderArguments& arguments, int width, int height) {
  std::vector<SurfaceShader> materials;
  for (const std::string& file : arguments.materials) {
    if (!is_file(file))
      throw Error::in_file(file, "the file of a factored BRDF (others are drawn by --renderer cpu)",
                           "no file");
    const ShaderFilter filter = arguments.exact ? ShaderFilter::exact : ShaderFilter::hardware;
    if (const auto surface = surface_of(file)) {
      if (environment)
        throw CLI::ValidationError("--environment: expected --renderer cpu with a surface, found gl");
      materials.push_back(surface_shader(*surface, filter, TableFormat::single));
      continue;
    }
    const FactoredBrdf brdf = parse_model(read_file(file)).brdf;
    materials.push_back(surface_shader(brdf, filter, TableFormat::single));
    if (environment) add_environment(materials.back(), brdf, *environment);
  }
  const GlContext context;
  const GlRenderer renderer(scene, materials, width, height);
  renderer.draw();
  return renderer.read();
}

Image render_by_cpu(const Scene& scene, const std::optional<Environment>& environment,
                    const RenderArguments& arguments, int width, int height) {
  const std::size_t count = arguments.materials.size();
  std::vector<SpatialBrdf> surfaces;
  std::vector<Source> sources;
  // Factored BRDFs are evaluated in float, the fastest way for one pair at a time.
  std::vector<FactoredEvaluator> evaluators;
  surfaces.reserve(count);
  sources.reserve(count);
  evaluators.reserve(count);
  std::vector<SceneMaterial> materials;
  for (const std::string& spec : arguments.materials) {
    if (auto surface = surface_of(spec)) {
      materials.emplace_back(&surfaces.emplace_back(std::move(*surface)));
      continue;
    }
    const Source& source = sources.emplace_back(open_source(spec, arguments.open));
    const auto* const model = std::get_if<FactoredBrdf>(&source.brdf);
    materials.emplace_back(model ? BrdfRef(evaluators.emplace_back(*model)) : source.ref());
  }
  return render_cpu(scene, materials,
                    {.width = width,
                     .height = height,
                     .shadows = arguments.shadows,
                     .environment = environment ? &*environment : nullptr,
                     .draws = arguments.draws});
}

void render(const RenderArguments& arguments) {
  if (arguments.materials.empty()) throw CLI::RequiredError("--material");
  if (arguments.out.empty()) throw CLI::RequiredError("--output");
  const bool cpu =
      arguments.renderer == "cpu" || (arguments.renderer == "auto" && !is_drawn_by_gl(arguments));
  const std::string extension = std::filesystem::path(arguments.out).extension().string();
  if (extension != ".png" && extension != ".exr")
    throw CLI::ValidationError(
        fmt::format("--output: expected a name that ends in .png or .exr, found '{}'", arguments.out));
  if (arguments.shadows && !cpu) throw CLI::ValidationError("--shadows: expected --renderer cpu with it");

  // All arguments are read before anything is drawn, so a bad one is reported at once.
  Scene scene;
  const std::optional<Environment> environment = environment_of(arguments.environment);
  std::vector<std::string> lights = arguments.lights;
  if (lights.empty() && !environment) lights = {"2,3,4:20"};
  for (const std::string& text : lights) scene.lights.push_back(light(text));
  scene.background = color(arguments.background, "--background");
  scene.camera = camera_for_unit_sphere(radians(arguments.view[0]), radians(arguments.view[1]));
  const auto [width, height] = picture_size(arguments.size);
  const bool automatic = arguments.exposure == "auto";
  const double given = automatic ? 1 : exposure_of(arguments.exposure);
  check_writable(arguments.out);
  scene.parts = parts_of(arguments);

  // The picture is drawn finer, exposed and averaged.
  const int n = arguments.samples;
  const Image fine = [&] {
    const Progress progress("rendering");
    return cpu ? render_by_cpu(scene, environment, arguments, n * width, n * height)
               : render_gl(scene, environment, arguments, n * width, n * height);
  }();
  const double exposure = automatic ? automatic_exposure(fine, scene.background) : given;
  const Image image = averaged(fine, n);
  if (extension == ".exr")
    write_then_rename(arguments.out, encode_exr(image));
  else
    write_png(arguments.out, to_bytes(image, exposure, arguments.tone == "aces" ? Tone::aces : Tone::srgb));
  if (!arguments.json) return;
  std::size_t triangles = 0;
  for (const MeshPart& part : scene.parts) triangles += part.mesh.triangles.size();
  nlohmann::ordered_json json{{"output", arguments.out},
                              {"width", width},
                              {"height", height},
                              {"renderer", cpu ? "cpu" : "gl"},
                              {"triangles", triangles}};
  if (extension == ".png") json["exposure"] = exposure;
  print_as_json(json);
}

}  // namespace

void add_render_command(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("render", "Draw a mesh with BRDFs or surfaces under point lights");
  verb->footer(
      "The scene is moved and scaled into the unit sphere; x points to the right, y up, z to the viewer.\n"
      "Examples: burnish render --mesh teapot --material paint.exr --lights 2,3,4:20 --lights -3,1,2:4,5,9 "
      "-o "
      "teapot.png\n"
      "          burnish render --mesh torus-knot --material ggx:alpha_x=0.1,alpha_y=0.3 --renderer cpu -o "
      "knot.exr\n"
      "          burnish render --mesh teapot --material paint.exr --environment sky.exr -o teapot.png\n"
      "          burnish render --figure1 -o figure1.png\n"
      "See docs/guide/rendering.md.");
  auto arguments = std::make_shared<RenderArguments>();
  verb->add_option("--mesh", arguments->mesh,
                   "Draws a sphere, teapot, torus-knot or plane, or an OBJ or glTF file.")
      ->capture_default_str();
  verb->add_option("--vertices", arguments->vertices, "Gives a built-in mesh about this many vertices.")
      ->check(in_range(64, 1 << 22))
      ->capture_default_str();
  verb->add_option("--material", arguments->materials,
                   "Sets a factored BRDF or surface, with --renderer cpu any BRDF; several are the file's "
                   "materials in their order.")
      ->allow_extra_args(false);
  verb->add_option("--lights", arguments->lights,
                   "Adds a point light x,y,z[:intensity] or x,y,z:r,g,b (default: 2,3,4:20).")
      ->allow_extra_args(false);
  add_environment_argument(*verb, arguments->environment);
  verb->add_option(
          "--draws", arguments->draws,
          "Draws this many directions a ray of the environment and of each lamp with --renderer cpu, "
          "a square number.")
      ->check(in_range(1, 1 << 20))
      ->capture_default_str();
  verb->add_option("-o,--output,--out", arguments->out,
                   "Names the picture to write: PNG, or EXR of linear values.");
  verb->add_option("--renderer", arguments->renderer,
                   "Draws by OpenGL, which takes factored BRDFs and surfaces, or by the reference on the "
                   "CPU; auto takes OpenGL where it can.")
      ->check(one_of({"auto", "gl", "cpu"}))
      ->capture_default_str();
  verb->add_option("--view", arguments->view, "Turns the view this many degrees to the right and upwards.")
      ->expected(2)
      ->delimiter(',');
  verb->add_option("--size", arguments->size, "Sets the picture's pixels, N or WxH.")->capture_default_str();
  verb->add_option("--pixel-samples,--samples", arguments->samples,
                   "Takes this many samples a pixel along each axis.")
      ->check(in_range(1, 8))
      ->capture_default_str();
  verb->add_option("--tone", arguments->tone, "Maps a PNG's tones: clamped, or with a filmic curve.")
      ->check(one_of({"srgb", "aces"}))
      ->capture_default_str();
  verb->add_option("--exposure", arguments->exposure,
                   "Exposes a PNG by a factor, or by auto, which makes 3 % of the object white.")
      ->capture_default_str();
  add_illuminant(*verb, arguments->open);
  verb->add_option("--background", arguments->background, "Sets the background, grey or r,g,b, linear.")
      ->capture_default_str();
  verb->add_flag("--exact", arguments->exact, "Interpolates texels in the shader, not by the texture unit.");
  verb->add_flag("--shadows", arguments->shadows, "Lets triangles block lights with --renderer cpu.");
  add_figure_arguments(*verb, arguments->figure, arguments->figure1);
  verb->add_flag("--json", arguments->json, "Prints what was drawn as JSON, of --figure1 the table.");
  verb->callback([arguments] {
    if (arguments->figure1) check_ending(arguments->out, {".png"});
    if (arguments->figure1)
      draw_figure(arguments->figure, arguments->mesh, arguments->out, arguments->json);
    else
      render(*arguments);
  });
}

}  // namespace burnish::cli
