// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace burnish::cli {

/// The options of a job array.
struct SlurmArguments {
  bool wanted = false;
  int tasks = 2;
  std::vector<std::string> sbatch;  ///< further options of sbatch, such as "--partition=long"
};

/// Adds --slurm, --tasks and --sbatch to a verb. `arguments` must outlive the parse.
void add_slurm_arguments(CLI::App& verb, SlurmArguments& arguments);

/// Returns the words of a shell command: this program, the verb, and the options that it was called with. Options of
/// add_slurm_arguments are left out.
std::vector<std::string> command_words(const CLI::App& verb);

/// Returns a script for sbatch: an array of tasks that each run `words` in the present working directory. Tasks may be
/// requeued, and write their logs into `folder`. `threads` and `memory` (bytes) are those of a task; 0 leaves them to
/// Slurm. Throws Error for a word or a path with control characters.
std::string slurm_script(const SlurmArguments& arguments, const std::filesystem::path& folder,
                         const std::vector<std::string>& words, int threads, std::uint64_t memory);

}  // namespace burnish::cli
