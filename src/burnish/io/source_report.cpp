// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/io/source_report.h>
#include <burnish/math/angles.h>
#include <burnish/math/luminance.h>
#include <burnish/math/written_degrees.h>
#include <burnish/reflectance/direct_share.h>
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

/// Returns the direct share that a file states, linear between its angles.
double stated_direct(std::span<const DirectShare> stated, double theta_i) noexcept {
  const auto above =
      std::upper_bound(stated.begin(), stated.end(), theta_i,
                       [](double angle, const DirectShare& share) { return angle < share.theta_i; });
  if (above == stated.begin()) return above->share;
  const DirectShare& low = *(above - 1);
  if (above == stated.end()) return low.share;
  return std::lerp(low.share, above->share, (theta_i - low.theta_i) / (above->theta_i - low.theta_i));
}

/// Returns one number of three channels, their luminance, or of others, their mean.
double one_number(std::span<const double> values) noexcept {
  if (values.size() == 3) return luminance({values[0], values[1], values[2]});
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

TotalAt total_at(const Source& source, double theta_i) {
  const Vec3 wi = spherical_direction(theta_i, 0);
  TotalAt total{.theta_i = theta_i};
  if (const auto* patches = std::get_if<PatchTable>(&source.brdf)) {
    std::vector<double> direct, scattered;
    for (std::size_t c = 0; c < patches->channels(); ++c) {
      const LightShares shares = light_shares(*patches, wi, c);
      direct.push_back(shares.direct);
      scattered.push_back(shares.scattered);
    }
    total.direct = one_number(direct);
    total.scattered = one_number(scattered);
  } else if (const auto* tree = std::get_if<TensorTree>(&source.brdf)) {
    const LightShares shares = light_shares(*tree, wi);
    total.direct = shares.direct;
    total.scattered = shares.scattered;
  } else {
    total.scattered = one_number(directional_albedo(source.ref().unclamped(), wi).albedo);
    if (!source.findings.direct.empty()) total.direct = stated_direct(source.findings.direct, theta_i);
  }
  return total;
}

}  // namespace

PartTotals totals_of(const Source& source) {
  PartTotals totals{source.findings.block.value_or(BsdfBlock{}), {}};
  for (const double theta_i : kAlbedoAngles) totals.totals.push_back(total_at(source, theta_i));
  return totals;
}

SourceReport report_on(const Source& source) {
  SourceReport report{source,
                      reported_albedos(source),
                      reciprocity_error(source.ref(), kReciprocityPairs, 1),
                      std::get_if<FactoredBrdf>(&source.brdf),
                      {},
                      {},
                      source.findings.warnings};
  if (!source.findings.blocks.empty() || !source.findings.direct.empty())
    report.totals.push_back(totals_of(source));
  if (auto warning = energy_warning(source, report.albedos)) report.warnings.push_back(*std::move(warning));
  if (source.ref().isotropic()) report.mirror_asymmetry = mirror_asymmetry(source.ref());
  return report;
}

std::string to_json(const SourceReport& report) {
  const auto& [source, albedos, reciprocity, model, mirror_asymmetry, totals, warnings] = report;
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
  for (const auto& [block, at] : totals)
    for (const TotalAt& total : at)
      json["totals"].push_back({{"part", to_string(block.part)},
                                {"band", block.band},
                                {"theta_i_deg", written_degrees(total.theta_i)},
                                {"direct", total.direct},
                                {"scattered", total.scattered}});
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
