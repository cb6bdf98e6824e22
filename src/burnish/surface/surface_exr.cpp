// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/factors/model_extension.h>
#include <burnish/factors/shallow_json.h>
#include <burnish/json_integer.h>
#include <burnish/surface/surface_exr.h>

namespace burnish {

namespace {

using Json = nlohmann::json;

constexpr int kExrVersion = 1;
constexpr int kMaxDepth = 4;  // of the JSON

// The OpenEXR file's maps.
static_assert(kMaxPartSide == kMaxMapSide);

std::vector<std::string> map_names(std::size_t weights, bool normals, bool tangents) {
  std::vector<std::string> names;
  for (std::size_t j = 0; j < weights; ++j) names.push_back(fmt::format("map_weight{}", j));
  if (normals) names.emplace_back("map_normals");
  if (tangents) names.emplace_back("map_tangents");
  return names;
}

std::vector<float> values_of(const SurfaceMap& map) {
  std::vector<float> values;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const SurfaceMap::Value value = map.texel(x, y);
      values.insert(values.end(), value.begin(), value.begin() + static_cast<std::ptrdiff_t>(map.channels()));
    }
  return values;
}

// A map in the JSON of the OpenEXR file, and the part that it says.
struct NamedMap {
  ExrPart part;
  TableFormat format;
  float scale;
};
NamedMap named_map(const Json& json, const std::string& name, int width, int height) {
  if (const auto found = json.at("name").get<std::string>(); found != name)
    throw Error(fmt::format("maps: expected '{}', found '{}'", name, found));
  const TableFormat format = parse_table_format(json.at("format").get<std::string>());
  const int channels = integer_at(json, "channels");
  if (channels < 1 || channels > static_cast<int>(kMaxMapChannels))
    throw Error(
        fmt::format("map '{}': expected 1 to {} channels, found {}", name, kMaxMapChannels, channels));
  return {.part = {.name = name,
                   .width = width,
                   .height = height,
                   .channels = static_cast<std::size_t>(channels),
                   .half = format == TableFormat::half,
                   .values = {}},
          .format = format,
          .scale = json.at("scale").get<float>()};
}
std::vector<NamedMap> named_maps(const Json& json) {
  const Json& list = json.at("maps");
  const bool normals = json.at("normals").get<bool>(), tangents = json.at("tangents").get<bool>();
  const std::size_t frames = std::size_t{normals} + std::size_t{tangents};
  if (list.size() <= frames)
    throw Error(fmt::format("maps: expected more than {}, found {}", frames, list.size()));
  const int width = integer_at(json, "width"), height = integer_at(json, "height");
  std::vector<NamedMap> maps;
  for (const std::string& name : map_names(list.size() - frames, normals, tangents))
    maps.push_back(named_map(list.at(maps.size()), name, width, height));
  return maps;
}

// Values that the stated format does not hold are refused.
SurfaceMap stored_map(const NamedMap& named, std::span<const float> values) {
  std::vector<float> within(values.begin(), values.end());  // the largest code may be rounded up
  if (named.format == TableFormat::unorm8)
    for (float& value : within) value = std::min(value, named.scale);
  SurfaceMap map(named.part.width, named.part.height, named.part.channels, named.format, named.scale, within);
  if (map.scale() != named.scale || !std::ranges::equal(values_of(map), values))
    throw Error(fmt::format("part '{}': expected values that {} times {} holds, found others",
                            named.part.name, to_string(named.format), named.scale));
  return map;
}

Json to_json(const SpatialBrdf& brdf) {
  const SurfaceMaps& maps = brdf.maps();
  const std::vector<const SurfaceMap*> all = all_maps(brdf);
  Json list = Json::array(), widened = Json::array();
  for (const std::string& name :
       map_names(brdf.own_lobes(), maps.normals.has_value(), maps.tangents.has_value())) {
    const SurfaceMap& map = *all[list.size()];
    list.push_back({{"name", name},
                    {"channels", map.channels()},
                    {"format", to_string(map.format())},
                    {"scale", map.scale()}});
  }
  for (const auto& [lobe, variance] : brdf.widened())
    widened.push_back({{"lobe", lobe}, {"variance", variance}});
  return {{"version", kExrVersion},
          {"width", brdf.width()},
          {"height", brdf.height()},
          {"normals", maps.normals.has_value()},
          {"tangents", maps.tangents.has_value()},
          {"maps", std::move(list)},
          {"widened", std::move(widened)}};
}

}  // namespace

SurfaceModel read_surface_exr(const FileBytes& file) {
  const ExtendedModel read = parse_extended_model(file, [](const std::string& text) {
    const Json json = parse_shallow(text, kMaxDepth);
    if (const int version = integer_at(json, "version"); version != kExrVersion)
      throw Error(fmt::format("surface: expected version {}, found {}", kExrVersion, version));
    std::vector<ExrPart> parts;
    for (NamedMap& map : named_maps(json)) parts.push_back(std::move(map.part));
    return parts;
  });
  try {
    const Json json = Json::parse(read.extension.json);
    std::vector<SurfaceMap> maps;
    for (const NamedMap& named : named_maps(json))
      maps.push_back(stored_map(named, read.extension.parts[maps.size()].values));
    SurfaceMaps sorted;
    const auto take_last = [&](const char* member, std::optional<SurfaceMap>& map) {
      if (!json.at(member).get<bool>()) return;
      map = std::move(maps.back());
      maps.pop_back();
    };
    take_last("tangents", sorted.tangents);
    take_last("normals", sorted.normals);
    sorted.weights = std::move(maps);
    std::vector<WidenedLobe> widened;
    for (const Json& copy : json.at("widened")) {
      const auto lobe = static_cast<std::size_t>(integer_at(copy, "lobe"));
      widened.push_back({lobe, copy.at("variance").get<double>()});
    }
    return {.brdf = SpatialBrdf(read.model.brdf, std::move(sorted), std::move(widened)),
            .notes = read.model.notes};
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file.name, error.what()));
  } catch (const Json::exception& error) {
    throw Error(fmt::format("{}: expected a surface, found: {}", file.name, error.what()));
  }
}

std::string format_surface_exr(const SurfaceModel& surface) {
  const SpatialBrdf& brdf = surface.brdf;
  const Json json = to_json(brdf);
  ModelExtension extension{.json = json.dump(), .parts = {}};
  const std::vector<const SurfaceMap*> maps = all_maps(brdf);
  for (NamedMap& named : named_maps(json)) {
    named.part.values = values_of(*maps[extension.parts.size()]);
    extension.parts.push_back(std::move(named.part));
  }
  return format_extended_model({.brdf = brdf.lobes(), .lambda_nm = {}, .notes = surface.notes},
                               std::move(extension));
}

}  // namespace burnish
