// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>

#include <nlohmann/json.hpp>

#include <burnish/capture/surface_report_json.h>
#include <burnish/fitting/fit_report_json.h>

namespace burnish {

const char* name_of(NormalsFrom normals) noexcept {
  return normals == NormalsFrom::capture ? "capture" : normals == NormalsFrom::flat ? "flat" : "estimated";
}

nlohmann::ordered_json json_of(const SurfaceReport& report) {
  using Object = nlohmann::ordered_json;
  const auto number = [](const std::optional<double>& value) -> Object {
    if (!value || !std::isfinite(*value)) return nullptr;
    return *value;
  };
  const auto score = [&](const PictureScore& of) {
    return Object{
        {"pictures", of.pictures}, {"psnr", number(of.psnr)}, {"psnr_of_all", number(of.psnr_of_all)}};
  };
  Object left_out = Object::array();
  for (const auto& [file, why] : report.left_out) left_out.push_back({{"file", file}, {"why", why}});
  return Object{{"width", report.width},
                {"height", report.height},
                {"pictures", report.pictures},
                {"lights_and_views", report.lights_and_views},
                {"of_samples", report.of_samples},
                {"left_out", std::move(left_out)},
                {"missing_pixels", report.missing_pixels},
                {"clipped_pixels", report.clipped_pixels},
                {"texels_without_data", report.texels_without_data},
                {"normals", name_of(report.normals)},
                {"lobes", report.lobes},
                {"exposure", report.exposure},
                {"fitted", score(report.fitted)},
                {"held_out", score(report.held_out)},
                {"weight_bytes", report.weight_bytes},
                {"frame_bytes", report.frame_bytes},
                {"lobe_bytes", report.lobe_bytes},
                {"bytes_a_texel", report.bytes_a_texel}};
}

std::string report_json(const SurfaceReport& report) {
  return to_text(json_of(report), -1);
}

}  // namespace burnish
