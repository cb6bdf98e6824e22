// SPDX-License-Identifier: Apache-2.0
// Measures the precision of generated shaders on this machine's OpenGL and in a browser, their cost, and environment
// lighting.
#include <algorithm>
#include <cmath>
#include <span>
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

#include "environment_light.h"
#include "report.h"

namespace burnish::reports {

namespace {

const std::vector<std::string> kVariants{"exact, float", "exact, half", "hardware, float", "hardware, half"};

// Returns f of each pair, three components.
std::vector<double> truth_of(const FactoredBrdf& brdf, std::span<const DirectionPair> pairs) {
  const auto channels = brdf.channels();
  std::vector<double> truth(3 * pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    brdf.eval(pairs[i].wi, pairs[i].wo, std::span(truth).subspan(3 * i, channels));
    for (std::size_t c = channels; c < 3; ++c) truth[3 * i + c] = truth[3 * i];
  }
  return truth;
}

void report_precision(Page& page, const GlContext& context) {
  const int count = page.options().quick ? 10'000 : 1'000'000;
  const auto pairs = corner_and_random_pairs(count);
  std::vector<GlVectors> directions;
  const auto single = [](double x) { return static_cast<float>(x); };
  for (const auto& [a, b] : pairs)
    directions.push_back({{single(a.x), single(a.y), single(a.z)}, {single(b.x), single(b.y), single(b.z)}});
  Table table(joined({"model", "tables"}, kVariants));
  for (const ModelCase& model : kModelCases) {
    tell(fmt::format("shaders: {}", model.name));
    const FactoredBrdf brdf = smooth_model(model);
    const std::vector<double> truth = truth_of(brdf, pairs);
    std::vector<double> errors;
    for (const auto& [filter, halves] : kShaderVariants) {
      const std::vector<float> found =
          GlEvaluator(brdf, filter, halves ? TableFormat::half : TableFormat::single).eval(directions);
      double worst = 0;
      for (std::size_t i = 0; i < truth.size(); ++i)
        if (truth[i] > 0) worst = std::max(worst, std::abs(found[i] / truth[i] - 1));
      errors.push_back(worst);
    }
    table.add(joined({model.name, fmt::format("`{}` {}", model.expression, fmt::join(model.options, " "))},
                     cells("{:.1e}", errors)));
  }
  page["pairs"] = std::to_string(count);
  page["renderer"] = context.renderer();
  page["precision"] = table.markdown();
}

void report_webgl(Page& page) {
  constexpr int kSide = 1000;
  const TemporaryFolder folder("webgl_report");
  const auto worst = run_webgl(kModelCases, kSide, folder.path);
  if (worst.empty()) throw Error("expected Chromium with WebGL2, found none");
  Table table(joined({"model"}, kVariants));
  for (std::size_t i = 0; i < worst.size(); ++i)
    table.add(joined({kModelCases[i].name}, cells("{:.1e}", worst[i])));
  page["webgl"] = table.markdown();
  page["webgl_pairs"] = std::to_string(kSide * kSide);
}

void report_costs(Page& page) {
  Table table({"model", "exact", "hardware filter"});
  for (const ModelCase& model : kModelCases) {
    const FactoredBrdf brdf = smooth_model(model);
    const auto cost = [&](ShaderFilter filter) {
      const ShaderCost c = generate_shader(brdf, {ShaderLanguage::glsl, filter, "model"}).cost;
      return fmt::format("{} fetches, {} + {} + {} + {}", c.fetches, c.operations, c.divisions, c.roots,
                         c.powers);
    };
    table.add({model.name, cost(ShaderFilter::exact), cost(ShaderFilter::hardware)});
  }
  page["costs"] = table.markdown();
}

}  // namespace

void report_shaders(const ReportOptions& options) {
  Page page(options, "shader-results");
  const GlContext context;
  if (options.wants("precision")) report_precision(page, context);
  if (!options.quick && options.wants("webgl")) report_webgl(page);
  if (options.wants("cost")) report_costs(page);
  if (options.wants("environment")) report_environment_light(page);
  page.write();
}

}  // namespace burnish::reports
