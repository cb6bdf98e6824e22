#include "report.h"

#include <algorithm>
#include <cstdio>
#include <span>

#include <fmt/format.h>

#include <burnish/embedded_file.h>
#include <burnish/file.h>

namespace burnish {

// The files of templates/.
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

Page::Page(ReportOptions options, std::string name) : options_(std::move(options)), name_(std::move(name)) {
  values_["machine"] = processor();
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
                 fill_template(text_of(report_templates(), name_ + ".md.in"), values_));
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

void tell(const std::string& what) {
  fmt::print(stderr, "{}\n", what);
}

}  // namespace reports

}  // namespace burnish
