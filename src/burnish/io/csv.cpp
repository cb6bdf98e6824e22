// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include <burnish/io/csv.h>
#include <burnish/io/csv_columns.h>
#include <burnish/io/sample_checks.h>
#include <burnish/io/text_reader.h>
#include <burnish/io/utf16.h>
#include <burnish/io/value_kind.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr std::array<std::string_view, 6> kVectorNames = {"wi_x", "wi_y", "wi_z", "wo_x", "wo_y", "wo_z"};
constexpr std::array<std::string_view, 3> kTexelNames = {"texel_x", "texel_y", "held_out"};
constexpr std::size_t kMaxPreamble = 1 << 16;  // bytes before a header
constexpr double kLargestOfRadians = 3.2;      // angles of a hemisphere in radians stay below

/// The symmetry of the material that a comment states.
enum class Tag { none, isotropic, anisotropic };

bool is_comment(std::string_view line) noexcept {
  return line.starts_with('#') || line.starts_with('%');
}

void read_tag(std::string_view comment, Tag& tag) {
  const std::string remark = lower_case(trimmed(comment.substr(1)));
  if (remark == "isotropic") tag = Tag::isotropic;
  if (remark == "anisotropic") tag = Tag::anisotropic;
}

/// Returns true if a line starts with a number. Such a line is no header, and ends the search for one.
bool starts_with_number(std::string_view line) {
  const std::string_view word = line.substr(0, line.find_first_of(" \t,;"));
  return parse_number(word).has_value();
}

/// Returns true if a row has a cell for each name. A comment may name columns that the table does not have.
bool fits(const CsvHeader& header, std::string_view row) {
  const std::vector<std::string_view> names = split_names(header.line, header.separator);
  std::vector<std::string_view> cells;
  for (const char separator : {';', '\t', ',', ' '}) {
    split_cells(row, separator, cells);
    if (cells.size() == names.size()) return true;
  }
  return false;
}

/// The lines in front of a table's rows.
struct Preamble {
  std::optional<CsvHeader> header;
  std::string remarks;    // lines before the header that are no comments, joined
  bool says_brf = false;  // remarks name reflectance factors
  Tag tag = Tag::none;
};

/// Moves the reader to the header, or to the line before the rows if the header is a comment. A header that is
/// no comment wins over a comment that looks like one.
Preamble read_preamble(TextReader& reader) {
  Preamble found;
  const std::size_t size = reader.remaining();
  TextReader at_comment = reader;
  while (size - reader.remaining() < kMaxPreamble && reader.next_line()) {
    const std::string_view line = trimmed(reader.line());
    if (line.empty()) continue;
    if (const auto header = header_of(line)) {
      if (!header->commented) {
        found.header = header;
        return found;
      }
      found.header = header;
      at_comment = reader;
      continue;
    }
    if (is_comment(line)) {
      read_tag(line, found.tag);
      continue;
    }
    if (found.header && starts_with_number(line)) {
      if (fits(*found.header, line)) break;
      found.header.reset();
    }
    const std::string words = " " + lower_case(line) + " ";
    found.says_brf = found.says_brf || words.find(" brf") != std::string::npos ||
                     words.find("reflectance factor") != std::string::npos;
    if (found.remarks.size() < 200)
      found.remarks += (found.remarks.empty() ? "" : ", ") + printable(line, 80);
  }
  if (found.header) reader = at_comment;
  return found;
}

/// Reads a table's rows, cell by cell.
class Rows {
 public:
  Rows(TextReader& reader, const CsvColumns& columns, const CsvHeader& header)
      : reader_(reader),
        columns_(columns),
        separator_(header.separator),
        names_(split_names(header.line, header.separator)) {}

  /// Splits the current line. Throws Error unless it has a cell for each column.
  void read() {
    const std::string_view line = trimmed(reader_.line());
    split(line, separator_);
    if (first_ && cells_.size() != columns_.count)
      // A row may have another separator than the names.
      for (const char other : {';', '\t', ',', ' '}) {
        split(line, other);
        if (cells_.size() != columns_.count) continue;
        separator_ = other;
        break;
      }
    first_ = false;
    if (cells_.size() != columns_.count) split(line, separator_);
    if (cells_.size() != columns_.count)
      reader_.fail(fmt::format("{} columns", columns_.count),
                   fmt::format("{} in {}", cells_.size(), in_quotes(line)));
  }

  double number(std::size_t column) {
    return numbers_.number(reader_, cells_[column],
                           column < names_.size() ? in_quotes(names_[column]) : "a column");
  }

  bool missing(std::size_t column) const { return is_missing(cells_[column]); }

  std::string name(std::size_t column) const {
    return column < names_.size() ? printable(names_[column], 80) : "";
  }

