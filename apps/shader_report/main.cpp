// burnish_shader_report DOCS_FOLDER [SECTION] prints what docs/shader-results.md shows: precision of
// generated shaders on the OpenGL at hand, their cost, and image-based light; figures go to
// DOCS_FOLDER/figures.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/error.h>
#include <burnish/render/gl/gl_context.h>
#include <burnish/render/gl/gl_evaluator.h>
#include <burnish/testing/models.h>
#include <burnish/testing/tools.h>
#include <burnish/testing/webgl.h>

#include "environment.h"

namespace burnish {
namespace {

constexpr int kPairs = 1'000'000;

void print_precision(const GlContext& context) {
  fmt::print(
      "## Precision\n\nLargest relative error against `FactoredBrdf::eval` over {} pairs of directions: "
      "random ones, "
      "a tenth of them `wi == wo`, and the corners (normal, grazing, the maps' borders, where phi wraps, "
      "below the "
      "horizon). Tables are smooth and the same for all columns. Renderer: {}.\n\n"
      "| model | tables | exact, float | exact, half | hardware, float | hardware, half "
      "|\n|---|---|---|---|---|---|\n",
      kPairs, context.renderer());
  const auto pairs = corner_and_random_pairs(kPairs);
  std::vector<GlVectors> directions;
  const auto single = [](double x) { return static_cast<float>(x); };
  for (const auto& [a, b] : pairs)
    directions.push_back({{single(a.x), single(a.y), single(a.z)}, {single(b.x), single(b.y), single(b.z)}});
  for (const ModelCase& model : kModelCases) {
    const FactoredBrdf brdf = smooth_model(model);
    const auto channels = static_cast<std::size_t>(brdf.channels());
    std::vector<double> truth(3 * pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      brdf.eval(pairs[i].wi, pairs[i].wo, std::span(truth).subspan(3 * i, channels));
      for (std::size_t c = channels; c < 3; ++c) truth[3 * i + c] = truth[3 * i];
    }
    fmt::print("| {} | `{}` {} |", model.name, model.expression, fmt::join(model.options, " "));
    for (const auto& [filter, halves] : kShaderVariants) {
      const std::vector<float> found =
          GlEvaluator(brdf, filter, halves ? TableFormat::half : TableFormat::single).eval(directions);
      double worst = 0;
      for (std::size_t i = 0; i < truth.size(); ++i)
        if (truth[i] > 0) worst = std::max(worst, std::abs(found[i] / truth[i] - 1));
      fmt::print(" {:.1e} |", worst);
    }
    fmt::print("\n");
  }
}

void print_webgl() {
  constexpr int kSide = 1000;
  const TemporaryFolder folder("webgl_report");
  fmt::print(
      "\n## In a browser\n\nThe same in headless Chromium (WebGL2 by SwiftShader, with "
      "OES_texture_float_linear), read back as "
      "floats, over {} pairs; where terms of a projection cancel, divided by how much.\n\n"
      "| model | exact, float | exact, half | hardware, float | hardware, half |\n|---|---|---|---|---|\n",
      kSide * kSide);
  const auto worst = run_webgl(kModelCases, kSide, folder.path);
  if (worst.empty()) throw Error("expected Chromium with WebGL2, found none");
  for (std::size_t i = 0; i < worst.size(); ++i) {
    fmt::print("| {} |", kModelCases[i].name);
    for (const double error : worst[i]) fmt::print(" {:.1e} |", error);
    fmt::print("\n");
  }
  std::fflush(stdout);
}

void print_costs() {
  fmt::print(
      "\n## Cost of one evaluation\n\nFetches, then floating-point operations + divisions + square roots + "
      "powers, "
      "counted a component.\n\n| model | exact | hardware filter |\n|---|---|---|\n");
  const auto text = [](const ShaderCost& c) {
    return fmt::format("{} fetches, {} + {} + {} + {}", c.fetches, c.operations, c.divisions, c.roots,
                       c.powers);
  };
  for (const ModelCase& model : kModelCases) {
    const FactoredBrdf brdf = smooth_model(model);
    const auto cost = [&](ShaderFilter filter) {
      return text(generate_shader(brdf, {ShaderLanguage::glsl, filter, "model"}).cost);
    };
    fmt::print("| {} | {} | {} |\n", model.name, cost(ShaderFilter::exact), cost(ShaderFilter::hardware));
  }
}

}  // namespace
}  // namespace burnish

int main(int count, char** arguments) {
  try {
    if ((count != 2 && count != 3) || !std::filesystem::is_directory(arguments[1]))
      throw burnish::Error(
          "expected the folder of the documents, then maybe precision, webgl, cost or environment alone");
    const std::string only = count == 3 ? arguments[2] : "";
    fmt::print(
        "<!-- Written by `make shader-report`; edit apps/shader_report instead. -->\n"
        "# What generated shaders give and cost\n\n");
    const burnish::GlContext context;
    if (only.empty() || only == "precision") burnish::print_precision(context);
    if (only.empty() || only == "webgl") burnish::print_webgl();
    if (only.empty() || only == "cost") burnish::print_costs();
    if (only.empty() || only == "environment")
      burnish::print_environment_light(std::filesystem::path(arguments[1]) / "figures");
  } catch (const std::exception& error) {
    fmt::print(stderr, "burnish_shader_report: {}\n", error.what());
    return 1;
  }
}
