// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/library/batch.h>
#include <burnish/library/catalogue.h>
#include <burnish/library/figures_table.h>
#include <burnish/library/folder_file.h>

#include "commands.h"
#include "counted.h"
#include "duration_text.h"
#include "fit_arguments.h"
#include "json_output.h"
#include "slurm_script.h"
#include "source_arguments.h"
#include "usage.h"

namespace burnish::cli {

namespace {

struct BatchArguments {
  std::string place, out;
  std::vector<std::string> to;
  FitArguments fit;
  BatchOptions batch;
  SlurmArguments slurm;
  double patience = 60;
  bool exr = false, plain = false, json = false;
};

BatchOptions batch_options(const BatchArguments& arguments) {
  BatchOptions options = arguments.batch;
  options.folder = arguments.out;
  options.fit = [request = request_of(arguments.fit)](bool isotropic) {
    return usage([&] { return fit_options(request, isotropic); });
  };
  options.compact = !arguments.exr;
  options.exports.compressed = !arguments.plain;
  for (const std::string& to : arguments.to) options.exports.to.push_back(export_target(to));
  options.patience = std::chrono::duration<double>(arguments.patience);
  return options;
}

// A line of progress on standard error, redrawn in place. It prints nothing where standard error is no terminal.
class Redrawn {
 public:
  explicit Redrawn(const Batch& batch) : batch_(batch) {}

  void draw() {
    if (!terminal_) return;
    drawn_ = std::chrono::steady_clock::now();
    const BatchSummary summary = batch_.summary();
    const std::size_t done = summary.fitted + summary.failed;
    fmt::print(stderr, "\r{} of {} done", done, summary.total);
    if (summary.failed > 0) fmt::print(stderr, ", {} failed", summary.failed);
    fmt::print(stderr, ", {}", duration_text(summary.seconds));
    if (summary.seconds_left) fmt::print(stderr, ", {} left", duration_text(*summary.seconds_left));
    fmt::print(stderr, "\033[K");
    if (done == summary.total) fmt::print(stderr, "\r\033[K");
    std::fflush(stderr);
  }
  /// Draws again if a second has passed since the last time; call it often while a fit takes long.
  void draw_if_due() {
    if (std::chrono::steady_clock::now() - drawn_ >= std::chrono::seconds(1)) draw();
  }

