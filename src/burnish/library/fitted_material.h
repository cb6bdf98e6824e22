// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <vector>

#include <burnish/export/exported_files.h>
#include <burnish/library/batch.h>

namespace burnish {

/// A record, and the bytes of its files in their order; the record's digests are of these.
struct FittedMaterial {
  MaterialRecord record;
  std::vector<std::string> bytes;
};

/// Who waits for a material.
struct FitWatch {
  std::function<void()> stop;                        ///< called now and then; what it throws ends the fit
  std::function<void(std::uint64_t bytes)> reserve;  ///< called before the fit, which takes so much memory
};

/// Opens and fits one material, makes its picture and what is exported. Throws Error as open_source, fit and
/// export_model do.
FittedMaterial fit_material(const LibraryEntry& entry, const std::string& key, const BatchOptions& options,
                            const FitWatch& watch);

/// Digests of what materials are made of. Files that many name, as those of np:FOLDER#NAME, are read once. Safe to call
/// from several threads.
class InputDigests {
 public:
  /// Prepares digests of the options and the version alone; `options` must outlive this.
  explicit InputDigests(const BatchOptions& options);

  /// Returns the digest of the input's bytes, its address in them, the options and the version. Throws Error where a
  /// file cannot be read.
  std::string key(const LibraryEntry& entry);

 private:
  std::string of_file(const std::filesystem::path& path);

  const BatchOptions& options_;
  std::string settings_;
  std::mutex mutex_;
  // size, time of the last change and digest, by path
  std::map<std::string, std::tuple<std::uintmax_t, std::filesystem::file_time_type, std::string>> files_;
};

/// Size of the files that an argument names, bytes; 0 where there is none.
std::uint64_t input_size(const LibraryEntry& entry) noexcept;

}  // namespace burnish
