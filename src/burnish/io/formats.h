// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/file.h>
#include <burnish/io/open_options.h>
#include <burnish/source.h>

namespace burnish {

struct Converted;
struct ConvertOptions;

/// The way in which a format is recognized, the surest first. Formats are tried in this order. No file may look like
/// two formats that are recognized in the same way. by_columns is the exception: its formats are tried in the
/// table's order.
enum class Told {
  by_signature,  ///< binary: the first bytes are its own
  by_length,     ///< binary: every file has the same length
  by_sizes,      ///< binary: the first numbers are sizes
  by_words,      ///< text: it says what it is
  by_columns,    ///< text: its lines have the right columns
};

/// A format: all that the command line, Python and the page know of it. Rows name the members that they set; a
/// format that is only read sets the first seven.
struct Format {
  std::string_view title;    ///< "MERL"
  std::string_view to = {};  ///< name for `convert --to`; empty if convert does not write it
  std::string_view endings;  ///< the usual ones, separated by ", "
  std::string_view holds;    ///< what the format holds, a phrase

  Told told = Told::by_words;
  /// The recognizer, cheap and certain for all bytes; nullptr if the format is not read.
  bool (*looks_like)(const FileBytes& file) = nullptr;
  /// The reader. Text comes in UTF-8. Throws Error.
  Source (*parse)(const FileBytes& file, const OpenOptions& options) = nullptr;

  /// The writer that convert calls, see convert_writers.h; nullptr if convert does not write the format. `losses` are
  /// those found before.
  Converted (*write)(const Source& source, const ConvertOptions& options,
                     std::vector<std::string> losses) = nullptr;
  /// The writer of several parts of one surface; nullptr if the format holds one.
  Converted (*write_parts)(std::span<const Source> parts, const ConvertOptions& options,
                           std::vector<std::string> losses) = nullptr;
  std::string_view other_endings = {};  ///< further endings of a written file
  bool takes_cells = false;             ///< --cells applies to it
  bool takes_count = false;             ///< --count and --entries apply to it
  bool takes_notes = false;             ///< --notes applies to it
  bool entries_first = false;           ///< a table's entries are written unless draws are requested
  bool keeps_name = false;              ///< has a place for the name that a source has in its file
  bool keeps_comments = false;          ///< has a place for remarks
  bool keeps_origin = false;            ///< has a place for licence, authors and sources
  bool keeps_transmission = false;      ///< states that values are of transmission
  bool keeps_block = false;             ///< states the side and the band of the values
  bool written_elsewhere = false;       ///< a verb other than convert writes it, to a file's name alone

  bool is_read() const noexcept { return looks_like != nullptr; }
  bool is_written() const noexcept { return write != nullptr || written_elsewhere; }
};

/// Returns all formats, in the order in which they are listed.
std::span<const Format> formats() noexcept;

/// Return the format that a binary file, or a text, looks like; nullptr if it looks like none.
const Format* binary_format_of(const FileBytes& file);
const Format* text_format_of(const FileBytes& file);

/// Returns the format of this name for convert; nullptr if there is none.
const Format* format_to(std::string_view name) noexcept;

/// Returns the format that convert writes into a file of this ending (".csv"); nullptr if the ending names none.
const Format* format_ending_in(std::string_view ending) noexcept;

/// Returns a format's usual endings and its further ones, each with its dot.
std::vector<std::string> endings_of(const Format& format);

/// Returns the first ending of each format that convert chooses by the ending alone.
std::vector<std::string_view> naming_endings();

}  // namespace burnish
