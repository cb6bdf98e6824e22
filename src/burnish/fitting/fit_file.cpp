// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <nlohmann/json.hpp>

#include <burnish/baselines/evaluation_cost.h>
#include <burnish/error.h>
#include <burnish/factors/fetches.h>
#include <burnish/fitting/fit_file.h>
#include <burnish/fitting/fit_report_json.h>
#include <burnish/shaders/cost_json.h>

namespace burnish {

Model to_model(Fit fit) {
  std::string notes = to_json(fit.report);
  return {.brdf = std::move(fit).model(), .lambda_nm = std::move(fit.lambda_nm), .notes = std::move(notes)};
}

Baseline to_baseline(Fit fit) {
  auto* brdf = std::get_if<BaselineBrdf>(&fit.brdf);
  if (!brdf) throw Error("expected a baseline, found a factored BRDF");
  const bool analytic = std::holds_alternative<AnalyticBrdf>(*brdf);
  return {.kind = analytic ? "analytic" : std::get<BaselineReport>(fit.report.how).method,
          .brdf = std::move(*brdf),
          .notes = to_json(fit.report)};
}

std::string format_fit(const Fit& fit, const std::filesystem::path& name) {
  if (std::holds_alternative<BaselineBrdf>(fit.brdf)) return format_baseline(to_baseline(fit));
  return format_model_as(name, to_model(fit));
}

std::string summary_json(const Fit& fit, const std::string& output, double seconds,
                         std::optional<std::size_t> file_bytes) {
  nlohmann::ordered_json json = json_of(fit.report);
  json["output"] = output;
  if (const auto* model = std::get_if<FactoredBrdf>(&fit.brdf)) {
    json["model"] = model_expression(*model);
    json["bytes"] = model->bytes();
    json["table_bytes"] = model->table_bytes();
    json["textures"] = texture_count(*model);
    json["fetches"] = fetch_count(*model);
    json["smallest_factor"] = model->smallest_factor();
    json["reciprocal"] = model->reciprocal();
    if (const auto cost = shader_cost(*model)) json["shader"] = cost_json(*cost);
  } else {
    const auto& baseline = std::get<BaselineBrdf>(fit.brdf);
    json["model"] = baseline_expression(baseline);
    json["bytes"] = baseline_bytes(baseline);
    if (const auto cost = evaluation_cost(baseline)) {
      json["table_reads"] = cost->table_reads;
      json["multiplies"] = cost->multiplies;
    }
  }
  if (file_bytes) json["file_bytes"] = *file_bytes;
  json["seconds"] = seconds;
  return to_text(json, 2);
}

}  // namespace burnish
