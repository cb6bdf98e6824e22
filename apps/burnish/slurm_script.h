#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace burnish::cli {

/// What a job array is asked for.
struct SlurmArguments {
  bool wanted = false;
  int tasks = 2;
  std::vector<std::string> sbatch;  ///< further options of sbatch, such as "--partition=long"
};

/// Adds --slurm, --tasks and --sbatch to a verb. `arguments` must outlive the parse.
void add_slurm_arguments(CLI::App& verb, SlurmArguments& arguments);

/// The words of a shell's command that calls this program with a verb and the options that it was called with, without
/// those of add_slurm_arguments.
std::vector<std::string> command_words(const CLI::App& verb);

/// A script for sbatch: an array of tasks that each run `words` in the working directory of now, may be requeued, and
/// write their logs into `folder`. `threads` and `memory` (bytes) are those of a task; 0: Slurm's own. Throws Error for
/// a word or a path with control characters.
std::string slurm_script(const SlurmArguments& arguments, const std::filesystem::path& folder,
                         const std::vector<std::string>& words, int threads, std::uint64_t memory);

}  // namespace burnish::cli
