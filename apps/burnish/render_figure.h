// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace burnish::cli {

/// The options of `burnish render --figure1` besides the mesh and the picture.
struct FigureArguments {
  std::string truth = "ggx:alpha_x=0.1,alpha_y=0.3,kd=0.3,f0=0.8", model;
  std::vector<int> tessellations{1000, 3000, 10000, 40000};
  int size = 512;
};

/// Adds the options of the figure. The arguments must outlive the parse.
void add_figure_arguments(CLI::App& verb, FigureArguments& arguments, bool& figure1);

/// Draws the sheet and prints the table, as text or as JSON.
void draw_figure(const FigureArguments& arguments, const std::string& mesh, const std::string& out,
                 bool json);

}  // namespace burnish::cli
