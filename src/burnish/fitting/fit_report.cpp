// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/fitting/fit_report.h>
#include <burnish/fitting/fit_report_json.h>
#include <burnish/metrics/figures_json.h>

namespace burnish {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 3> kLossNames = {"image", "relative", "log_cos"};
constexpr std::array<std::string_view, 5> kStopNames = {"noise", "floor", "gain", "largest",
                                                        "cross-validation"};

Json json_of(const OneLobeReport& report) {
  Json json{{"samples", report.samples},
            {"smooth", report.smooth},
            {"floor", report.floor},
            {"reweightings", report.reweightings},
            {"rms_log_before", report.summary.error_before},
            {"rms_log_after", report.summary.error_after},
            {"iterations", report.summary.iterations},
            {"stop_reason", to_string(report.summary.stop_reason)}};
  for (const auto& [table, share] : report.smooth_shares) json["smooth_shares"][table] = share;
  if (report.relative) json["relative"] = *report.relative;
  if (report.relative_cross_validated) json["relative_cross_validated"] = *report.relative_cross_validated;
  return json;
}

Json json_of(const LobesReport& report) {
  Json json = Json::object();
  if (report.search) {
    Json kept = Json::array();
    for (const auto& [change, objective] : report.search->kept)
      kept.push_back({{"change", change}, {"objective", objective}});
    json["search"] = {{"trials", report.search->trials}, {"kept", std::move(kept)}};
  }
  if (report.budget > 0) json["budget"] = report.budget;
  if (report.fetches > 0) json["fetches"] = report.fetches;
  for (const FetchTrial& trial : report.fetch_trials)
    json["fetch_trials"].push_back(
        {{"fetches", trial.fetches}, {"lobes", trial.lobes}, {"error", trial.error}});
  if (report.smooth) json["smooth"] = *report.smooth;
  json["samples"] = report.samples;
  json["lobes"] = report.lobes;
  json["loss"] = to_string(report.loss);
  json["iterations"] = report.summary.iterations;
  json["stop_reason"] = to_string(report.summary.stop_reason);
  json["objective"] = report.summary.error_after;
  return json;
}

Json json_of(const BaselineReport& report) {
  Json json{{"method", report.method}, {"budget", report.budget}};
  if (report.layouts_tried) json["layouts_tried"] = *report.layouts_tried;
  if (report.summary) {
    json["error_before"] = report.summary->error_before;
    json["error_after"] = report.summary->error_after;
  }
  if (report.starts) {
    json["starts"] = *report.starts;
    json["iterations"] = report.summary->iterations;
    json["stop_reason"] = to_string(report.summary->stop_reason);
  }
  return json;
}

Json json_of(const CompletionPrior& prior) {
  return {{"near_one", prior.near_one},
          {"spread", prior.spread},
          {"residual", prior.residual},
          {"noise", prior.noise}};
}

Json json_of(const CompletionReport& report) {
  Json json{{"samples", report.samples}, {"used", report.used}, {"book_materials", report.materials}};
  if (!report.nearest.empty()) json["nearest"] = report.nearest;
  json["brightness"] = json_of(report.brightness);
  json["colour"] = json_of(report.colour);
  json["relative_at_samples"] = report.relative;
  json["relative_left_out"] = report.relative_left_out;
  return json;
}

Json json_of(const EnergyReport& report) {
  return {{"largest_albedo_before", report.largest_albedo_before},
          {"largest_albedo_after", report.largest_albedo_after},
          {"iterations", report.iterations},
          {"psnr_before", report.before.psnr},
          {"relative_before", report.before.relative},
          {"psnr_after", report.after.psnr},
          {"relative_after", report.after.relative}};
}

Json json_of(const ErrorLevel& level) {
  Json json{{"relative", level.relative}};
  if (level.log_cos) json["log_cos"] = *level.log_cos;
  if (level.rms) json["rms"] = *level.rms;
  if (level.psnr) json["psnr"] = *level.psnr;
  return json;
}

Json json_of(const BudgetChoice& choice) {
  Json json{{"bytes", choice.bytes}, {"stop", to_string(choice.stop)}};
  if (choice.noise) json["noise"] = json_of(*choice.noise);
  for (const BudgetTrial& trial : choice.trials) {
    Json entry{{"bytes", trial.bytes}};
    entry.update(json_of(trial.error));
    json["trials"].push_back(std::move(entry));
  }
  return json;
}

Json json_of(const LogCovariance& covariance) {
  Json json{{"level", covariance.level}, {"spreads", covariance.spread}, {"noise", covariance.noise}};
  for (const TreePoint& inverse : covariance.inverse_length) {
    Json lengths = Json::array();
    for (const double by : inverse)
      if (by > 0) lengths.push_back(1 / by);
    json["lengths"].push_back(std::move(lengths));
  }
  return json;
}

Json json_of(const NodesReport& report) {
  Json json{{"target", "nodes"}, {"nodes", report.fitted}};
  if (report.outliers > 0) json["outliers"] = report.outliers;
  if (report.covariance) json["node_covariance"] = json_of(*report.covariance);
  if (report.held_out) json["node_held_out"] = json_of(*report.held_out);
  json["node_fit"] = json_of(report.at_fitted);
  if (report.at_held_out) json["node_test"] = json_of(*report.at_held_out);
  if (report.expected) json["node_expected"] = json_of(*report.expected);
  return json;
}

// Returns the cost of removing an SVD's negative values, in each of the usual ways.
Json json_of(const NegativeLobes& lobes) {
  return {{"negative_share", lobes.negative_share},
          {"bias", lobes.bias},
          {"sum_clamped", json_of(lobes.sum_clamped)},
          {"tables_clamped", json_of(lobes.tables_clamped)},
          {"biased", json_of(lobes.biased)}};
}

}  // namespace

std::string_view to_string(FitLoss loss) noexcept {
  return kLossNames[static_cast<std::size_t>(loss)];
}

std::string_view to_string(BudgetStop stop) noexcept {
  return kStopNames[static_cast<std::size_t>(stop)];
}

FitLoss parse_fit_loss(std::string_view name) {
  for (const FitLoss loss : {FitLoss::image, FitLoss::relative, FitLoss::log_cos})
    if (name == to_string(loss)) return loss;
  throw Error(fmt::format("loss: expected image, relative or log_cos, found '{}'", name));
}

std::optional<FitSummary> FitReport::summary() const {
  return std::visit(
      [](const auto& part) -> std::optional<FitSummary> {
        if constexpr (requires { part.summary; })
          return part.summary;
        else
          return std::nullopt;
      },
      how);
}

nlohmann::ordered_json json_of(const FitReport& report) {
  Json json{{"source", report.source}, {"source_format", report.source_format}};
  if (report.block) {
    json["part"] = to_string(report.block->part);
    if (!report.block->band.empty()) json["band"] = report.block->band;
  }
  json["symmetrized"] = report.symmetrized;
  json.update(std::visit([](const auto& part) { return json_of(part); }, report.how));
  if (report.budget_choice) json["budget_choice"] = json_of(*report.budget_choice);
  if (report.nodes) json.update(json_of(*report.nodes));
  if (report.energy) json["conserve_energy"] = json_of(*report.energy);
  if (report.held_out) json.update(json_of(*report.held_out));
  const auto* baseline = std::get_if<BaselineReport>(&report.how);
  if (baseline && baseline->negative_lobes) json["negative_lobes"] = json_of(*baseline->negative_lobes);
  return json;
}

std::string to_text(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string to_json(const FitReport& report) {
  return to_text(json_of(report), -1);
}

}  // namespace burnish
