// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <burnish/io/astm.h>
#include <burnish/io/sample_checks.h>
#include <burnish/io/text_reader.h>
#include <burnish/io/value_kind.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

bool is_vars_line(std::string_view line) noexcept {
  line = trimmed(line);
  return line.starts_with("VARS") && (line.size() == 4 || line[4] == ' ' || line[4] == '\t');
}

std::vector<std::string> variable_names(std::string_view line) {
  std::string_view rest = trimmed(trimmed(line).substr(4));
  std::vector<std::string> names;
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    names.emplace_back(trimmed(rest.substr(0, comma)));
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return names;
}

/// Returns the number of words left in the current line.
std::size_t words_left(TextReader reader) noexcept {
  std::size_t count = 0;
  while (!reader.word().empty()) ++count;
  return count;
}

constexpr std::array<std::string_view, 4> kAngles = {"theta_i", "phi_i", "theta_s", "phi_s"};

/// The place of each quantity in a row.
struct AstmColumns {
  std::array<std::size_t, 4> angle{};  // columns of kAngles
  std::vector<std::size_t> values;
  std::vector<double> lambda_nm;  // wavelengths of the values, or empty
  std::optional<ValueKind> kind;  // the kind that the first name states
};

/// Returns the kind of values that a name such as "CCBRDF" or "Red BRDF" states.
std::optional<ValueKind> kind_of_column(std::string_view name) {
  const std::string lower = lower_case(name);
  if (const auto kind = kind_of_name(lower)) return kind;
  const std::size_t blank = lower.find_last_of(" _");
  return blank == std::string::npos ? std::nullopt : kind_of_name(lower.substr(blank + 1));
}

/// Sorts the columns into the four angles and the values.
AstmColumns sort_columns(const TextReader& reader, const std::vector<std::string>& names,
                         const std::string& vars_line) {
  AstmColumns columns;
  for (std::size_t k = 0; k < 4; ++k) {
    if (std::count(names.begin(), names.end(), kAngles[k]) != 1)
      reader.fail(fmt::format("{} once in the VARS line", kAngles[k]), in_quotes(vars_line));
    columns.angle[k] =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), kAngles[k]) - names.begin());
  }
  for (std::size_t at = 0; at < names.size(); ++at)
    if (std::find(kAngles.begin(), kAngles.end(), names[at]) == kAngles.end()) {
      columns.values.push_back(at);
      if (!columns.kind) columns.kind = kind_of_column(names[at]);
      if (const auto lambda = parse_number(names[at])) columns.lambda_nm.push_back(*lambda);
    }
  const std::size_t channels = columns.values.size();
  const bool named =
      columns.lambda_nm.empty() ? channels == 1 || channels == 3 : columns.lambda_nm.size() == channels;
  if (!named || channels > kMaxFileChannels)
    reader.fail("one, three or one a wavelength value columns in the VARS line", fmt::format("{}", channels));
  return columns;
}

}  // namespace

bool looks_like_astm(std::string_view text) noexcept {
  text = text.substr(0, 65536);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    if (is_vars_line(text.substr(0, end))) return true;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return false;
}

SampleFile parse_astm(const FileBytes& file, const OpenOptions& options) {
  TextReader reader(file);
  bool found = false;
  while (!found && reader.next_line()) found = is_vars_line(reader.line());
  if (!found) reader.fail("a VARS line", "the end of the file");
  std::vector<std::string> names = variable_names(reader.line());
  SampleFile result;
  Findings& findings = result.findings;
  findings.format = "ASTM E1392 text";
  findings.conventions = {"Angles in radians; theta_i, phi_i to the light, theta_s, phi_s to the viewer."};

  // Some files forget a name: the rows show it.
  const std::string vars_line(reader.line());
  bool rows = reader.next_content_line();
  const bool forgotten = std::find(names.begin(), names.end(), kAngles[3]) == names.end();
  if (forgotten) {
    if (!rows || words_left(reader) != names.size() + 1)
      reader.fail("phi_s in the VARS line, or rows with one column more than it names", in_quotes(vars_line));
    const auto theta_s = std::find(names.begin(), names.end(), kAngles[2]);
    if (theta_s == names.end()) reader.fail("theta_s in the VARS line", in_quotes(vars_line));
    names.insert(theta_s + 1, std::string(kAngles[3]));
    findings.conventions.push_back("The VARS line leaves out phi_s; the rows have it after theta_s.");
  }

  const AstmColumns columns = sort_columns(reader, names, vars_line);
  findings.lambda_nm = columns.lambda_nm;
  const auto asked = asked_kind(options);
  const ValueKind kind = asked ? *asked : columns.kind.value_or(ValueKind::f);
  findings.conventions.push_back(kind_sentence(
      kind,
      asked ? "as asked" : fmt::format("as the name {} says", in_quotes(names[columns.values.front()]))));

  Samples& samples = result.samples;
  samples.channels = columns.values.size();
  std::size_t grazing = 0;
  std::vector<double> row(names.size());
  for (; rows; rows = reader.next_content_line()) {
    for (std::size_t at = 0; at < row.size(); ++at) row[at] = reader.number(names[at]);
    reader.end_of_line();
    const auto angle = [&](std::size_t k) { return row[columns.angle[k]]; };
    for (const std::size_t k : {0, 2})
      if (!(std::abs(angle(k)) < kHalfPi))
        reader.fail(fmt::format("{} within (-pi/2, pi/2)", kAngles[k]),
                    fmt::format("{}{}", angle(k), std::abs(angle(k)) > kTwoPi ? ": degrees?" : ""));
    const DirectionPair pair{spherical_direction(angle(0), angle(1)),
                             spherical_direction(angle(2), angle(3))};
    const std::size_t before = samples.values.size();
    for (const std::size_t at : columns.values) samples.values.push_back(f_of_value(kind, row[at], pair));
    if (std::isnan(samples.values[before])) {
      samples.values.resize(before);
      ++grazing;
    } else {
      samples.pairs.push_back(pair);
    }
  }
  if (grazing > 0)
    findings.warnings.push_back(
        fmt::format("{} rows on the horizon were left out: their cosine cannot be divided out.", grazing));
  samples.isotropic = same_incident_azimuth(samples);
  findings.conventions.push_back(samples.isotropic ? "Taken as isotropic: every sample has the same phi_i."
                                                   : settle_isotropy(samples));
  finish_samples(file.name, options, result);
  check_azimuths(samples, findings);
  return result;
}

std::string samples_astm(const Samples& samples, std::span<const double> lambda_nm) {
  const auto channels = samples.channels;
  if (lambda_nm.empty() ? channels != 1 && channels != 3 : lambda_nm.size() != channels)
    throw Error(fmt::format(
        "ASTM columns: expected 1 or 3 channels or as many wavelengths, found {} channels", channels));
  std::string text = fmt::format("NUM_POINTS {}\nVARS {}", samples.size(), fmt::join(kAngles, ","));
  if (!lambda_nm.empty())
    text += fmt::format(",{}", fmt::join(lambda_nm, ","));
  else
    text += channels == 3 ? ",Red BRDF,Green BRDF,Blue BRDF" : ",BRDF";
  text += '\n';
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& [wi, wo] = samples.pairs[i];
    const double turn = samples.isotropic ? phi_of(wi) : 0;
    text += fmt::format("{},{},{},{}", theta_of(wi), phi_of(wi) - turn, theta_of(wo), phi_of(wo) - turn);
    for (const double value : samples.at(i)) text += fmt::format(",{}", value);
    text += '\n';
  }
  return text;
}

}  // namespace burnish
