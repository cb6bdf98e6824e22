// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <burnish/io/fred.h>
#include <burnish/io/sample_checks.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

/// The form of the numbers in a file.
struct FredFormat {
  double to_radians = radians(1), scale = 1;
};

/// Moves to the next line that is neither blank nor a comment, which starts with '#' or '!'.
bool next_line(TextReader& reader) noexcept {
  while (reader.next_content_line())
    if (!trimmed(reader.line()).starts_with('!')) return true;
  return false;
}

FredFormat read_format(TextReader& reader) {
  FredFormat format;
  if (!next_line(reader)) reader.fail("a line 'format ...'", "the end of the file");
  if (lower_case(reader.word()) != "format") reader.fail("a line 'format ...'", in_quotes(reader.line()));
  for (std::string word = lower_case(reader.word()); !word.empty(); word = lower_case(reader.word())) {
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string key = word.substr(0, equals), value = word.substr(std::min(equals + 1, word.size()));
    if (key == "angles" && (value == "deg" || value == "rad"))
      format.to_radians = value == "deg" ? radians(1) : 1;
    else if (const auto scale = parse_number(value); key == "scale" && scale && *scale > 0)
      format.scale = *scale;
    else if (!(key == "bsdf" && value == "value"))
      reader.fail("angles=deg or rad, bsdf=value, scale=NUMBER", in_quotes(word));
  }
  return format;
}

/// Reads the numbers of the current line, two or three, and returns their count.
std::size_t read_numbers(TextReader& reader, std::array<double, 3>& numbers) {
  std::size_t count = 0;
  for (TextReader ahead = reader; !ahead.word().empty();) ++count;
  if (count != 2 && count != 3)
    reader.fail("theta and phi, or theta, phi and a value", in_quotes(reader.line()));
  for (std::size_t k = 0; k < count; ++k)
    numbers[k] = reader.number(std::array{"theta", "phi", "a value"}[k]);
  return count;
}

}  // namespace

bool looks_like_fred(std::string_view text) noexcept {
  const std::string_view line = trimmed(first_content_line(text));
  if (line.size() > 80) return false;
  const std::string lower = lower_case(line);
  const std::size_t second = lower.find_first_not_of(" \t", 4);
  return lower.starts_with("type") && second != std::string::npos && second > 4 &&
         lower.substr(second) == "bsdf_data";
}

SampleFile parse_fred(const FileBytes& file, const OpenOptions& options) {
  TextReader reader(file);
  next_line(reader);  // the type
  const FredFormat format = read_format(reader);

  SampleFile result;
  Samples& samples = result.samples;
  samples.channels = 1;
  samples.isotropic = true;
  std::optional<Vec3> wi;
  std::array<double, 3> numbers{};
  while (next_line(reader)) {
    const std::size_t count = read_numbers(reader, numbers);
    const Vec3 w = spherical_direction(numbers[0] * format.to_radians, numbers[1] * format.to_radians);
    if (!(w.z > 0)) reader.fail("directions above the horizon", in_quotes(reader.line()));
    if (count == 2) {
      wi = {-w.x, -w.y, w.z};
      continue;
    }
    if (!wi) reader.fail("theta and phi of a specular direction before values", in_quotes(reader.line()));
    const double value = numbers[2] * format.scale;
    if (!std::isfinite(value)) reader.fail("a finite value", in_quotes(reader.line()));
    samples.pairs.push_back({*wi, w});
    samples.values.push_back(value);
  }

  Findings& findings = result.findings;
  findings.format = "FRED tabulated BSDF";
  findings.conventions = {
      "A line of two angles is the specular direction: the light comes from its phi + 180 degrees.",
      "Values are f_r without the cosine.", "Isotropic, as FRED takes it."};
  if (format.scale != 1)
    findings.conventions.push_back(fmt::format("Values were multiplied by {}.", format.scale));
  finish_samples(file.name, options, result);
  check_azimuths(samples, findings);
  return result;
}

}  // namespace burnish
