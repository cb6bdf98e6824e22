// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <burnish/export/exported_files.h>
#include <burnish/source.h>

namespace burnish {

struct MdlModule {
  std::vector<ExportedFile> files;  ///< NAME.mdl and NAME.mbsdf
  std::vector<std::string> losses;  ///< of the measurement, as convert says them
};

/// An MDL 1.7 module with a material `burnish_NAME`: df::measured_bsdf of the source as an MBSDF file beside
/// it, `cells` along each polar angle. The format is isotropic: others get their azimuth's mean. Throws Error
/// as convert does and for a name that check_shader_name refuses. Source: [MDL 2022], [NVIDIA 2021].
MdlModule mdl_module(const Source& source, int cells, const std::string& name);

}  // namespace burnish
