// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <burnish/io/utia.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr std::size_t kThetas = 6, kPhis = 48, kPlanes = 3;
constexpr std::size_t kDirections = kThetas * kPhis, kPlane = kDirections * kDirections;
constexpr std::size_t kBytes = kPlanes * kPlane * sizeof(double);
constexpr double kThetaStep = radians(15), kPhiStep = radians(7.5);

// dj_brdf.h has these numbers in utia::eval and utia::normalize: the scale, and sRGB's transfer function with
// its own knee.
constexpr double kStoredWhite = 140, kScale = 100, kKnee = 0.0375, kSlope = 12.92;
constexpr double kAboveKnee = kKnee * (1 + 1e-14);  // above the knee after any rounding

double f_of_stored(double stored) noexcept {
  const double v = stored / kStoredWhite;
  return kScale * (v > kKnee ? std::pow((v + 0.055) / 1.055, 2.4) : v / kSlope);
}

double stored_of_f(double f) noexcept {
  const double linear = f / kScale;
  // The curve jumps at its knee. A value within the jump takes the nearer side.
  static const double upper = std::pow((kKnee + 0.055) / 1.055, 2.4), middle = (upper + kKnee / kSlope) / 2;
  return kStoredWhite * (linear > middle ? std::max(1.055 * std::pow(linear, 1 / 2.4) - 0.055, kAboveKnee)
                                         : std::min(linear * kSlope, kKnee));
}

double stored_at(std::span<const std::byte> bytes, std::size_t index) noexcept {
  double value;
  std::memcpy(&value, bytes.data() + index * sizeof(double), sizeof(double));
  return value;
}

/// Returns the place in the file of a table's entry. The table's axes are phi_i, theta_i, theta_o and phi_o - phi_i.
std::size_t place_of(const AngleTable& table, std::size_t entry) noexcept {
  const auto [phi_i, theta_i, theta_o, turn] = node_of_entry(table, entry);
  return (theta_i * kPhis + phi_i) * kDirections + theta_o * kPhis + (phi_i + turn) % kPhis;
}

}  // namespace

bool looks_like_utia(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() != kBytes) return false;
  // Text and other numbers, read as doubles, are tiny or huge almost everywhere.
  std::size_t likely = 0;
  for (std::size_t i = 0; i < kPlanes * kPlane; i += 97) {
    const double size = std::abs(stored_at(bytes, i));
    likely += size == 0 || (size > 1e-12 && size < 1e9);
  }
  return likely * 97 >= kPlanes * kPlane * 9 / 10;
}

AngleTable utia_layout() {
  std::vector<double> thetas, phis;
  for (std::size_t i = 0; i < kThetas; ++i) thetas.push_back(static_cast<double>(i) * kThetaStep);
  for (std::size_t i = 0; i < kPhis; ++i) phis.push_back(static_cast<double>(i) * kPhiStep);
  AngleTable table;
  table.channel_count = kPlanes;
  table.axes = {make_axis(phis, kTwoPi), make_axis(thetas), make_axis(thetas), make_axis(phis, kTwoPi)};
  table.axes[1].reach = table.axes[2].reach = kHalfPi - thetas.back();
  return table;
}

UtiaFile parse_utia(const FileBytes& file) {
  ByteReader reader(file);
  if (file.bytes.size() != kBytes)
    reader.fail(fmt::format("{} bytes of a UTIA table", kBytes), fmt::format("{}", file.bytes.size()));
  UtiaFile utia;
  AngleTable& table = utia.table;
  Findings& findings = utia.findings;
  table = utia_layout();
  table.values.resize(kPlanes * kPlane);
  for (std::size_t entry = 0; entry < kPlane; ++entry)
    for (std::size_t c = 0; c < kPlanes; ++c) {
      const std::size_t place = c * kPlane + place_of(table, entry);
      const double stored = stored_at(file.bytes, place), f = f_of_stored(stored);
      if (!(std::abs(f) <= std::numeric_limits<float>::max())) {
        reader.seek(place * sizeof(double));
        reader.fail("a finite value", fmt::format("{}", stored));
      }
      findings.negative_count += f < 0;
      findings.most_negative = std::min(findings.most_negative, f);
      table.values[entry * kPlanes + c] = static_cast<float>(f);
    }
  findings.format = "UTIA table";
  findings.description = "6 x 48 directions of light and view";
  findings.conventions = {
      "Stored values v are f_r = 100 g(v / 140), g the transfer function of sRGB, as dj_brdf has them.",
      "Measured to 75 degrees; constant from there to the horizon."};
  findings.sample_count = kPlane;
  findings.theta_i_max = findings.theta_o_max = table.axes[1].nodes.back();
  return utia;
}

bool fits_utia(const AngleTable& table) noexcept {
  const auto same = [](const std::vector<double>& nodes, std::size_t count, double step) {
    if (nodes.size() != count) return false;
    for (std::size_t i = 0; i < count; ++i)
      if (std::abs(nodes[i] - static_cast<double>(i) * step) > 1e-9) return false;
    return true;
  };
  return table.frame == AngleTable::Frame::normal && !table.folded && table.channel_count == 3 &&
         same(table.axes[0].nodes, kPhis, kPhiStep) && same(table.axes[1].nodes, kThetas, kThetaStep) &&
         same(table.axes[2].nodes, kThetas, kThetaStep) && same(table.axes[3].nodes, kPhis, kPhiStep);
}

std::string format_utia(const AngleTable& table) {
  if (!fits_utia(table))
    throw Error("UTIA: expected RGB values at the nodes of its table, found another table");
  std::string bytes(kBytes, '\0');
  for (std::size_t entry = 0; entry < kPlane; ++entry)
    for (std::size_t c = 0; c < kPlanes; ++c) {
      const auto f = static_cast<double>(table.values[entry * kPlanes + c]);
      const double stored = std::isnan(f) ? 0 : stored_of_f(f);
      std::memcpy(bytes.data() + (c * kPlane + place_of(table, entry)) * sizeof(double), &stored,
                  sizeof(stored));
    }
  return bytes;
}

}  // namespace burnish
