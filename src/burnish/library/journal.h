// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <burnish/library/folder_file.h>
#include <burnish/library/material_record.h>

namespace burnish {

/// A file that came of all materials together.
struct AssembledFile {
  std::string path;    ///< below the batch's folder
  std::string sha256;  ///< of its bytes

  friend bool operator==(const AssembledFile&, const AssembledFile&) = default;
};

/// The record of a batch's materials, which the files of FOLDER/journal hold together. Each process that works on the
/// batch appends to a file of its own, named `writer`.jsonl, and reads those of the others. So they need no lock and
/// no server, and none can spoil another's lines.
///
/// A line is a JSON object: {"event": "began", "name", "key"} before a fit, {"event": "fitted", ...} and {"event":
/// "failed", ...} with a MaterialRecord, {"event": "assembled", "of", "files"} when table and page, these files, were
/// made of records whose keys and names have that digest. Each has "at", seconds since 1970.
/// A process that was killed while it wrote leaves a line that is no such object; it counts as not written. Safe to
/// call from several threads.
class Journal {
 public:
  /// Reads what is there, and makes a file where there is none yet as soon as something is appended. Throws Error as
  /// make_folder does.
  Journal(const std::filesystem::path& folder, const std::string& writer);

  /// The last record of that material with that key, of this process or, as far as refresh has read, of others. One that
  /// was fitted goes before one that failed.
  std::optional<MaterialRecord> record(const std::string& name, const std::string& key) const;
  /// The files that table and page were made of when these records were last assembled.
  std::optional<std::vector<AssembledFile>> assembled(const std::string& digest) const;
  /// Returns true if the folder holds no line.
  bool empty() const;

  /// Reads what others appended since the last time. Throws Error where the folder cannot be read.
  void refresh();

  /// Each returns when the line is on the disk; throws Error as GrowingFile does.
  void append_began(const std::string& name, const std::string& key);
  void append(const MaterialRecord& record);
  void append_assembled(const std::string& digest, const std::vector<AssembledFile>& files);

 private:
  void read_lines(const std::filesystem::path& file);
  void take(const std::string& line);
  void take_assembled(const nlohmann::ordered_json& json);
  void write(const std::string& json);

  std::filesystem::path folder_, own_;
  mutable std::mutex mutex_;
  std::unique_ptr<GrowingFile> file_;
  bool broken_ = false;
  std::map<std::string, std::uint64_t> read_;  // bytes of each file that were taken
  std::map<std::pair<std::string, std::string>, MaterialRecord> records_;
  std::map<std::string, std::vector<AssembledFile>> assembled_;
  bool empty_ = true;
};

}  // namespace burnish
