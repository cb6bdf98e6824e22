// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/io/illuminant.h>
#include <burnish/io/sample_file.h>
#include <burnish/math/angles.h>
#include <burnish/math/written_degrees.h>

namespace burnish {

namespace {

constexpr std::size_t kFewestCovering = 10;  // a set of fewer samples is no survey of a surface
constexpr double kOneAngle = 1e-4;           // radians; angles that differ by less count as one

std::vector<double> to_rec709(const Samples& samples, std::span<const std::array<double, 3>> weights) {
  std::vector<double> rgb(samples.size() * 3, 0.0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto spectrum = samples.at(i);
    for (std::size_t k = 0; k < weights.size(); ++k)
      for (std::size_t c = 0; c < 3; ++c) rgb[3 * i + c] += weights[k][c] * spectrum[k];
  }
  return rgb;
}

}  // namespace

bool same_incident_azimuth(const Samples& samples) noexcept {
  if (samples.pairs.empty()) return true;
  const double first = phi_of(samples.pairs.front().wi);
  return std::all_of(samples.pairs.begin(), samples.pairs.end(), [&](const DirectionPair& pair) {
    // The normal has any azimuth.
    return std::hypot(pair.wi.x, pair.wi.y) < 1e-6 ||
           std::abs(std::remainder(phi_of(pair.wi) - first, kTwoPi)) < 1e-6;
  });
}

void finish_samples(const std::string& file, const OpenOptions& options, SampleFile& result) {
  Samples& samples = result.samples;
  Findings& findings = result.findings;
  if (samples.size() == 0) throw Error::in_file(file, "at least one measurement", "none");

  // Negative values are counted.
  for (const double value : samples.values) {
    findings.negative_count += value < 0;
    findings.most_negative = std::min(findings.most_negative, value);
  }

  // Spectra are kept or become linear Rec. 709, in which colours outside the gamut have negative values too.
  if (!findings.lambda_nm.empty()) {
    const auto& lambda = findings.lambda_nm;
    if (lambda.front() <= 0 ||
        std::adjacent_find(lambda.begin(), lambda.end(), std::greater_equal<>{}) != lambda.end())
      throw Error::in_file(file, "positive, increasing wavelengths",
                           fmt::format("{} ... {} nm out of order", lambda.front(), lambda.back()));
    if (!options.keep_spectral && lambda.size() > 1) {
      samples.values = to_rec709(samples, rec709_weights_of(file, lambda, options.illuminant));
      samples.channels = 3;
      findings.illuminant = illuminant_name(options.illuminant);
      findings.conventions.push_back(fmt::format("{} wavelengths, {} to {} nm, became linear Rec. 709 ({}).",
                                                 lambda.size(), lambda.front(), lambda.back(),
                                                 findings.illuminant));
      if (const auto outside = std::ranges::count_if(samples.values, [](double v) { return v < 0; }))
        findings.conventions.push_back(
            fmt::format("{} values are below zero: colours outside the gamut, or noise.", outside));
      findings.lambda_nm.clear();
    }
  }

  // The findings state the number of samples and the angles covered.
  findings.sample_count = samples.size();
  findings.theta_i_min = findings.theta_o_min = kHalfPi;
  for (const auto& [wi, wo] : samples.pairs) {
    const double theta_i = theta_of(wi), theta_o = theta_of(wo);
    findings.theta_i_min = std::min(findings.theta_i_min, theta_i);
    findings.theta_i_max = std::max(findings.theta_i_max, theta_i);
    findings.theta_o_min = std::min(findings.theta_o_min, theta_o);
    findings.theta_o_max = std::max(findings.theta_o_max, theta_o);
  }
  for (std::string& gap : coverage_gaps(samples)) findings.warnings.push_back(std::move(gap));
}

std::vector<std::string> coverage_gaps(const Samples& samples) {
  if (samples.size() < kFewestCovering) return {};
  const auto is_one = [&](Vec3 DirectionPair::*direction) {
    const double first = theta_of(samples.pairs.front().*direction);
    return std::ranges::all_of(samples.pairs, [&](const DirectionPair& pair) {
      return std::abs(theta_of(pair.*direction) - first) < kOneAngle;
    });
  };
  const bool in_plane = std::ranges::all_of(samples.pairs, [](const DirectionPair& pair) {
    return std::abs(pair.wi.x * pair.wo.y - pair.wi.y * pair.wo.x) < kOneAngle;
  });
  const auto theta = [&](Vec3 DirectionPair::*direction) {
    return written_degrees(theta_of(samples.pairs.front().*direction));
  };
  std::vector<std::string> gaps;
  if (is_one(&DirectionPair::wo))
    gaps.push_back(
        fmt::format("One angle of view only, theta_o = {} degrees: all other values are extrapolated.",
                    theta(&DirectionPair::wo)));
  if (is_one(&DirectionPair::wi))
    gaps.push_back(
        fmt::format("One angle of incidence only, theta_i = {} degrees: all other values are extrapolated.",
                    theta(&DirectionPair::wi)));
  if (in_plane && gaps.empty())
    gaps.push_back("In the plane of incidence only: all other values are extrapolated.");
  return gaps;
}

}  // namespace burnish
