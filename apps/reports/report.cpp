// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <span>

#include <fmt/format.h>

#include <burnish/embedded_file.h>
#include <burnish/file.h>

namespace burnish {

// Returns the files of templates/.
std::span<const EmbeddedFile> report_templates();

namespace reports {

namespace {

void write(const fs::path& path, std::string_view bytes) {
  fs::create_directories(path.parent_path());
  write_then_rename(path, bytes);
  fmt::print("{}\n", path.string());
  std::fflush(stdout);
}

}  // namespace

Page::Page(ReportOptions options, std::string name, std::string text)
    : options_(std::move(options)),
      name_(std::move(name)),
      template_((text.empty() ? name_ : std::move(text)) + ".md.in") {
  values_["machine"] = processor();
  values_["commit"] = options_.commit;
}

void Page::write_rows(const std::string& group, const Table& rows) const {
  reports::write(options_.folder / fmt::format("{}-{}.csv", name_, group), rows.csv());
}

void Page::write_figure(const std::string& name, std::string_view bytes) const {
  reports::write((options_.folder / ".." / "figures" / name).lexically_normal(), bytes);
}

void Page::write_plot(const std::string& name, const Plot& plot) const {
  write_figure(name + ".svg", to_svg(plot));
}

void Page::write() {
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start_;
  values_["seconds"] = fmt::format("{:.0f}", taken.count());
  reports::write(options_.folder / (name_ + ".md"),
                 fill_template(text_of(report_templates(), template_), values_));
}

std::vector<Times> time_in_turns(std::span<const std::function<void()>> tasks, int repetitions) {
  std::vector<std::vector<double>> seconds(tasks.size());
  for (int repetition = 0; repetition < repetitions; ++repetition)
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      const Stopwatch watch;
      tasks[i]();
      seconds[i].push_back(watch.seconds());
    }
  std::vector<Times> times;
  for (auto& list : seconds) {
    std::ranges::sort(list);
    times.push_back({list.front(), list[list.size() / 2]});
  }
  return times;
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::vector<std::string> row_names(const fs::path& file) {
  std::vector<std::string> names;
  std::ifstream rows(file);
  for (std::string row; std::getline(rows, row);)
    if (const auto comma = row.find(','); comma != row.npos) names.push_back(row.substr(0, comma));
  return names;
}

void tell(const std::string& what) {
  fmt::print(stderr, "{}\n", what);
}

}  // namespace reports

}  // namespace burnish
