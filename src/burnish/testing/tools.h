// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include <sys/wait.h>
#include <unistd.h>

#include <burnish/error.h>
#include <burnish/file.h>

namespace burnish {

/// A folder of this process that the destructor removes.
struct TemporaryFolder {
  std::filesystem::path path;

  explicit TemporaryFolder(const std::string& name)
      : path(std::filesystem::temp_directory_path() /
             ("burnish_" + name + "_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
};

inline void write(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string read(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// Returns a file in memory.
inline FileBytes memory_file(std::string_view content) {
  const auto* data = reinterpret_cast<const std::byte*>(content.data());
  return {"test.file", {data, data + content.size()}};
}

/// Returns the message of the Error that `parse` throws; empty if it throws none.
template <class Parse>
std::string error_of(const Parse& parse) {
  try {
    parse();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// The result of a command: its exit status, -1 if a signal ended it, and its output on both streams. A
/// stream that the command redirects is not in the output.
struct Outcome {
  int status = -1;
  std::string output;
};

/// Runs a shell command to its end.
inline Outcome run(const std::string& command) {
  std::FILE* const pipe = ::popen(("(" + command + ") 2>&1").c_str(), "r");
  if (!pipe) return {};
  Outcome outcome;
  for (int c; (c = std::fgetc(pipe)) != EOF;) outcome.output += static_cast<char>(c);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
  return outcome;
}

/// Returns true if the shell finds a program.
inline bool has_tool(const std::string& name) {
  return run("command -v " + name).status == 0;
}

}  // namespace burnish
