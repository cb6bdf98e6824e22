// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/io/source_report.h>
#include <burnish/math/angles.h>
#include <burnish/math/written_degrees.h>
#include <burnish/reflectance/mirror_asymmetry.h>

namespace burnish {

namespace {

constexpr std::size_t kReciprocityPairs = 20000;
constexpr std::array kAlbedoAngles{0.0, radians(30), radians(60)};
constexpr double kMostFilled = 0.05;     // of the hemisphere; up to it, unknown directions count as the rest
constexpr double kMostReflected = 1.02;  // share of the received light; a greater one is no noise

/// Returns one sentence if a measurement reflects more than it receives.
std::optional<std::string> energy_warning(const Source& source, const std::vector<AlbedoAt>& albedos) {
  if (!is_measurement(source)) return std::nullopt;
  double most = 0, theta = 0;
  for (const AlbedoAt& at : albedos)
    if (const double albedo = std::ranges::max(at.albedo.albedo); albedo > most)
      most = albedo, theta = at.theta_i;
  if (most <= kMostReflected) return std::nullopt;
  return fmt::format("More light is {} than received: {:.0f} % at theta_i = {:.0f} degrees.{}",
                     source.findings.transmits() ? "transmitted" : "reflected", 100 * most, degrees(theta),
                     source.samples() ? " Reflectance factors? --brf divides them by pi." : "");
}

/// Returns the albedos of a source. Tables of patches are summed exactly. If a small share of the hemisphere is
/// unknown, that share is taken to reflect as the rest does.
std::vector<AlbedoAt> reported_albedos(const Source& source) {
  std::vector<AlbedoAt> albedos = albedo_curve(source.ref(), kAlbedoAngles);
  for (AlbedoAt& at : albedos) {
    DirectionalAlbedo& albedo = at.albedo;
    if (const auto* patches = std::get_if<PatchTable>(&source.brdf);
        patches && albedo.clamped == albedo.albedo)
      for (std::size_t c = 0; c < patches->channels(); ++c)
        albedo.albedo[c] = albedo.clamped[c] = patches->albedo(spherical_direction(at.theta_i, at.phi_i), c);
    if (albedo.unknown_fraction > kMostFilled) continue;
    for (std::vector<double>* values : {&albedo.albedo, &albedo.clamped})
      for (double& value : *values) value /= 1 - albedo.unknown_fraction;
  }
  return albedos;
}

}  // namespace

SourceReport report_on(const Source& source) {
  SourceReport report{source,
                      reported_albedos(source),
                      reciprocity_error(source.ref(), kReciprocityPairs, 1),
                      std::get_if<FactoredBrdf>(&source.brdf),
                      {},
                      source.findings.warnings};
  if (auto warning = energy_warning(source, report.albedos)) report.warnings.push_back(*std::move(warning));
  if (source.ref().isotropic()) report.mirror_asymmetry = mirror_asymmetry(source.ref());
  return report;
}

std::string to_json(const SourceReport& report) {
  const auto& [source, albedos, reciprocity, model, mirror_asymmetry, warnings] = report;
  const Findings& findings = source.findings;
  nlohmann::ordered_json json{
      {"name", source.name},
      {"format", findings.format},
      {"description", findings.description},
      {"channels", source.ref().channels()},
      {"isotropic", source.ref().isotropic()},
      {"lambda_nm", findings.lambda_nm},
      {"illuminant", findings.illuminant},
      {"conventions", findings.conventions},
      {"warnings", warnings},
      {"left_out", findings.left_out},
      {"comments", findings.comments},
      {"samples", findings.sample_count},
      {"holes", findings.hole_count},
      {"negatives", findings.negative_count},
      {"most_negative", findings.most_negative},
      {"theta_i_deg", {written_degrees(findings.theta_i_min), written_degrees(findings.theta_i_max)}},
      {"theta_o_deg", {written_degrees(findings.theta_o_min), written_degrees(findings.theta_o_max)}},
      {"reciprocity_error", reciprocity.mean},
      {"reciprocity_pairs", reciprocity.pairs}};
  if (findings.block) {
    json["part"] = to_string(findings.block->part);
    json["band"] = findings.block->band;
  }
  for (const BsdfBlock& block : findings.blocks)
    json["parts"].push_back(
        {{"part", to_string(block.part)}, {"band", block.band}, {"read", block == findings.block}});
  if (mirror_asymmetry) json["mirror_asymmetry"] = *mirror_asymmetry;
  for (const auto& [theta_i, phi_i, albedo] : albedos)
    json["albedo"].push_back({{"theta_i_deg", written_degrees(theta_i)},
                              {"phi_i_deg", written_degrees(phi_i)},
                              {"albedo", albedo.albedo},
                              {"clamped_albedo", albedo.clamped},
                              {"unknown_fraction", albedo.unknown_fraction}});
  if (!findings.notes.empty()) {
    auto notes = nlohmann::ordered_json::parse(findings.notes, nullptr, false);
    if (notes.is_object()) json["notes"] = std::move(notes);
  }
  if (const auto bytes = source.bytes()) json["bytes"] = *bytes;
  if (model) {
    json["table_bytes"] = model->table_bytes();
    json["lobes"] = model->lobes().size();
    for (const Lobe& lobe : model->lobes()) json["scales"].push_back(lobe.scale);
    json["expression"] = model_expression(*model);
    json["reciprocal"] = model->reciprocal();
    for (const Table& table : model->tables())
      json["tables"].push_back({{"name", table.name},
                                {"width", table.layout.width},
                                {"height", table.layout.height},
                                {"channels", table.channels},
                                {"warp", to_string(table.layout.warp)},
                                {"format", to_string(table.format)},
                                {"bytes", table.byte_count()}});
  }
  // File names need not be UTF-8.
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace burnish
