// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <burnish/export/export_model.h>
#include <burnish/fitting/fit.h>
#include <burnish/io/open_options.h>
#include <burnish/library/entries.h>
#include <burnish/library/material_record.h>

namespace burnish {

/// Options of a batch: the fit of each material, and the folder that it writes.
struct BatchOptions {
  std::filesystem::path folder;
  OpenOptions open = {};
  /// Returns the fit options for an isotropic or anisotropic source, without progress. None: FitOptions' defaults.
  std::function<FitOptions(bool isotropic)> fit = {};
  bool compact = true;  ///< models as .burnish, else OpenEXR; baselines are JSON
  ExportOptions exports =
      {};           ///< to folder/exports/NAME, of the name's own functions; nothing where `to` is empty
  int threads = 0;  ///< at most this many; 0: as many processors as this process may use
  std::uint64_t memory = 0;  ///< bytes that the process may take; 0: four fifths of usable_memory()
  bool resume = false;       ///< go on in a folder that holds a batch's journal
  std::string studio = "studio/index.html";  ///< where the page's links to the studio lead
  /// The time that another process may be silent before its material is taken over.
  std::chrono::duration<double> patience = std::chrono::seconds(60);
};

/// The state of a batch.
struct BatchSummary {
  std::size_t total = 0;   ///< materials
  std::size_t fitted = 0;  ///< of these, in this run or earlier
  std::size_t failed = 0;
  std::size_t earlier = 0;  ///< of fitted and failed, what an earlier run or another process did
  double seconds = 0;       ///< since the batch began
  /// The time left at the pace of this run; nothing before there is one.
  std::optional<double> seconds_left = {};
};

/// Fits materials one after the other and beside each other, each with the bits of fit() alone, whatever the number
/// of threads. One fit runs on each thread at once, fewer where their memory would not fit; threads that are left, at
/// the end above all, help within fits. In the folder:
///
/// - models/NAME.burnish (.exr, .json), pictures/NAME.png, exports/NAME/...: written under other names first and renamed
///   when the journal has their digests, so what stands there is whole;
/// - journal/, see Journal; claims/, see Claims: several processes may work on one folder, on one machine or on many;
/// - library.sqlite (write_figures_table), index.html and page/ (write_catalogue), made when all is done.
///
/// A material whose journal has a record with the same digest of input, options and version, and whose files are whole,
/// is not done again; nor is one that failed with the same input. Killed in whatever moment, a batch goes on with
/// `resume` where it was.
class Batch {
 public:
  /// Starts. Throws Error where the folder cannot be made or written, or holds a journal and `resume` is not set.
  Batch(std::vector<LibraryEntry> entries, BatchOptions options);
  /// Stops what is being fitted.
  ~Batch();
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  /// The next material that is done, in the order they come; each once. Waits for it. After the last one, when table
  /// and page are made, nothing. A fault of a material is in its record. A fault of the folder (full, gone, not to be
  /// written) ends the batch and is thrown as Error, by every later call too. `waiting` is called ten times a second
  /// meanwhile; an exception that it throws reaches the caller, and the batch goes on.
  std::optional<MaterialRecord> next(const std::function<void()>& waiting = {});

  /// Returns the summary of the materials that next() has given out.
  BatchSummary summary() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// Returns the memory that a fit is assumed to need beside its input, in bytes: a little more than was measured
/// (docs/notes/library.md).
std::uint64_t fit_memory(const FitOptions& options, bool isotropic);

}  // namespace burnish
