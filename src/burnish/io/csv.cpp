#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <burnish/io/csv.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr std::array<std::string_view, 6> kVectorNames = {"wi_x", "wi_y", "wi_z", "wo_x", "wo_y", "wo_z"};
constexpr std::array<std::string_view, 3> kTexelNames = {"texel_x", "texel_y", "held_out"};
constexpr std::array<std::string_view, 4> kAngleNames = {"theta_i", "phi_i", "theta_o", "phi_o"};

std::vector<std::string> split_header(std::string_view line) {
  std::vector<std::string> names;
  for (;;) {
    const std::size_t comma = line.find(',');
    names.push_back(lower_case(trimmed(line.substr(0, comma))));
    if (comma == std::string_view::npos) return names;
    line.remove_prefix(comma + 1);
  }
}

/// Where each thing stands in a row.
struct CsvColumns {
  std::size_t count = 0;
  bool vectors = false;
  std::array<std::size_t, 6> direction{};  // columns of kVectorNames, or of kAngleNames
  std::array<double, 4> to_radians{};      // factor of each angle
  std::vector<std::size_t> values;         // column of each channel
  std::vector<double> lambda_nm;           // wavelength of each channel, or empty
  std::vector<std::size_t> others;  // column of each that a caller names, `count` where it is not there
};

std::size_t position(const std::vector<std::string>& names, std::string_view name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// Columns with those of the directions; the rest is empty.
CsvColumns find_directions(const TextReader& reader, const std::vector<std::string>& names) {
  CsvColumns columns;
  columns.count = names.size();
  columns.vectors = position(names, kVectorNames[0]) < names.size();
  const auto need = [&](std::string_view name) {
    const std::size_t at = position(names, name);
    if (at == names.size()) reader.fail(fmt::format("a column {}", name), in_quotes(reader.line()));
    return at;
  };
  if (columns.vectors) {
    for (std::size_t k = 0; k < 6; ++k) columns.direction[k] = need(kVectorNames[k]);
    return columns;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t in_radians = position(names, std::string(kAngleNames[k]) + "_rad");
    const bool is_rad = in_radians < names.size();
    columns.direction[k] = is_rad ? in_radians : need(kAngleNames[k]);
    columns.to_radians[k] = is_rad ? 1 : radians(1);
  }
  return columns;
}

/// Adds those of the values.
void find_values(const TextReader& reader, const std::vector<std::string>& names, CsvColumns& columns) {
  // one of: value; r, g and b; value_<nm> for every wavelength
  const std::size_t size = names.size();
  if (const std::size_t at = position(names, "value"); at < size) columns.values = {at};
  const std::array<std::size_t, 3> rgb = {position(names, "r"), position(names, "g"), position(names, "b")};
  if (columns.values.empty() &&
      std::all_of(rgb.begin(), rgb.end(), [&](std::size_t at) { return at < size; }))
    columns.values.assign(rgb.begin(), rgb.end());
  if (columns.values.empty())
    for (std::size_t at = 0; at < size; ++at)
      if (names[at].starts_with("value_"))
        if (const auto lambda = parse_number(std::string_view(names[at]).substr(6))) {
          columns.values.push_back(at);
          columns.lambda_nm.push_back(*lambda);
        }
  if (columns.values.empty()) reader.fail("columns r, g, b or value or value_<nm>", in_quotes(reader.line()));
  if (columns.values.size() > kMaxFileChannels)
    reader.fail(fmt::format("at most {} wavelengths", kMaxFileChannels),
                fmt::format("{}", columns.values.size()));
}

/// Of `others` those that are there are known too.
CsvColumns read_header(TextReader& reader, bool with_values, std::span<const std::string_view> others = {}) {
  const std::vector<std::string> names = split_header(reader.line());
  CsvColumns columns = find_directions(reader, names);
  if (with_values) find_values(reader, names, columns);
  std::size_t used = (columns.vectors ? 6 : 4) + columns.values.size();
  for (const std::string_view other : others) {
    columns.others.push_back(position(names, other));
    used += columns.others.back() < names.size();
  }
  if (used != names.size())
    reader.fail(fmt::format("{} columns", used),
                fmt::format("{}: a column is unknown or twice there", names.size()));
  return columns;
}

/// One row of numbers, as many as there are columns.
void read_row(TextReader& reader, std::span<double> row) {
  for (double& value : row) value = reader.number("every column");
  reader.end_of_line();
}

Vec3 unit_vector(const TextReader& reader, Vec3 w) {
  const double l = length(w);
  if (!(std::abs(l - 1) <= 0.01)) reader.fail("a unit vector", fmt::format("a length of {}", l));
  return std::abs(l - 1) < 1e-12 ? w : (1 / l) * w;
}

DirectionPair read_pair(const TextReader& reader, const CsvColumns& columns, std::span<const double> row) {
  const auto at = [&](std::size_t k) { return row[columns.direction[k]]; };
  if (columns.vectors)
    return {unit_vector(reader, {at(0), at(1), at(2)}), unit_vector(reader, {at(3), at(4), at(5)})};
  std::array<double, 4> angles;
  for (std::size_t k = 0; k < 4; ++k) angles[k] = at(k) * columns.to_radians[k];
  return {spherical_direction(angles[0], angles[1]), spherical_direction(angles[2], angles[3])};
}

/// What a comment says about the material.
enum class Tag { none, isotropic, anisotropic };

/// The lines with content of a file, and the last tag in front of the one it stands at.
struct TaggedLines {
  TextReader reader;
  Tag tag = Tag::none;

  /// Moves to the next line with content; false at the end of the file.
  bool next() {
    while (reader.next_line()) {
      const std::string_view line = trimmed(reader.line());
      if (line.empty()) continue;
      if (line[0] != '#') return true;
      const std::string remark = lower_case(trimmed(line.substr(1)));
      if (remark == "isotropic") tag = Tag::isotropic;
      if (remark == "anisotropic") tag = Tag::anisotropic;
    }
    return false;
  }
};

}  // namespace

