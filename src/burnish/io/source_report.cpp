#include <array>

#include <nlohmann/json.hpp>

#include <burnish/io/source_report.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/mirror_asymmetry.h>

namespace burnish {

namespace {

constexpr std::size_t kReciprocityPairs = 20000;
constexpr std::array kAlbedoAngles{0.0, radians(30), radians(60)};

}  // namespace

SourceReport report_on(const Source& source) {
  SourceReport report{source,
                      albedo_curve(source.ref(), kAlbedoAngles),
                      reciprocity_error(source.ref(), kReciprocityPairs, 1),
                      std::get_if<FactoredBrdf>(&source.brdf),
                      {}};
  if (source.ref().isotropic()) report.mirror_asymmetry = mirror_asymmetry(source.ref());
  return report;
}

std::string to_json(const SourceReport& report) {
  const auto& [source, albedos, reciprocity, model, mirror_asymmetry] = report;
  const Findings& findings = source.findings;
  nlohmann::ordered_json json{{"name", source.name},
                              {"format", findings.format},
                              {"description", findings.description},
                              {"channels", source.ref().channels()},
                              {"isotropic", source.ref().isotropic()},
                              {"lambda_nm", findings.lambda_nm},
                              {"illuminant", findings.illuminant},
                              {"conventions", findings.conventions},
                              {"samples", findings.sample_count},
                              {"holes", findings.hole_count},
                              {"negatives", findings.negative_count},
                              {"most_negative", findings.most_negative},
                              {"theta_i_deg", {degrees(findings.theta_i_min), degrees(findings.theta_i_max)}},
                              {"theta_o_deg", {degrees(findings.theta_o_min), degrees(findings.theta_o_max)}},
                              {"reciprocity_error", reciprocity.mean},
                              {"reciprocity_pairs", reciprocity.pairs}};
  if (mirror_asymmetry) json["mirror_asymmetry"] = *mirror_asymmetry;
  for (const auto& [theta_i, phi_i, albedo] : albedos)
    json["albedo"].push_back({{"theta_i_deg", degrees(theta_i)},
                              {"phi_i_deg", degrees(phi_i)},
                              {"albedo", albedo.albedo},
                              {"clamped_albedo", albedo.clamped},
                              {"unknown_fraction", albedo.unknown_fraction}});
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
