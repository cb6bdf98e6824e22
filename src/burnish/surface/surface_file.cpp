// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/compact_extension.h>
#include <burnish/factors/model_extension.h>
#include <burnish/surface/surface_exr.h>
#include <burnish/surface/surface_file.h>

namespace burnish {

namespace {

constexpr int kVersion = 1, kWidenedVersion = 2;
constexpr std::size_t kHeadItems = 4, kMapItems = 4;
constexpr int kHasNormals = 1, kHasTangents = 2;
// The numbers that stand for them in files: places in this list.
constexpr std::array kFormats{TableFormat::unorm8, TableFormat::half};

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

}  // namespace

std::vector<const SurfaceMap*> all_maps(const SpatialBrdf& brdf) {
  const SurfaceMaps& maps = brdf.maps();
  std::vector<const SurfaceMap*> all;
  for (const SurfaceMap& map : std::span(maps.weights).first(brdf.own_lobes())) all.push_back(&map);
  if (maps.normals) all.push_back(&*maps.normals);
  if (maps.tangents) all.push_back(&*maps.tangents);
  return all;
}

std::string format_surface_as(const std::filesystem::path& name, const SurfaceModel& surface) {
  return name.extension() == ".exr" ? format_surface_exr(surface) : format_surface(surface);
}

std::string format_surface(const SurfaceModel& surface) {
  return format_compact_with({.brdf = surface.brdf.lobes(), .lambda_nm = {}, .notes = surface.notes},
                             [&](CborWriter& cbor) { write_maps(cbor, surface.brdf); });
}

SurfaceModel parse_surface(const FileBytes& file) {
  if (looks_like_exr(file.bytes)) return read_surface_exr(file);
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