 private:
  const Batch& batch_;
  const bool terminal_ = ::isatty(STDERR_FILENO) != 0;
  std::chrono::steady_clock::time_point drawn_ = {};
};

void print_json(const BatchArguments& arguments, const BatchSummary& summary,
                const std::vector<MaterialRecord>& failed, const std::vector<std::string>& skipped) {
  auto failures = nlohmann::ordered_json::array();
  for (const MaterialRecord& record : failed)
    failures.push_back({{"name", record.name}, {"path", record.argument}, {"reason", record.reason}});
  const std::filesystem::path folder(arguments.out);
  const nlohmann::ordered_json json{{"output", arguments.out},
                                    {"materials", summary.total},
                                    {"fitted", summary.fitted},
                                    {"failed", summary.failed},
                                    {"earlier", summary.earlier},
                                    {"skipped", skipped},
                                    {"table", (folder / kFiguresTable).string()},
                                    {"page", (folder / kCataloguePage).string()},
                                    {"seconds", summary.seconds},
                                    {"failures", failures}};
  print_as_json(json);
}

// Names the first four files without their folder, and counts the others: "README.txt, list.pdf and 3 more".
std::string few_of(const std::vector<std::string>& paths) {
  constexpr std::size_t kMost = 4;
  std::string text;
  for (std::size_t k = 0; k < std::min(paths.size(), kMost); ++k)
    text += (k > 0 ? ", " : "") + std::filesystem::path(paths[k]).filename().string();
  return paths.size() > kMost ? fmt::format("{} and {} more", text, paths.size() - kMost) : text;
}

void print_text(const BatchArguments& arguments, const BatchSummary& summary,
                const std::vector<MaterialRecord>& failed, const std::vector<std::string>& skipped) {
  const std::filesystem::path folder(arguments.out);
  fmt::print("fitted     {} of {} materials{} in {}\n", summary.fitted, summary.total,
             summary.earlier > 0 ? fmt::format(" ({} done before or elsewhere)", summary.earlier) : "",
             duration_text(summary.seconds));
  if (!skipped.empty())
    fmt::print("skipped    {} that {} no measurement{}: {}\n", counted(skipped.size(), "file"),
               skipped.size() == 1 ? "is" : "are", skipped.size() == 1 ? "" : "s", few_of(skipped));
  for (const MaterialRecord& record : failed)
    fmt::print("failed     {}: {}\n", record.name, short_message(record.reason));
  fmt::print("written    {} and {}\n", (folder / kFiguresTable).string(), (folder / kCataloguePage).string());
}

void write_script(const BatchArguments& arguments, const CLI::App& verb) {
  // Errors of the library's folder or list are thrown now, not by the tasks.
  const std::size_t materials = library_entries(arguments.place, {arguments.out}).size();
  std::vector<std::string> words = command_words(verb);
  if (!arguments.batch.resume) words.insert(words.begin() + 2, "--resume");
  const std::filesystem::path folder(arguments.out);
  const std::string script =
      slurm_script(arguments.slurm, folder, words, arguments.batch.threads, arguments.batch.memory);
  make_folder(folder);
  const std::string path = (folder / "batch.slurm").string();
  write_then_rename(path, script);
  if (arguments.json)
    return print_as_json({{"output", arguments.out},
                          {"materials", materials},
                          {"script", path},
                          {"tasks", arguments.slurm.tasks}});
  fmt::print("written    {}: start it with sbatch {}\n", path, path);
}

void run(const BatchArguments& arguments, const CLI::App& verb) {
  check_folder_name(arguments.out);
  const BatchOptions options = batch_options(arguments);
  for (const bool isotropic : {false, true})
    options.fit(isotropic);  // contradicting options are misuses, thrown before all other errors
  if (arguments.slurm.wanted) return write_script(arguments, verb);
  std::vector<std::string> skipped;
  Batch batch(library_entries(arguments.place, {arguments.out}, &skipped), options);
  std::vector<MaterialRecord> failed;
  Redrawn progress(batch);
  while (const auto record = batch.next([&progress] { progress.draw_if_due(); })) {
    if (!record->fitted()) failed.push_back(*record);
    progress.draw();
  }
  const BatchSummary summary = batch.summary();
  if (arguments.json)
    print_json(arguments, summary, failed, skipped);
  else
    print_text(arguments, summary, failed, skipped);
  std::fflush(stdout);
  if (!failed.empty())
    throw Error(fmt::format("{} of {} materials were not fitted; all other materials were", failed.size(),
                            summary.total));
}

void add_folder_arguments(CLI::App& verb, BatchArguments& arguments) {
  BatchOptions& options = arguments.batch;
  verb.add_option(
          "LIST", arguments.place,
          "Names a folder with measurements, or a text with an argument of `burnish fit` on each line.")
      ->required();
  verb.add_option("-o,--output,--out", arguments.out,
                  "Names the folder to write to, which is made where it is missing.")
      ->required();
  verb.add_flag("--resume", options.resume,
                "Goes on in the folder of an earlier batch, and does again only what is missing or broken.");
  verb.add_option(
          "--memory", options.memory,
          "Takes at most this many bytes, such as 4G, by fitting fewer materials at once (default: four "
          "fifths of what is free).")
      ->transform(CLI::AsSizeValue(false));
  verb.add_option("--threads", options.threads, "Uses at most this many threads; 0 uses all.")
      ->check(in_range(0, 1024));
  verb.add_option("--patience", arguments.patience,
                  "Takes over the work of another machine that said nothing for this many seconds.")
      ->check(in_range(0.1, 86400.0))
      ->capture_default_str();
  verb.add_option("--studio", options.studio, "Sets the link to the studio, relative to the page.")
      ->capture_default_str();
  verb.add_flag("--exr", arguments.exr, "Writes models as OpenEXR with notes of the fit, not as .burnish.");
}

void add_export_arguments(CLI::App& verb, BatchArguments& arguments) {
  const auto names = export_target_names();
  ExportOptions& exports = arguments.batch.exports;
  CLI::Option* to =
      verb.add_option("--to", arguments.to, "Also exports each model to these targets, separated by commas.")
          ->delimiter(',')
          ->check(one_of({names.begin(), names.end()}))
          ->allow_extra_args(false)
          ->excludes("--method");
  verb.add_flag("--exact", exports.exact,
                "Writes shaders of --to that interpolate texels in floats, not by the texture unit.")
      ->needs(to);
  verb.add_flag("--mips", exports.mips, "Writes KTX2 of --to with mip levels.")->needs(to);
  verb.add_flag("--plain", arguments.plain, "Writes textures of --to without compression.")->needs(to);
}

}  // namespace

void add_batch_command(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("batch", "Fit a whole library: a folder or a list of BRDFs");
  verb->footer(
      "Models go to OUT/models, their figures to OUT/library.sqlite, and OUT/index.html shows them all. "
      "Materials that cannot be fitted are listed at the end, with exit status 1. See docs/guide/library.md "
      "and docs/guide/cluster.md.\n"
      "Examples: burnish batch measurements -o library\n"
      "          burnish batch list.txt -o library --budget 2700 --memory 4G --to glsl\n"
      "          burnish batch list.txt -o library --resume\n"
      "          burnish batch list.txt -o library --slurm --tasks 16 --sbatch=--partition=long");
  auto arguments = std::make_shared<BatchArguments>();
  add_folder_arguments(*verb, *arguments);
  add_open_options(*verb, arguments->batch.open);
  add_fit_arguments(*verb, arguments->fit);
  add_export_arguments(*verb, *arguments);
  add_slurm_arguments(*verb, arguments->slurm);
  verb->add_flag("--json", arguments->json, "Prints the summary as JSON.");
  verb->callback([arguments, verb] { run(*arguments, *verb); });
}

}  // namespace burnish::cli
