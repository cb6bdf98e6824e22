// SPDX-License-Identifier: Apache-2.0
#include "cost_sources.h"

#include <burnish/io/open_source.h>
#include <burnish/reflectance/rgl_builder.h>

namespace burnish::reports {

namespace {

Source virtual_measurement(const std::string& name, const std::string& formula) {
  const Source source = open_source(formula, {});
  return {.name = name, .brdf = make_rgl_table(source.ref()), .findings = {}};
}

}  // namespace

std::vector<Source> cost_sources(const ReportOptions& options) {
  std::vector<Source> sources;
  if (options.data)
    for (const fs::path& file : files_in(*options.data / "rgl")) {
      Source source = open_source(file.string(), {});
      source.name = file.stem().string();
      if (source.ref().isotropic() && source.ref().channels() == 3) sources.push_back(std::move(source));
    }
  if (sources.empty()) {
    sources.push_back(
        virtual_measurement("virtual-ggx", "ggx:alpha_x=0.2,alpha_y=0.2,f0=0.9/0.6/0.3,kd=0.05/0.1/0.2"));
    if (!options.quick) {
      sources.push_back(virtual_measurement("virtual-oren-nayar", "oren_nayar"));
      sources.push_back(virtual_measurement("virtual-ashikhmin-shirley", "ashikhmin_shirley"));
    }
    return sources;
  }
  if (options.quick) sources.resize(1);
  return sources;
}

}  // namespace burnish::reports
