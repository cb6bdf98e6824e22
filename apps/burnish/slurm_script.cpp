// SPDX-License-Identifier: Apache-2.0
#include "slurm_script.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <burnish/error.h>

#include "usage.h"

namespace burnish::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 3> kOwn = {"--slurm", "--tasks", "--sbatch"};
constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
constexpr std::uint64_t kBeside = 256 * kMiB;  // beyond a fit's own memory: the system's cache of files

// Returns true if a text holds control characters, which end a line for sbatch or a shell, or cannot be seen.
bool has_control_character(const std::string& text) {
  return std::ranges::any_of(text, [](unsigned char c) { return c < ' ' || c == 0x7f; });
}

// Quotes a word for a shell. Throws Error for control characters.
std::string quoted(const std::string& word) {
  if (has_control_character(word))
    throw Error("--slurm: expected words and paths without control characters, found '" + word + "'");
  const bool plain = !word.empty() && std::ranges::all_of(word, [](unsigned char c) {
    return std::isalnum(c) ||
           std::string_view("-_=./:,%+@").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

void add_slurm_arguments(CLI::App& verb, SlurmArguments& arguments) {
  CLI::Option* slurm = verb.add_flag(
      "--slurm", arguments.wanted, "Writes OUT/batch.slurm, a job array of this command, and fits nothing.");
  verb.add_option("--tasks", arguments.tasks,
                  "Sets how many tasks the array of --slurm has; each takes the next material.")
      ->check(in_range(1, 100'000))
      ->needs(slurm)
      ->capture_default_str();
  verb.add_option("--sbatch", arguments.sbatch,
                  "Adds an option of sbatch to the script of --slurm, such as --partition=long.")
      ->allow_extra_args(false)
      ->check([](const std::string& line) {
        return has_control_character(line)
                   ? "expected an option without control characters, found '" + line + "'"
                   : std::string();
      })
      ->needs(slurm);
}

std::vector<std::string> command_words(const CLI::App& verb) {
  std::vector<std::string> words = {fs::read_symlink("/proc/self/exe").string(), verb.get_name()};
  std::vector<std::string> positional;
  for (const CLI::Option* option : verb.get_options()) {
    if (option->count() == 0) continue;
    if (option->get_positional()) {
      positional = option->results();
      continue;
    }
    const std::string name = "--" + option->get_lnames().front();
    if (std::ranges::find(kOwn, name) != kOwn.end()) continue;
    if (option->get_items_expected_max() == 0) {
      words.push_back(name);
      continue;
    }
    for (const std::string& value : option->results()) words.push_back(name + "=" + value);
  }
  words.insert(words.end(), positional.begin(), positional.end());
  return words;
}

std::string slurm_script(const SlurmArguments& arguments, const fs::path& folder,
                         const std::vector<std::string>& words, int threads, std::uint64_t memory) {
  std::string text =
      "#!/bin/bash\n# Written by burnish batch --slurm. Tasks share the folder and need no order: a task that"
      "\n# ends too early is taken over by the others, one that is requeued goes on.\n";
  const auto option = [&](const std::string& line) { text += "#SBATCH " + line + "\n"; };
  option("--job-name=burnish");
  option(fmt::format("--array=1-{}", arguments.tasks));
  option("--ntasks=1");
  if (threads > 0) option(fmt::format("--cpus-per-task={}", threads));
  if (memory > 0) option(fmt::format("--mem={}M", (memory + kBeside + kMiB - 1) / kMiB));
  option("--requeue");
  option("--open-mode=append");
  option("--chdir=" + quoted(fs::current_path().string()));
  option("--output=" + quoted((fs::absolute(folder) / "slurm-%A-%a.log").string()));
  for (const std::string& line : arguments.sbatch) option(line);
  text += "exec";
  for (const std::string& word : words) text += ' ' + quoted(word);
  return text + '\n';
}

}  // namespace burnish::cli
