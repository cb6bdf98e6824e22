#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/factors/compact_extension.h>
#include <burnish/factors/model_extension.h>
#include <burnish/factors/shallow_json.h>
#include <burnish/json_integer.h>
#include <burnish/surface/surface_file.h>

namespace burnish {

namespace {

using Json = nlohmann::json;

constexpr int kVersion = 1, kWidenedVersion = 2;
constexpr std::size_t kHeadItems = 4, kMapItems = 4;
constexpr int kHasNormals = 1, kHasTangents = 2;
constexpr int kMaxDepth = 4;  // of the JSON of an OpenEXR file
// The numbers that stand for them in files: places in this list.
constexpr std::array kFormats{TableFormat::unorm8, TableFormat::half};

/// Weights, then normals and tangents.
std::vector<const SurfaceMap*> all_maps(const SpatialBrdf& brdf) {
  const SurfaceMaps& maps = brdf.maps();
  std::vector<const SurfaceMap*> all;
  for (const SurfaceMap& map : std::span(maps.weights).first(brdf.own_lobes())) all.push_back(&map);
  if (maps.normals) all.push_back(&*maps.normals);
  if (maps.tangents) all.push_back(&*maps.tangents);
  return all;
}

void write_maps(CborWriter& cbor, const SpatialBrdf& brdf) {
  const std::vector<const SurfaceMap*> maps = all_maps(brdf);
  const std::span<const WidenedLobe> widened = brdf.widened();
  cbor.list(kHeadItems + (widened.empty() ? 0 : 1) + kMapItems * maps.size());
  cbor.integer(widened.empty() ? kVersion : kWidenedVersion);
  cbor.integer(brdf.width());
  cbor.integer(brdf.height());
  cbor.integer((brdf.maps().normals ? kHasNormals : 0) + (brdf.maps().tangents ? kHasTangents : 0));
  if (!widened.empty()) {
    cbor.list(2 * widened.size());
    for (const auto& [lobe, variance] : widened) {
      cbor.integer(static_cast<std::int64_t>(lobe));
      cbor.number(variance);
    }
  }
  for (const SurfaceMap* map : maps) {
    cbor.integer(static_cast<std::int64_t>(map->channels()));
    cbor.integer(map->format() == kFormats[0] ? 0 : 1);
    cbor.number(static_cast<double>(map->scale()));
    cbor.bytes(map->stored_bytes());
  }
}

SurfaceMap read_map(CborReader& cbor, int width, int height) {
  const auto at = cbor.offset();
  const auto channels = static_cast<std::size_t>(cbor.integer("a map's channels", 1, kMaxMapChannels));
  const TableFormat format = kFormats[static_cast<std::size_t>(
      cbor.integer("a map's format", 0, static_cast<std::int64_t>(kFormats.size()) - 1))];
  const double scale = cbor.number("a map's scale");
  const auto narrow = static_cast<float>(scale);
  if (static_cast<double>(narrow) != scale)
    cbor.fail(at, "a map's scale that a float holds", fmt::format("{}", scale));
  const std::uint64_t texels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  const auto bytes = cbor.bytes("the texels of a map", texels * texel_bytes(format, channels));
  try {
    return {width, height, channels, format, narrow, bytes};
  } catch (const Error& error) {
    cbor.fail(at, "a sound map", error.what());
  }
}

std::vector<WidenedLobe> read_widened(CborReader& cbor, std::size_t lobes) {
  const auto at = cbor.offset();
  const std::size_t items = cbor.list("widened lobes", 2, 2 * (lobes - 1));
  if (items % 2 != 0) cbor.fail(at, "pairs of widened lobes", fmt::format("{} items", items));
  std::vector<WidenedLobe> widened(items / 2);
  for (WidenedLobe& copy : widened) {
    copy.lobe = static_cast<std::size_t>(
        cbor.integer("a widened lobe's original", 0, static_cast<std::int64_t>(lobes) - 1));
    copy.variance = cbor.number("a widened lobe's variance");
  }
  return widened;
}

struct ReadMaps {
  SurfaceMaps maps;
  std::vector<WidenedLobe> widened;
};
ReadMaps read_maps(CborReader& cbor, const Model& model) {
  const std::size_t lobes = model.brdf.lobes().size();
  const auto at = cbor.offset();
  const std::size_t items = cbor.list("a surface", kHeadItems, kHeadItems + 1 + kMapItems * (lobes + 2));
  const auto version = cbor.integer("the version of a surface", kVersion, kWidenedVersion);
  const auto width = static_cast<int>(cbor.integer("a surface's width", 1, kMaxMapSide));
  const auto height = static_cast<int>(cbor.integer("a surface's height", 1, kMaxMapSide));
  const auto has = cbor.integer("which maps a surface has", 0, kHasNormals + kHasTangents);
  ReadMaps read;
  if (version == kWidenedVersion) {
    if (lobes < 2) cbor.fail(at, "a surface of one lobe in version 1", "version 2");
    read.widened = read_widened(cbor, lobes);
  }
  const std::size_t own = lobes - read.widened.size(),
                    maps = own + ((has & kHasNormals) != 0) + ((has & kHasTangents) != 0);
  if (items != kHeadItems + (version == kWidenedVersion) + kMapItems * maps)
    cbor.fail(at, fmt::format("a surface of {} maps", maps), fmt::format("{} items", items));
  for (std::size_t j = 0; j < own; ++j) read.maps.weights.push_back(read_map(cbor, width, height));
  if ((has & kHasNormals) != 0) read.maps.normals = read_map(cbor, width, height);
  if ((has & kHasTangents) != 0) read.maps.tangents = read_map(cbor, width, height);
  return read;
}

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
  return {{"version", kVersion},
          {"width", brdf.width()},
          {"height", brdf.height()},
          {"normals", maps.normals.has_value()},
          {"tangents", maps.tangents.has_value()},
          {"maps", std::move(list)},
          {"widened", std::move(widened)}};
}

SurfaceModel read_exr(const FileBytes& file) {
  const ExtendedModel read = parse_extended_model(file, [](const std::string& text) {
    const Json json = parse_shallow(text, kMaxDepth);
    if (const int version = integer_at(json, "version"); version != kVersion)
      throw Error(fmt::format("surface: expected version {}, found {}", kVersion, version));
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

}  // namespace

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

std::string format_surface_as(const std::filesystem::path& name, const SurfaceModel& surface) {
  return name.extension() == ".exr" ? format_surface_exr(surface) : format_surface(surface);
}

std::string format_surface(const SurfaceModel& surface) {
  return format_compact_with({.brdf = surface.brdf.lobes(), .lambda_nm = {}, .notes = surface.notes},
                             [&](CborWriter& cbor) { write_maps(cbor, surface.brdf); });
}

SurfaceModel parse_surface(const FileBytes& file) {
  if (looks_like_exr(file.bytes)) return read_exr(file);
  ReadMaps read;
  Model model =
      parse_compact_with(file, [&](CborReader& cbor, const Model& lobes) { read = read_maps(cbor, lobes); });
  try {
    return {.brdf = SpatialBrdf(std::move(model.brdf), std::move(read.maps), std::move(read.widened)),
            .notes = std::move(model.notes)};
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file.name, error.what()));
  }
}

bool looks_like_surface(std::span<const std::byte> head) noexcept {
  return looks_like_extended_compact(head) || looks_like_extended_model(head);
}

}  // namespace burnish
