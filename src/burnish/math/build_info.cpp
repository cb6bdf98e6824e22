// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <thread>

#include <Eigen/Core>
#include <OpenEXR/OpenEXRConfig.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <png.h>
#include <pugixml.hpp>
#include <sqlite3.h>
#include <tbb/version.h>
#include <zstd.h>

#include <burnish/math/build_info.h>
#include <burnish/math/highway_targets.h>

#if __has_include(<embree4/rtcore_config.h>)
#include <embree4/rtcore_config.h>
#else
#include <embree3/rtcore_config.h>
#endif

// after the list of its targets
#include <hwy/highway.h>
#include <hwy/targets.h>

namespace burnish {

BuildInfo build_info() {
  BuildInfo info{
      .instruction_sets = {}, .threads = std::max(std::thread::hardware_concurrency(), 1u), .libraries = {}};
  for (const auto target : hwy::SupportedAndGeneratedTargets())
    info.instruction_sets.emplace_back(hwy::TargetName(target));
  info.libraries = {
      {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
      {"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"Highway", fmt::format("{}.{}.{}", HWY_MAJOR, HWY_MINOR, HWY_PATCH)},
      {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                    NLOHMANN_JSON_VERSION_PATCH)},
      {"OpenEXR", OPENEXR_VERSION_STRING},
      {"libpng", PNG_LIBPNG_VER_STRING},
      {"pugixml", fmt::format("{}.{}", PUGIXML_VERSION / 1000, PUGIXML_VERSION % 1000 / 10)},
      {"Embree", RTC_VERSION_STRING},
      {"libepoxy", BURNISH_EPOXY_VERSION},
      {"SQLite", SQLITE_VERSION},
      {"TBB", TBB_VERSION_STRING},
      {"zstd", ZSTD_VERSION_STRING}};
  return info;
}

}  // namespace burnish
