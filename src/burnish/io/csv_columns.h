#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/io/text_reader.h>
#include <burnish/io/value_kind.h>

namespace burnish {

/// Where each thing stands in a row of a table, by the names of its columns.
struct CsvColumns {
  char separator = ',';  ///< ' ' stands for runs of blanks and tabs
  std::size_t count = 0;
  bool vectors = false;
  std::array<std::optional<std::size_t>, 6>
      direction;                                   ///< of wi_x ... wo_z, or of theta_i, phi_i, theta_o, phi_o
  std::array<double, 4> to_radians{};              ///< factor of each angle
  bool units_named = false;                        ///< a name says what unit an angle has
  bool in_plane = false;                           ///< no azimuth at all: polar angles have signs
  bool relative_azimuth = false;                   ///< phi_o is counted from phi_i
  std::vector<std::size_t> values;                 ///< of each channel
  std::vector<double> lambda_nm;                   ///< of each channel, or empty
  std::optional<std::size_t> wavelength;           ///< a row is of one wavelength, which stands there
  std::optional<double> to_nm;                     ///< its factor, where its name has a unit
  std::optional<ValueKind> kind;                   ///< what the values' names say
  std::vector<std::optional<std::size_t>> others;  ///< of each name that the caller knows besides
  std::vector<std::string> unknown;                ///< names, as the file has them, that mean nothing here
};

/// The line that names a table's columns.
struct CsvHeader {
  std::string_view line;   ///< without a mark of a comment
  bool commented = false;  ///< it was one
  char separator = ',';
};

/// Whether a line names two or more directions' columns, in the words that read_columns knows.
std::optional<CsvHeader> header_of(std::string_view line);

/// The columns of a header. Names are of any case, in quotes or not, with units in brackets or behind an
/// underscore. Throws Error where a direction is missing, named twice or, if `with_values`, has no value.
/// `others` are known besides.
CsvColumns read_columns(const TextReader& reader, const CsvHeader& header, bool with_values,
                        std::span<const std::string_view> others = {});

/// The cells of a line without quotes and blanks around them, into `cells`. An empty one after the last separator
/// is none.
void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells);

/// The cells of a header's line; between blanks a unit in brackets belongs to the name before it.
std::vector<std::string_view> split_names(std::string_view line, char separator);

/// The numbers of rows; a decimal comma is taken where commas do not separate, and then everywhere.
class CellNumbers {
 public:
  /// A number of a cell. Throws Error, naming the column, if it is none.
  double number(const TextReader& reader, std::string_view cell, std::string_view column);

 private:
  bool points_ = false, commas_ = false;  // decimal marks that were there
};

/// Whether a cell stands for a value that was not measured: empty, "nan", "na", "n/a", "null" or dashes.
bool is_missing(std::string_view cell);

}  // namespace burnish
