// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace burnish {

// Files of a batch's folder, which has to survive whatever ends a program: what a call wrote is on the disk when it
// returns. Each throws Error naming the path and what the system said ("No space left on device").

/// The whole file; nothing else is left where that fails.
void write_durably(const std::filesystem::path& path, std::string_view bytes);

/// Makes a file that was not there; of several callers one does. Returns whether this one did.
bool write_new_durably(const std::filesystem::path& path, std::string_view bytes);

/// Gives a file of the same folder its final name, in place of what is there.
void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to);

/// A folder and those above it.
void make_folder(const std::filesystem::path& folder);

/// A file that only grows. Each line is written by one call, so that lines of several threads stay whole; a program that
/// ends in the middle of it leaves a last line without its end.
class GrowingFile {
 public:
  explicit GrowingFile(std::filesystem::path path);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  /// `line` ends in a newline.
  void append(std::string_view line);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace burnish
