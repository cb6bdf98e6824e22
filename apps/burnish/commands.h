// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include <burnish/capture/ranks/fit_crew.h>

namespace burnish::cli {

// Each verb lives in NAME_command.cpp: it adds its options to the application and a callback that calls the
// library.
void add_batch_command(CLI::App& app);
void add_book_command(CLI::App& app);
void add_compare_command(CLI::App& app);
void add_convert_command(CLI::App& app);
void add_describe_command(CLI::App& app);
void add_eval_command(CLI::App& app);
void add_export_command(CLI::App& app);
void add_fit_command(CLI::App& app);
/// `crew` holds the ranks that fit together, or is null.
void add_fit_surface_command(CLI::App& app, FitCrew* crew = nullptr);
void add_help_command(CLI::App& app);
void add_hw_command(CLI::App& app);
void add_info_command(CLI::App& app);
void add_measure_command(CLI::App& app);
void add_render_command(CLI::App& app);
void add_specular_command(CLI::App& app);

/// Returns the text of --version, as lines or as JSON: versions, instruction sets, threads.
std::string version_text(bool as_json);

}  // namespace burnish::cli
