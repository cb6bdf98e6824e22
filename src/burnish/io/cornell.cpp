// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include <burnish/io/cornell.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

/// Returns the next number, on the next line with content if the current one has no word left. Numbers may
/// wrap over lines.
double wrapped_number(TextReader& reader, std::string_view what) {
  for (;;) {
    const std::string_view word = reader.word();
    if (!word.empty()) {
      if (const auto value = parse_number(word)) return *value;
      reader.fail(fmt::format("a finite number for {}", what), in_quotes(word));
    }
    if (!reader.next_content_line()) reader.fail(fmt::format("a number for {}", what), "the end of the file");
  }
}

Vec3 direction(TextReader& reader, std::string_view theta_name, std::string_view phi_name) {
  const double theta = wrapped_number(reader, theta_name);
  if (!(theta >= 0 && theta < kHalfPi))
    reader.fail(fmt::format("{} in [0, pi/2)", theta_name), fmt::format("{}", theta));
  return spherical_direction(theta, wrapped_number(reader, phi_name));
}

/// Joins the first comment lines, which are the material's name and remarks.
std::string remarks(const FileBytes& file) {
  std::string joined;
  TextReader reader(file);
  while (reader.next_line() && reader.line().starts_with('#')) {
    const std::string_view remark = trimmed(reader.line().substr(1));
    if (!remark.empty()) joined += (joined.empty() ? "" : ", ") + printable(remark, 80);
  }
  return joined.substr(0, 240);
}

}  // namespace

bool looks_like_cornell(std::string_view text) noexcept {
  const std::string_view line = trimmed(first_content_line(text));
  return !line.empty() && line.size() < 8 &&
         std::all_of(line.begin(), line.end(), [](char c) { return c >= '0' && c <= '9'; });
}

SampleFile parse_cornell(const FileBytes& file, const OpenOptions& options) {
  TextReader reader(file);
  if (!reader.next_content_line()) reader.fail("the number of wavelengths", "the end of the file");
  const std::size_t bands = reader.count("the number of wavelengths", 1, kMaxFileChannels);
  reader.end_of_line();

  SampleFile result;
  Samples& samples = result.samples;
  result.findings.format = "Cornell scattered spectra";
  result.findings.description = remarks(file);
  result.findings.conventions = {
      "Angles in radians; theta_i, phi_i to the light, theta_s, phi_s to the viewer; the "
      "mirror direction is at phi_s = phi_i + 180 degrees.",
      "Taken as isotropic.", "Between samples: the mean of the nearest ones, as pbrt-v2 reads such files."};
  for (std::size_t k = 0; k < bands; ++k)
    result.findings.lambda_nm.push_back(wrapped_number(reader, "a wavelength"));
  reader.end_of_line();

  samples.channels = bands;
  samples.isotropic = true;
  const std::size_t shortest_row = 2 * (4 + bands);  // a number takes a digit and a separator
  samples.values.reserve(reader.remaining() / shortest_row / 4 * bands);
  while (reader.next_content_line()) {
    const Vec3 wi = direction(reader, "theta_i", "phi_i");
    samples.pairs.push_back({wi, direction(reader, "theta_s", "phi_s")});
    for (std::size_t k = 0; k < bands; ++k) samples.values.push_back(wrapped_number(reader, "a value"));
    reader.end_of_line();
  }
  finish_samples(file.name, options, result);
  return result;
}

}  // namespace burnish