 private:
  void split(std::string_view line, char separator) {
    split_cells(line, separator, cells_);
    if (separator != ' ' && cells_.size() + 1 == columns_.count && line.ends_with(separator))
      cells_.emplace_back();
  }

  TextReader& reader_;
  const CsvColumns& columns_;
  char separator_;
  bool first_ = true;
  std::vector<std::string_view> names_;
  std::vector<std::string_view> cells_;
  CellNumbers numbers_;
};

Vec3 unit_vector(const TextReader& reader, Vec3 w) {
  const double l = length(w);
  if (!(std::abs(l - 1) <= 0.01)) reader.fail("a unit vector", fmt::format("a length of {}", l));
  return std::abs(l - 1) < 1e-12 ? w : (1 / l) * w;
}

DirectionPair read_pair(const TextReader& reader, const CsvColumns& columns, Rows& rows) {
  std::array<double, 6> at{};
  for (std::size_t k = 0; k < 6; ++k)
    if (columns.direction[k]) at[k] = rows.number(*columns.direction[k]);
  if (columns.vectors)
    return {unit_vector(reader, {at[0], at[1], at[2]}), unit_vector(reader, {at[3], at[4], at[5]})};
  for (std::size_t k = 0; k < 4; ++k) at[k] *= columns.to_radians[k];
  if (columns.relative_azimuth) at[3] += at[1];
  if (!std::isfinite(at[3])) reader.fail("a finite azimuth", in_quotes(reader.line()));
  return {spherical_direction(at[0], at[1]), spherical_direction(at[2], at[3])};
}

/// Moves to the next line with content; returns false at the end of the file. Comments may have a tag.
bool next_row(TextReader& reader, Tag& tag) {
  while (reader.next_line()) {
    const std::string_view line = trimmed(reader.line());
    if (line.empty()) continue;
    if (!is_comment(line)) return true;
    read_tag(line, tag);
  }
  return false;
}

/// Collects spectra from rows of one wavelength each. Directions stay in the order in which they come.
class SpectraOfRows {
 public:
  void add(const TextReader& reader, const DirectionPair& pair, double lambda, double value) {
    if (!(lambda > 0)) reader.fail("a wavelength above 0", in_quotes(reader.line()));
    const auto [place, is_new] = places_.emplace(
        std::array{pair.wi.x, pair.wi.y, pair.wi.z, pair.wo.x, pair.wo.y, pair.wo.z}, spectra_.size());
    if (is_new) {
      spectra_.emplace_back();
      pairs_.push_back(pair);
    }
    if (!spectra_[place->second].emplace(lambda, value).second)
      reader.fail("one value for each direction and wavelength", in_quotes(reader.line()));
    ++bands_[lambda];
    if (bands_.size() > kMaxFileChannels)
      reader.fail(fmt::format("at most {} wavelengths", kMaxFileChannels), in_quotes(reader.line()));
  }

  /// Turns whole spectra into samples. Wavelengths of a column without a unit are micrometres if all of them are small.
  void finish(std::optional<double> to_nm, Samples& samples, Findings& findings) const {
    constexpr double kLargestMicrometre = 50;
    const bool small = !bands_.empty() && bands_.rbegin()->first < kLargestMicrometre;
    if (!to_nm && small)
      findings.conventions.push_back("Wavelengths were taken as micrometres: all are small.");
    const double factor = to_nm.value_or(small ? 1e3 : 1);
    // Wavelengths are rounded to the digits of a metre's decimal fraction.
    for (const auto& [lambda, rows] : bands_)
      findings.lambda_nm.push_back(std::round(lambda * factor * 1e6) / 1e6);
    samples.channels = bands_.size();
    std::size_t partial = 0;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (spectra_[i].size() < bands_.size()) {
        ++partial;
        continue;
      }
      samples.pairs.push_back(pairs_[i]);
      for (const auto& [lambda, value] : spectra_[i]) samples.values.push_back(value);
    }
    if (partial > 0)
      findings.warnings.push_back(fmt::format("{} {} without a value at every wavelength {} left out.",
                                              partial, partial == 1 ? "direction" : "directions",
                                              partial == 1 ? "was" : "were"));
  }

 private:
  std::map<std::array<double, 6>, std::size_t> places_;
  std::vector<DirectionPair> pairs_;
  std::vector<std::map<double, double>> spectra_;
  std::map<double, std::size_t> bands_;
};

bool is_texel_header(const CsvHeader& header) {
  return lower_case(header.line).find(kTexelNames[0]) != std::string::npos;
}

void refuse_unknown(const TextReader& reader, const CsvColumns& columns) {
  if (!columns.unknown.empty())
    reader.fail("known columns", fmt::format("{}, unknown", in_quotes(columns.unknown.front())));
}

