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

/// How a format is told from others, the surest way first: formats are asked in this order, those told by columns in
/// that of the table. Of each other way no file may look like two.
enum class Told {
  by_signature,  ///< binary: the first bytes are its own
  by_length,     ///< binary: every file has the same length
  by_sizes,      ///< binary: the first numbers are sizes
  by_words,      ///< text: it says what it is
  by_columns,    ///< text: its lines have the right columns
};

/// A format: all that the command line, Python and the page know of it. Rows name what they set; a format that is
/// only read sets the first seven.
struct Format {
  std::string_view title;    ///< "MERL"
  std::string_view to = {};  ///< name for `convert --to`; empty where convert does not write it
  std::string_view endings;  ///< the usual ones, ", " between them
  std::string_view holds;    ///< what it holds, a phrase

  Told told = Told::by_words;
  /// Cheap and certain, whatever the bytes are; nullptr where the format is not read.
  bool (*looks_like)(const FileBytes& file) = nullptr;
  /// Text comes in UTF-8. Throws Error.
  Source (*parse)(const FileBytes& file, const OpenOptions& options) = nullptr;

  /// What convert calls, see convert_writers.h; nullptr where it does not write the format. `losses` were found before.
  Converted (*write)(const Source& source, const ConvertOptions& options,
                     std::vector<std::string> losses) = nullptr;
  std::string_view other_endings = {};  ///< what a written file may end in besides
  bool takes_cells = false;             ///< --cells says something of it
  bool takes_count = false;             ///< --count and --entries do
  bool takes_notes = false;             ///< --notes does
  bool entries_first = false;           ///< a table's entries are written unless draws are asked for
  bool keeps_name = false;              ///< has a place for what a source calls itself
  bool keeps_comments = false;          ///< has one for remarks
  bool keeps_origin = false;            ///< has one for licence, authors and sources
  bool keeps_transmission = false;      ///< says that values are of transmission
  bool keeps_block = false;             ///< says which side and which band they are of
  bool written_elsewhere = false;       ///< another verb than convert writes it at a file's name alone

  bool is_read() const noexcept { return looks_like != nullptr; }
  bool is_written() const noexcept { return write != nullptr || written_elsewhere; }
};

/// All formats, in the order in which they are listed.
std::span<const Format> formats() noexcept;

/// The format that a binary file, or a text, looks like; nullptr where it looks like none.
const Format* binary_format_of(const FileBytes& file);
const Format* text_format_of(const FileBytes& file);

/// The format of this name for convert; nullptr where there is none.
const Format* format_to(std::string_view name) noexcept;

/// The format that convert writes into a file of this ending (".csv"); nullptr where the ending names none.
const Format* format_ending_in(std::string_view ending) noexcept;

/// Usual endings and others, each with its dot.
std::vector<std::string> endings_of(const Format& format);

/// The first ending of each format that an ending alone names.
std::vector<std::string_view> naming_endings();

}  // namespace burnish
