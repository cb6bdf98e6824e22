// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <burnish/image/svg_plot.h>

#include "markdown.h"

namespace burnish::reports {

namespace fs = std::filesystem;

struct ReportOptions {
  fs::path folder;                 ///< pages and rows go here, figures to the folder `figures` beside it
  std::optional<fs::path> data;    ///< the folder of measurements
  std::string commit = "unknown";  ///< commit of the sources, for the heads of pages
  bool quick = false;              ///< a few materials, samples and repetitions: a trial run, not for results
  std::string section;             ///< the only section to report; empty: all

  bool wants(std::string_view name) const { return section.empty() || section == name; }
};

/// A page: a template of the same name, its values, and the files beside it. Each file is written under a temporary
/// name, renamed, and named on standard output.
class Page {
 public:
  /// Uses the template NAME.md.in, or that of the name `text`.
  Page(ReportOptions options, std::string name, std::string text = {});

  const ReportOptions& options() const noexcept { return options_; }

  /// Returns the value of @mark@. `machine` and `commit` are set from the start.
  std::string& operator[](const std::string& mark) { return values_[mark]; }
  /// Writes PAGE-GROUP.csv.
  void write_rows(const std::string& group, const Table& rows) const;
  /// Writes a file of the folder of figures.
  void write_figure(const std::string& name, std::string_view bytes) const;
  void write_plot(const std::string& name, const Plot& plot) const;
  /// Writes the page itself. `seconds` is the time since its construction.
  void write();

 private:
  ReportOptions options_;
  std::string name_, template_;
  std::map<std::string, std::string> values_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Each function is a NAME of burnish_reports. They throw Error.
void report_accuracy(const ReportOptions& options);
void report_area_lights(const ReportOptions& options);
void report_cost(const ReportOptions& options);
void report_frame_cost(const ReportOptions& options);
void report_measured(const ReportOptions& options);
void report_openpbr(const ReportOptions& options);
void report_results(const ReportOptions& options);
void report_sampling(const ReportOptions& options);
void report_shaders(const ReportOptions& options);
void report_surfaces(const ReportOptions& options);

/// Prints the line `exponent input` of every pixel of a sphere on standard output, for a simulation of a unit of hw/.
void print_sphere_questions(const std::string& unit);
/// Draws hardware_sphere.png: c^e, the answers of units given as NAME=FILE, and their differences. Prints the largest
/// difference of each unit.
void draw_sphere_answers(const fs::path& folder, const std::vector<std::string>& units);

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The seconds that a task took.
struct Times {
  double least = 0, median = 0;
};
/// Runs each task `repetitions` times, at least once. All tasks run in turn, so a busy moment slows all of them down.
std::vector<Times> time_in_turns(std::span<const std::function<void()>> tasks, int repetitions);

/// Returns the files of a folder, sorted by name.
std::vector<fs::path> files_in(const fs::path& folder);

/// Returns the first column of a CSV file.
std::vector<std::string> row_names(const fs::path& file);

/// Prints a line on standard error about work that takes time.
void tell(const std::string& what);

}  // namespace burnish::reports
