// SPDX-License-Identifier: Apache-2.0
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

/// The place of each quantity in a row of a table, found by the names of its columns.
struct CsvColumns {
  char separator = ',';  ///< ' ' stands for runs of blanks and tabs
  std::size_t count = 0;
  bool vectors = false;
  std::array<std::optional<std::size_t>, 6>
      direction;                          ///< columns of wi_x ... wo_z, or of theta_i, phi_i, theta_o, phi_o
  std::array<double, 4> to_radians{};     ///< factor of each angle
  bool units_named = false;               ///< a column's name states the unit of an angle
  bool in_plane = false;                  ///< no column is an azimuth: polar angles have signs
  bool relative_azimuth = false;          ///< phi_o is counted from phi_i
  std::vector<std::size_t> values;        ///< column of each channel
  std::vector<double> lambda_nm;          ///< wavelength of each channel, or empty
  std::optional<std::size_t> wavelength;  ///< column of the wavelength, if a row has one wavelength
  std::optional<double> to_nm;            ///< factor of the wavelength, if its name has a unit
  std::optional<ValueKind> kind;          ///< kind that the names of the value columns state
  std::vector<std::optional<std::size_t>> others;  ///< column of each further name that the caller knows
  std::vector<std::string> unknown;                ///< names without a meaning here, as the file has them
};

/// The line that names a table's columns.
struct CsvHeader {
  std::string_view line;   ///< without the mark of a comment
  bool commented = false;  ///< the line was a comment
  char separator = ',';
};

/// Returns the header if a line names two or more columns of directions in the words that read_columns knows.
std::optional<CsvHeader> header_of(std::string_view line);

/// Returns the columns of a header. Names are of any case, in quotes or not, with units in brackets or behind
/// an underscore. `others` are further names that the caller knows. Throws Error if a direction is missing or
/// named twice, or if `with_values` is set and no column holds values.
CsvColumns read_columns(const TextReader& reader, const CsvHeader& header, bool with_values,
                        std::span<const std::string_view> others = {});

/// Writes the cells of a line, without quotes and blanks around them, into `cells`. An empty cell after the last
/// separator is dropped.
void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells);

/// Returns the cells of a header's line. Where blanks separate, a unit in brackets belongs to the name before it.
std::vector<std::string_view> split_names(std::string_view line, char separator);

/// Reads the numbers of rows. A decimal comma is accepted if commas do not separate cells. A table has one
/// decimal mark: after a comma no point is accepted, and after a point no comma.
class CellNumbers {
 public:
  /// Returns the number in a cell. Throws Error, naming the column, if the cell holds none or has the other
  /// decimal mark.
  double number(const TextReader& reader, std::string_view cell, std::string_view column);

 private:
  bool points_ = false, commas_ = false;  // decimal marks seen so far
};

/// Returns true if a cell stands for a value that was not measured: empty, dashes, or "nan", "na", "n/a",
/// "#n/a", "null" or "none" in any case.
bool is_missing(std::string_view cell);

}  // namespace burnish