bool looks_like_csv(std::string_view text) noexcept {
  const std::string_view line = first_content_line(text);
  return line.find("wi_x") != std::string_view::npos || line.find("theta_o") != std::string_view::npos;
}

SampleFile parse_csv(const FileBytes& file, const OpenOptions& options) {
  TaggedLines lines{TextReader(file)};
  TextReader& reader = lines.reader;
  if (!lines.next()) reader.fail("a header line", "the end of the file");
  if (looks_like_texel_csv(reader.line()))
    reader.fail("samples of one material", "those of texels, which fit-surface reads");
  const CsvColumns columns = read_header(reader, true);

  SampleFile result;
  Samples& samples = result.samples;
  samples.channels = columns.values.size();
  std::vector<double> row(columns.count);
  while (lines.next()) {
    read_row(reader, row);
    const DirectionPair pair = read_pair(reader, columns, row);
    if (!(pair.wi.z > 0 && pair.wo.z > 0))
      reader.fail("directions above the horizon", in_quotes(reader.line()));
    samples.pairs.push_back(pair);
    for (const std::size_t at : columns.values) {
      const double value = options.has_cosine ? row[at] / pair.wi.z : row[at];
      // a cosine near zero may push a finite number over the edge
      if (!std::isfinite(value)) reader.fail("a finite value over cos(theta_i)", in_quotes(reader.line()));
      samples.values.push_back(value);
    }
  }

  Findings& findings = result.findings;
  findings.format = "CSV of scattered samples";
  findings.lambda_nm = columns.lambda_nm;
  findings.conventions = {columns.vectors ? "Directions as unit vectors." : "Directions as angles.",
                          options.has_cosine ? "The cosine of theta_i was divided out, as asked."
                                             : "Values are f_r without the cosine."};
  const Tag tag = lines.tag;
  samples.isotropic = tag == Tag::isotropic || (tag == Tag::none && same_incident_azimuth(samples));
  findings.conventions.push_back(
      tag == Tag::none ? (samples.isotropic ? "Taken as isotropic: every sample has the same phi_i."
                                            : "Taken as anisotropic: the file does not say.")
                       : (samples.isotropic ? "Isotropic, the file says." : "Anisotropic, the file says."));
  finish_samples(file.name, options, result);
  return result;
}

bool looks_like_texel_csv(std::string_view text) noexcept {
  return looks_like_csv(text) && first_content_line(text).find(kTexelNames[0]) != std::string_view::npos;
}

TexelCsv parse_texel_csv(const FileBytes& file, int most) {
  TextReader reader(file);
  if (!reader.next_content_line()) reader.fail("a header line", "the end of the file");
  const CsvColumns columns = read_header(reader, true, kTexelNames);
  for (const std::size_t k : {0u, 1u})
    if (columns.others[k] == columns.count)
      reader.fail(fmt::format("a column {}", kTexelNames[k]), in_quotes(reader.line()));
  if (!columns.lambda_nm.empty()) reader.fail("columns r, g, b or value", in_quotes(reader.line()));
  const bool says_held_out = columns.others[2] < columns.count;

  TexelCsv result;
  std::vector<double> row(columns.count);
  const auto whole = [&](std::size_t other, int largest) {
    const double value = row[columns.others[other]];
    if (!(value >= 0 && value <= largest && value == std::floor(value)))
      reader.fail(fmt::format("{} as a whole number of at most {}", kTexelNames[other], largest),
                  fmt::format("{}", value));
    return static_cast<int>(value);
  };
  while (reader.next_content_line()) {
    read_row(reader, row);
    const DirectionPair pair = read_pair(reader, columns, row);
    if (!(pair.wi.z > 0 && pair.wo.z > 0))
      reader.fail("directions above the horizon", in_quotes(reader.line()));
    result.texels.push_back({whole(0, most), whole(1, most)});
    if (says_held_out) result.held_out.push_back(static_cast<std::uint8_t>(whole(2, 1)));
    result.pairs.push_back(pair);
    std::array<float, 3>& f = result.f.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      f[c] = static_cast<float>(row[columns.values[columns.values.size() == 1 ? 0 : c]]);
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
    text += fmt::format("{},{},{},{},{},{}", wi.x, wi.y, wi.z, wo.x, wo.y, wo.z);
    for (const double value : samples.at(i)) text += fmt::format(",{}", value);
    text += '\n';
  }
  return text;
}

std::vector<DirectionPair> parse_directions(const FileBytes& file) {
  TextReader reader(file);
  if (!reader.next_content_line()) reader.fail("a header line", "the end of the file");
  const CsvColumns columns = read_header(reader, false);
  std::vector<DirectionPair> pairs;
  std::vector<double> row(columns.count);
  while (reader.next_content_line()) {
    read_row(reader, row);
    pairs.push_back(read_pair(reader, columns, row));
  }
  return pairs;
}

}  // namespace burnish
