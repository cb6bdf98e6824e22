// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <burnish/export/export_model.h>
#include <burnish/export/exported_files.h>
#include <burnish/fitting/fit.h>
#include <burnish/io/open_options.h>

namespace burnish {

/// All of a fit's options that its bits depend on, as a text: two that differ in one have different texts.
std::string settings_text(const FitOptions& options);
/// The same of how a source is opened.
std::string settings_text(const OpenOptions& options);
/// The same of an export, without the light from all around.
std::string settings_text(const ExportOptions& options);

/// The version of the library, "0.1.0".
std::string library_version();

}  // namespace burnish
