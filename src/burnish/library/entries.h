// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace burnish {

/// A material of a library: what open_source opens, and what its files are called.
struct LibraryEntry {
  std::string name;      ///< letters, digits, '.', '-' and '_', a letter or digit first; no two alike
  std::string argument;  ///< a file, an analytic BRDF, np:FOLDER#NAME, ...

  friend bool operator==(const LibraryEntry&, const LibraryEntry&) = default;
};

/// Returns the materials of a list or of a folder. A list is a text with an argument a line; empty lines and those
/// that start with # are skipped, and files are named as from the working directory.
/// In a folder, every regular file below it is a material, by name. Left out are files whose name or whose folder's
/// name starts with a dot, `others`, such as the file or folder that results go to, and folders in which a batch
/// worked. Files that are no measurement are left out too, and their paths go to `skipped`: other texts, pictures,
/// lists, judged by their content where no name such as paint.binary says more.
/// Names are made of the arguments: a file's name without its ending, the text behind a #, an analytic BRDF as it is.
/// Equal names get "-2", "-3" and so on.
/// Throws Error where the place cannot be read, holds nothing, is a file that is no text, or a folder of results
/// itself.
std::vector<LibraryEntry> library_entries(const std::filesystem::path& list_or_folder,
                                          const std::vector<std::filesystem::path>& others = {},
                                          std::vector<std::string>* skipped = nullptr);

/// The same for arguments that are at hand.
std::vector<LibraryEntry> named_entries(const std::vector<std::string>& arguments);

}  // namespace burnish
