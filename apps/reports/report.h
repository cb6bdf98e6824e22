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
  std::string commit = "unknown";  ///< of the sources, for the heads of pages
  bool quick = false;   ///< a few materials, samples and repetitions: whether it runs, not what it gives
  std::string section;  ///< alone; empty: all

  bool wants(std::string_view name) const { return section.empty() || section == name; }
};

/// A page: a template of the same name, its values, and what lies beside it. Every file is written under a
/// temporary name and renamed, and told on standard output.
class Page {
 public:
  /// Of the template NAME.md.in, or of another one's.
  Page(ReportOptions options, std::string name, std::string text = {});

  const ReportOptions& options() const noexcept { return options_; }

  /// The value of @mark@. `machine` and `commit` have one.
  std::string& operator[](const std::string& mark) { return values_[mark]; }
  /// PAGE-GROUP.csv.
  void write_rows(const std::string& group, const Table& rows) const;
  /// A file of the folder of figures.
  void write_figure(const std::string& name, std::string_view bytes) const;
  void write_plot(const std::string& name, const Plot& plot) const;
  /// The page itself, with `seconds` since its beginning.
  void write();

 private:
  ReportOptions options_;
  std::string name_, template_;
  std::map<std::string, std::string> values_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// One for each name of burnish_reports; they throw Error.
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

/// The `exponent input` line of every pixel of a sphere, for a simulation of a unit of hw/, to standard
/// output.
void print_sphere_questions(const std::string& unit);
/// The answers of units, given as NAME=FILE, beside c^e and their differences: hardware_sphere.png; the
/// largest difference of each to standard output.
void draw_sphere_answers(const fs::path& folder, const std::vector<std::string>& units);

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Seconds that a task took.
struct Times {
  double least = 0, median = 0;
};
/// Each task `repetitions` times, at least once, all tasks in turn, so that a busy moment meets them all.
std::vector<Times> time_in_turns(std::span<const std::function<void()>> tasks, int repetitions);

/// The files of a folder by name.
std::vector<fs::path> files_in(const fs::path& folder);

/// The first column of a CSV file.
std::vector<std::string> row_names(const fs::path& file);

/// A line on standard error about what takes time.
void tell(const std::string& what);

}  // namespace burnish::reports