/// Returns names in quotes, at most four.
std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 4;
  std::string text;
  for (std::size_t k = 0; k < std::min(names.size(), kMost); ++k)
    text += (k > 0 ? ", " : "") + in_quotes(names[k]);
  return names.size() > kMost ? fmt::format("{} and {} more", text, names.size() - kMost) : text;
}

}  // namespace

bool looks_like_csv(std::string_view text) noexcept {
  const std::string name;
  TextReader reader(name, text.substr(0, kMaxPreamble));
  return read_preamble(reader).header.has_value();
}

SampleFile parse_csv(const FileBytes& file, const OpenOptions& options) {
  TextReader reader(file);
  const Preamble preamble = read_preamble(reader);
  if (!preamble.header) reader.fail("a header line", "none");
  if (is_texel_header(*preamble.header))
    reader.fail("samples of one material", "samples of texels, which fit-surface reads");
  const CsvColumns columns = read_columns(reader, *preamble.header, true);
  const auto asked = asked_kind(options);
  const ValueKind kind = asked               ? *asked
                         : columns.kind      ? *columns.kind
                         : preamble.says_brf ? ValueKind::brf
                                             : ValueKind::f;

  SampleFile result;
  Samples& samples = result.samples;
  samples.channels = columns.values.size();
  Rows rows(reader, columns, *preamble.header);
  Tag tag = preamble.tag;
  std::size_t missing = 0, grazing = 0;
  double largest_angle = 0;
  SpectraOfRows spectra;
  while (next_row(reader, tag)) {
    rows.read();
    if (std::any_of(columns.values.begin(), columns.values.end(),
                    [&](std::size_t at) { return rows.missing(at); })) {
      ++missing;
      continue;
    }
    const DirectionPair pair = read_pair(reader, columns, rows);
    if (!(pair.wi.z > 0 && pair.wo.z > 0))
      reader.fail("directions above the horizon", in_quotes(reader.line()));
    const std::size_t before = samples.values.size();
    for (const std::size_t at : columns.values) {
      const double value = f_of_value(kind, rows.number(at), pair);
      if (std::isinf(value))
        reader.fail("a value that is finite after division by its cosine", in_quotes(reader.line()));
      samples.values.push_back(value);
    }
    if (std::isnan(samples.values[before])) {
      samples.values.resize(before);
      ++grazing;
      continue;
    }
    if (columns.wavelength) {
      spectra.add(reader, pair, rows.number(*columns.wavelength), samples.values.back());
      samples.values.pop_back();
    } else {
      samples.pairs.push_back(pair);
    }
    if (!columns.vectors)
      for (const auto& at : columns.direction)
        if (at) largest_angle = std::max(largest_angle, std::abs(rows.number(*at)));
  }

  Findings& findings = result.findings;
  findings.format = "CSV of scattered samples";
  findings.description = preamble.remarks;
  findings.lambda_nm = columns.lambda_nm;
  findings.conventions = {columns.vectors ? "Directions as unit vectors." : "Directions as angles.",
                          kind_sentence(kind, asked          ? "as asked"
                                              : columns.kind ? "as the column's name says"
                                                             : "as the file's first lines say")};
  if (columns.wavelength) spectra.finish(columns.to_nm, samples, findings);
  const bool one_azimuth = !columns.vectors && !columns.direction[1];
  const bool one_incident_azimuth = one_azimuth || same_incident_azimuth(samples);
  samples.isotropic = tag == Tag::isotropic || (tag == Tag::none && one_incident_azimuth);
  if (columns.in_plane)
    findings.conventions.push_back(settle_plane(samples));
  else if (one_azimuth)
    findings.conventions.push_back("The file has no phi_i: it is taken as 0.");
  findings.conventions.push_back(
      tag == Tag::none ? (one_azimuth            ? "Taken as isotropic: the file has no phi_i."
                          : one_incident_azimuth ? "Taken as isotropic: every sample has the same phi_i."
                                                 : settle_isotropy(samples))
                       : (samples.isotropic ? "Isotropic, the file says." : "Anisotropic, the file says."));
  if (!columns.unknown.empty())
    findings.warnings.push_back(fmt::format("Columns passed over: {}.", some_of(columns.unknown)));
  if (missing > 0)
    findings.warnings.push_back(fmt::format("{} rows without a value were left out.", missing));
  if (grazing > 0)
    findings.warnings.push_back(
        fmt::format("{} rows on the horizon were left out: their cosine cannot be divided out.", grazing));
  if (!columns.vectors && !columns.units_named && largest_angle > 0 && largest_angle < kLargestOfRadians)
    findings.warnings.push_back(
        "All angles are below 3.2 and were taken as degrees: radians have names such as theta_i_rad.");
  finish_samples(file.name, options, result);
  if (!columns.in_plane) check_azimuths(samples, findings);
  return result;
}

