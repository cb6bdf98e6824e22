// SPDX-License-Identifier: Apache-2.0
#include "surface_info.h"

#include <iterator>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/math/angles.h>
#include <burnish/math/written_degrees.h>

namespace burnish::cli {

namespace {

using Object = nlohmann::ordered_json;

constexpr auto kReplace = Object::error_handler_t::replace;

Object entry_of(const SurfaceMap& map) {
  return {{"channels", map.channels()}, {"format", to_string(map.format())}, {"scale", map.scale()}};
}

}  // namespace

std::string surface_info(const SurfaceModel& surface, const std::string& name) {
  std::string text;
  const auto line = [&](std::string_view what, const std::string& says) {
    fmt::format_to(std::back_inserter(text), "{:<13}{}\n", what, says);
  };
  const SpatialBrdf& brdf = surface.brdf;
  line("name", name);
  line("format", "surface");
  line("texels", fmt::format("{} x {}", brdf.width(), brdf.height()));
  line("channels", fmt::format("{}", brdf.channels()));
  line("lobes", fmt::format("{}, {} widened for mip levels, {} bytes", brdf.own_lobes(),
                            brdf.widened().size(), brdf.lobes().bytes()));
  for (const SurfaceMap& map : std::span(brdf.maps().weights).first(brdf.own_lobes()))
    line("weights", fmt::format("{} channel{}, {}, up to {:.4g}", map.channels(),
                                map.channels() == 1 ? "" : "s", to_string(map.format()), map.scale()));
  line("frames", fmt::format("normals {}, tangents {}", brdf.maps().normals ? "from a map" : "of the plane",
                             brdf.maps().tangents ? "from a map" : "along u"));
  line("bytes", fmt::format("{}, {} a texel", brdf.bytes(), brdf.weight_bytes() + brdf.frame_bytes()));
  const SurfaceAlbedo albedo = surface_albedo(brdf);
  line("albedo", fmt::format("mean {:.4f}; at most {:.4f}, in texel ({}, {}) at theta_i = {:.0f} degrees",
                             albedo.mean, albedo.largest, albedo.x, albedo.y, degrees(albedo.theta_i)));
  const double texels = static_cast<double>(brdf.width()) * brdf.height();
  line("above one", fmt::format("{} texels, {:.2f} %", albedo.above_one,
                                100 * static_cast<double>(albedo.above_one) / texels));
  line("notes", surface.notes);
  return text;
}

std::string surface_info_json(const SurfaceModel& surface, const std::string& name) {
  const SpatialBrdf& brdf = surface.brdf;
  const SurfaceAlbedo albedo = surface_albedo(brdf);
  Object weights = Object::array();
  for (const SurfaceMap& map : std::span(brdf.maps().weights).first(brdf.own_lobes()))
    weights.push_back(entry_of(map));
  return Object{{"name", name},
                {"format", "surface"},
                {"width", brdf.width()},
                {"height", brdf.height()},
                {"channels", brdf.channels()},
                {"lobes", brdf.own_lobes()},
                {"widened_lobes", brdf.widened().size()},
                {"lobe_bytes", brdf.lobes().bytes()},
                {"weights", std::move(weights)},
                {"normals", brdf.maps().normals.has_value()},
                {"tangents", brdf.maps().tangents.has_value()},
                {"bytes", brdf.bytes()},
                {"albedo",
                 {{"mean", albedo.mean},
                  {"largest", albedo.largest},
                  {"texel", {albedo.x, albedo.y}},
                  {"theta_i_deg", written_degrees(albedo.theta_i)},
                  {"texels_above_one", albedo.above_one}}},
                {"notes", Object::parse(surface.notes)}}
      .dump(2, ' ', false, kReplace);
}

}  // namespace burnish::cli
