// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/json_integer.h>
#include <burnish/library/material_record.h>

namespace burnish {

namespace {
using Json = nlohmann::ordered_json;
}  // namespace

std::string to_json(const MaterialRecord& record) {
  Json json{{"name", record.name}, {"argument", record.argument}, {"key", record.key}};
  if (!record.fitted()) {
    json["reason"] = record.reason;
  } else {
    auto& files = json["files"] = Json::array();
    for (const RecordedFile& file : record.files)
      files.push_back({{"path", file.path}, {"staged", file.staged}, {"sha256", file.sha256}});
    json["format"] = record.format;
    json["model"] = record.model;
    json["bytes"] = record.bytes;
    if (record.fetches) json["fetches"] = *record.fetches;
    for (const auto& [figure, value] : kRecordFigures)
      if (record.*value && std::isfinite(*(record.*value))) json[figure] = *(record.*value);
    json["warnings"] = record.warnings;
  }
  json["seconds"] = record.seconds;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

MaterialRecord parse_material_record(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    MaterialRecord record{.name = json.at("name"), .argument = json.at("argument"), .key = json.at("key")};
    record.reason = json.value("reason", "");
    record.seconds = json.at("seconds");
    if (!record.fitted()) return record;
    for (const Json& file : json.at("files"))
      record.files.push_back({file.at("path"), file.at("staged"), file.at("sha256")});
    record.format = json.at("format");
    record.model = json.at("model");
    record.bytes = static_cast<std::size_t>(integer_at(json, "bytes"));
    if (const auto fetches = json.find("fetches"); fetches != json.end())
      record.fetches = static_cast<std::size_t>(integer_at(json, "fetches"));
    for (const auto& [figure, value] : kRecordFigures)
      if (const auto found = json.find(figure); found != json.end()) record.*value = found->get<double>();
    record.warnings = json.at("warnings").get<std::vector<std::string>>();
    return record;
  } catch (const nlohmann::json::exception& error) {
    throw Error(std::string("expected a record of a material, found ") + error.what());
  }
}

}  // namespace burnish
