// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include <burnish/io/part_choice.h>
#include <burnish/io/speos_scattering.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

namespace {

constexpr double kLeastCosine = 1e-6;     // f of the Gaussian share stays finite at the horizon
constexpr double kLeastWidth_deg = 1e-3;  // narrower light is a mirror's, and its peak overflows
constexpr std::string_view kSimpleScattering = "OPTIS - Simple scattering surface file";

/// Shares of the light received, in [0, 1], and the width of the Gaussian in radians.
struct ScatteringSide {
  double lambertian = 0, gaussian = 0, specular = 0, fwhm = 0;
};

/// Returns exp(-4 ln 2 (angle / fwhm)^2).
double gaussian_of(double angle, double fwhm) noexcept {
  const double relative = angle / fwhm;
  return std::exp(-4 * std::numbers::ln2 * relative * relative);
}

/// Returns the integral of gaussian_of over the sphere.
double gaussian_integral(double fwhm) noexcept {
  // The interval ends where the Gaussian is below 1e-17, or at the opposite direction. Simpson's rule of 2,000 steps is
  // exact to 1e-11 there.
  constexpr int kSteps = 2000;
  const double end = std::min(kPi, 4 * fwhm), step = end / kSteps;
  double sum = 0;
  for (int k = 0; k <= kSteps; ++k) {
    const double angle = k * step;
    const double weight = k == 0 || k == kSteps ? 1 : k % 2 == 1 ? 4 : 2;
    sum += weight * std::sin(angle) * gaussian_of(angle, fwhm);
  }
  return kTwoPi * sum * step / 3;
}

double percentage(TextReader& reader, std::string_view what) {
  const double value = reader.number(what);
  if (!(value >= 0 && value <= 100))
    reader.fail(fmt::format("{} in [0, 100] %", what), fmt::format("{}", value));
  return value / 100;
}

/// Returns a side's shares of `received`. Throws Error if they exceed it.
ScatteringSide side_of(const TextReader& reader, double received, double lambertian, double gaussian,
                       double fwhm_deg) {
  constexpr double kSlack = 1e-9;
  if (lambertian + gaussian > 1 + kSlack)
    reader.fail("Lambertian and Gaussian shares of at most 100 %",
                fmt::format("{:.6g} %", 100 * (lambertian + gaussian)));
  if (gaussian > 0 && !(fwhm_deg >= kLeastWidth_deg && fwhm_deg <= 360))
    reader.fail(fmt::format("a width in [{}, 360] degrees", kLeastWidth_deg), fmt::format("{}", fwhm_deg));
  return {.lambertian = received * lambertian,
          .gaussian = received * gaussian,
          .specular = received * std::max(0.0, 1 - lambertian - gaussian),
          .fwhm = radians(fwhm_deg)};
}

/// Moves to the next line that has words.
void next_filled_line(TextReader& reader, const char* what) {
  if (!reader.next_content_line()) reader.fail(what, "the end of the file");
}

/// A part of the file.
struct ScatteringPart {
  BsdfPart part;
  ScatteringSide side;
};

std::vector<ScatteringPart> read_both_sides(TextReader& reader) {
  next_filled_line(reader, "absorption and shares");
  const double received = 1 - percentage(reader, "absorption");
  const double lambertian_r = percentage(reader, "a Lambertian share"),
               lambertian_t = percentage(reader, "a Lambertian share"),
               gaussian_r = percentage(reader, "a Gaussian share"),
               gaussian_t = percentage(reader, "a Gaussian share");
  next_filled_line(reader, "two widths");
  const double fwhm_r = reader.number("a width"), fwhm_t = reader.number("a width");
  next_filled_line(reader, "whether Fresnel's law holds");
  if (reader.number("whether Fresnel's law holds") != 0)
    reader.fail("a stated reflectance (0), because Fresnel's law needs an index that the file has not",
                in_quotes(reader.line()));
  next_filled_line(reader, "the reflectance");
  const double reflectance = percentage(reader, "the reflectance");
  return {
      {BsdfPart::reflection_front, side_of(reader, received * reflectance, lambertian_r, gaussian_r, fwhm_r)},
      {BsdfPart::transmission_front,
       side_of(reader, received * (1 - reflectance), lambertian_t, gaussian_t, fwhm_t)}};
}

std::vector<ScatteringPart> read_one_side(TextReader& reader, BsdfPart part) {
  next_filled_line(reader, "absorption, shares and a width");
  const double received = 1 - percentage(reader, "absorption");
  const double lambertian = percentage(reader, "a Lambertian share"),
               gaussian = percentage(reader, "a Gaussian share"), fwhm = reader.number("a width");
  return {{part, side_of(reader, received, lambertian, gaussian, fwhm)}};
}

FunctionBrdf function_of(const ScatteringSide& side) {
  const double peak = side.gaussian > 0 ? side.gaussian / gaussian_integral(side.fwhm) : 0;
  return {1, true, [side, peak](std::span<const DirectionPair> pairs, std::span<double> values) {
            for (std::size_t k = 0; k < pairs.size(); ++k) {
              const auto& [wi, wo] = pairs[k];
              values[k] = side.lambertian / kPi;
              if (peak > 0)
                values[k] += peak * gaussian_of(angle_between(mirror(wi), wo), side.fwhm) /
                             std::max(wo.z, kLeastCosine);
            }
          }};
}

}  // namespace

bool looks_like_speos_scattering(std::string_view text) noexcept {
  return text.starts_with(kSimpleScattering);
}

SpeosScatteringFile parse_speos_scattering(const FileBytes& file, const OpenOptions& options) {
  TextReader reader(file);
  Findings findings;
  reader.next_line();
  if (!reader.next_line()) reader.fail("a description", "the end of the file");
  findings.description = printable(trimmed(reader.line()), 160);
  next_filled_line(reader, "Reflection, Transmission or Both");
  const std::string mode(reader.word());
  if (mode != "Reflection" && mode != "Transmission" && mode != "Both")
    reader.fail("Reflection, Transmission or Both", in_quotes(mode));
  const std::vector<ScatteringPart> parts =
      mode == "Both" ? read_both_sides(reader)
                     : read_one_side(reader, mode == "Reflection" ? BsdfPart::reflection_front
                                                                  : BsdfPart::transmission_front);
  std::vector<BsdfBlock> blocks;
  for (const ScatteringPart& part : parts) blocks.push_back({part.part, {}});
  const std::size_t chosen = choose_block(file.name, blocks, options);
  note_blocks(blocks, chosen, options, findings);
  const ScatteringSide& side = parts[chosen].side;
  findings.format = "Speos simple scattering";
  findings.conventions.insert(
      findings.conventions.begin(),
      fmt::format("Lambertian {:.4g} %, Gaussian {:.4g} % of {:.4g} degrees, specular {:.4g} % of the light.",
                  100 * side.lambertian, 100 * side.gaussian, degrees(side.fwhm), 100 * side.specular));
  if (side.specular > 0) {
    findings.direct = {{0, side.specular}, {kHalfPi, side.specular}};
    findings.left_out.push_back(fmt::format("the specular share of {:.4g} %", 100 * side.specular));
  }
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (k != chosen) findings.left_out.push_back(to_string(blocks[k]));
  findings.theta_i_max = findings.theta_o_max = kHalfPi;
  return {function_of(side), std::move(findings)};
}

}  // namespace burnish