bool looks_like_texel_csv(std::string_view text) noexcept {
  const std::string name;
  TextReader reader(name, text.substr(0, kMaxPreamble));
  const Preamble preamble = read_preamble(reader);
  return preamble.header && is_texel_header(*preamble.header);
}

TexelCsv parse_texel_csv(const FileBytes& file, int most) {
  TextReader reader(file);
  const Preamble preamble = read_preamble(reader);
  if (!preamble.header) reader.fail("a header line", "none");
  const CsvColumns columns = read_columns(reader, *preamble.header, true, kTexelNames);
  refuse_unknown(reader, columns);
  for (const std::size_t k : {0u, 1u})
    if (!columns.others[k]) reader.fail(fmt::format("a column {}", kTexelNames[k]), in_quotes(reader.line()));
  if (!columns.lambda_nm.empty() || columns.wavelength)
    reader.fail("columns r, g, b or value", in_quotes(reader.line()));
  const bool says_held_out = columns.others[2].has_value();

  TexelCsv result;
  Rows rows(reader, columns, *preamble.header);
  Tag tag = preamble.tag;
  const auto whole = [&](std::size_t other, int largest) {
    const double value = rows.number(*columns.others[other]);
    if (!(value >= 0 && value <= largest && value == std::floor(value)))
      reader.fail(fmt::format("{} as a whole number of at most {}", kTexelNames[other], largest),
                  fmt::format("{}", value));
    return static_cast<int>(value);
  };
  while (next_row(reader, tag)) {
    rows.read();
    const DirectionPair pair = read_pair(reader, columns, rows);
    if (!(pair.wi.z > 0 && pair.wo.z > 0))
      reader.fail("directions above the horizon", in_quotes(reader.line()));
    result.texels.push_back({whole(0, most), whole(1, most)});
    if (says_held_out) result.held_out.push_back(static_cast<std::uint8_t>(whole(2, 1)));
    result.pairs.push_back(pair);
    std::array<float, 3>& f = result.f.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = rows.number(columns.values[columns.values.size() == 1 ? 0 : c]);
      f[c] = static_cast<float>(f_of_value(columns.kind.value_or(ValueKind::f), value, pair));
      if (!std::isfinite(f[c])) reader.fail("a value that a float holds", in_quotes(reader.line()));
    }
  }
  return result;
}

std::string samples_csv(const Samples& samples, std::span<const double> lambda_nm) {
  const auto channels = samples.channels;
  if (lambda_nm.empty() ? channels != 1 && channels != 3 : lambda_nm.size() != channels)
    throw Error(fmt::format("CSV columns: expected 1 or 3 channels or as many wavelengths, found {} channels",
                            channels));
  std::string text = samples.isotropic ? "# isotropic\n" : "# anisotropic\n";
  text += fmt::format("{}", fmt::join(kVectorNames, ","));
  if (!lambda_nm.empty())
    for (const double lambda : lambda_nm) text += fmt::format(",value_{}", lambda);
  else
    text += channels == 3 ? ",r,g,b" : ",value";
  text += '\n';
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& [wi, wo] = samples.pairs[i];
    // The sum makes 0 of -0.
    text += fmt::format("{},{},{},{},{},{}", wi.x + 0.0, wi.y + 0.0, wi.z, wo.x + 0.0, wo.y + 0.0, wo.z);
    for (const double value : samples.at(i)) text += fmt::format(",{}", value);
    text += '\n';
  }
  return text;
}

DirectionTable parse_directions(const FileBytes& given) {
  const std::optional<FileBytes> converted = from_utf16(given);
  const FileBytes& file = converted ? *converted : given;
  TextReader reader(file);
  const Preamble preamble = read_preamble(reader);
  if (!preamble.header) reader.fail("a header line that names wi_x, wi_y, wi_z, wo_x, wo_y and wo_z", "none");
  const CsvColumns columns = read_columns(reader, *preamble.header, false);
  refuse_unknown(reader, columns);
  DirectionTable table;
  std::vector<std::size_t> places;
  for (const auto& at : columns.direction)
    if (at) places.push_back(*at);
  std::ranges::sort(places);
  Rows rows(reader, columns, *preamble.header);
  for (const std::size_t at : places) table.names.push_back(rows.name(at));
  Tag tag = preamble.tag;
  while (next_row(reader, tag)) {
    rows.read();
    table.pairs.push_back(read_pair(reader, columns, rows));
    for (const std::size_t at : places) table.numbers.push_back(rows.number(at));
  }
  return table;
}

}  // namespace burnish
