// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <burnish/io/merl.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

constexpr std::size_t kHeaderBytes = 12;
constexpr int kMaxSize = 3600;  // ten times the finest axis in use
/// A stored value times this factor of its channel is f_r. Source: [Matusik 2003].
constexpr std::array kScale = {1 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};

std::array<std::int32_t, 3> header_of(std::span<const std::byte> bytes) noexcept {
  std::array<std::int32_t, 3> sizes;
  std::memcpy(sizes.data(), bytes.data(), kHeaderBytes);
  return sizes;
}

double read_double(const std::byte* at) noexcept {
  double value;
  std::memcpy(&value, at, sizeof(value));
  return value;
}

/// The counts that one slice of theta_h adds to the findings.
struct SliceCount {
  std::uint64_t holes = 0, below_horizon = 0, negatives = 0;
  double most_negative = 0;
  bool finite = true;
  std::size_t bad_entry = 0;  // first entry that is not finite
};

/// Reads the entries of one theta_h from the file's three planes into the table. abs_cos_phi holds |cos
/// phi_d| of each entry of a row.
SliceCount read_slice(const std::byte* planes, int h, std::span<const double> abs_cos_phi,
                      HalfDiffTable& table) {
  const std::size_t entries = table.entry_count();
  SliceCount count;
  for (int d = 0; d < table.theta_d_count; ++d) {
    const HalfDiff angles = table.centre(h, d, 0);
    const double tangents = std::tan(angles.theta_h) * std::tan(angles.theta_d);
    const std::size_t row = table.offset(h, d, 0) / 3;
    for (std::size_t p = 0; p < abs_cos_phi.size(); ++p) {
      std::array<double, 3> f;
      for (std::size_t c = 0; c < 3; ++c)
        f[c] = read_double(planes + (c * entries + row + p) * sizeof(double));
      float* entry = &table.values[(row + p) * 3];

      // A direction of the pair is below the horizon if tan theta_h tan theta_d |cos phi_d| >= 1. The reason
      // is that cos theta_i, cos theta_o = cos theta_h cos theta_d -+ sin theta_h sin theta_d cos phi_d.
      const bool below = tangents * abs_cos_phi[p] >= 1;
      if (below || (f[0] == -1 && f[1] == -1 && f[2] == -1)) {
        ++count.holes;
        count.below_horizon += below;
        std::fill_n(entry, 3, std::numeric_limits<float>::quiet_NaN());
        continue;
      }

      for (std::size_t c = 0; c < 3; ++c) {
        const double value = f[c] * kScale[c];
        // The test also refuses values that a float cannot hold.
        if (!(std::abs(value) <= std::numeric_limits<float>::max())) {
          if (count.finite) count.bad_entry = c * entries + row + p;
          count.finite = false;
        }
        if (value < 0) {
          ++count.negatives;
          count.most_negative = std::min(count.most_negative, value);
        }
        entry[c] = count.finite ? static_cast<float>(value) : 0;
      }
    }
  }
  return count;
}

Findings findings_of(const HalfDiffTable& table, const std::vector<SliceCount>& counts) {
  Findings findings;
  std::uint64_t below_horizon = 0;
  for (const SliceCount& count : counts) {
    findings.hole_count += count.holes;
    below_horizon += count.below_horizon;
    findings.negative_count += count.negatives;
    findings.most_negative = std::min(findings.most_negative, count.most_negative);
  }
  findings.format = "MERL binary";
  findings.description = fmt::format("{} x {} x {} half/difference table", table.theta_h_count,
                                     table.theta_d_count, table.phi_d_count);
  findings.conventions = {"Values times 1/1500, 1.15/1500, 1.66/1500 are f_r in linear Rec. 709.",
                          "Entries stand for the centres of their cells; trilinear between them in (sqrt "
                          "theta_h, theta_d, phi_d).",
                          table.full_circle
                              ? "phi_d covers the full circle: 360 entries."
                              : "phi_d covers half the circle; the other half follows from reciprocity.",
                          fmt::format("{} of the holes lie below the horizon.", below_horizon)};
  findings.sample_count = table.entry_count();
  findings.theta_i_max = findings.theta_o_max = kHalfPi;
  return findings;
}

}  // namespace

bool looks_like_merl(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() < kHeaderBytes) return false;
  const auto sizes = header_of(bytes);
  return std::all_of(sizes.begin(), sizes.end(), [](std::int32_t n) { return n > 0 && n <= kMaxSize; });
}

MerlFile parse_merl(const FileBytes& file) {
  ByteReader reader(file);
  reader.require(kHeaderBytes, "MERL table sizes");
  const auto sizes = header_of(file.bytes);
  if (!looks_like_merl(file.bytes))
    reader.fail(fmt::format("three table sizes in [1, {}]", kMaxSize),
                fmt::format("{}, {}, {}", sizes[0], sizes[1], sizes[2]));
  MerlFile merl;
  HalfDiffTable& table = merl.table;
  table = {sizes[0], sizes[1], sizes[2], sizes[2] == 360, 3, {}};
  const std::size_t entries = table.entry_count(), expected = kHeaderBytes + entries * 3 * sizeof(double);
  if (file.bytes.size() != expected)
    reader.fail(fmt::format("{} bytes for {} x {} x {} x 3 values", expected, sizes[0], sizes[1], sizes[2]),
                fmt::format("{} bytes", file.bytes.size()));

  // Slices of theta_h are read in parallel, each with its own counts.
  table.values.resize(entries * 3);
  const std::byte* planes = file.bytes.data() + kHeaderBytes;
  std::vector<double> abs_cos_phi(static_cast<std::size_t>(sizes[2]));
  for (int p = 0; p < sizes[2]; ++p)
    abs_cos_phi[static_cast<std::size_t>(p)] = std::abs(std::cos(table.centre(0, 0, p).phi_d));
  std::vector<SliceCount> counts(static_cast<std::size_t>(sizes[0]));
  for_each_chunk(counts.size(), 1, [&](std::size_t h, std::size_t, std::size_t) {
    counts[h] = read_slice(planes, static_cast<int>(h), abs_cos_phi, table);
  });

  for (const SliceCount& count : counts)
    if (!count.finite) {
      reader.seek(kHeaderBytes + count.bad_entry * sizeof(double));
      reader.fail("a finite value above the horizon",
                  fmt::format("{}", read_double(planes + count.bad_entry * sizeof(double))));
    }
  merl.findings = findings_of(table, counts);
  return merl;
}

bool fits_merl(const HalfDiffTable& table) noexcept {
  const auto fits = [](int n) { return n > 0 && n <= kMaxSize; };
  return fits(table.theta_h_count) && fits(table.theta_d_count) && fits(table.phi_d_count) &&
         table.full_circle == (table.phi_d_count == 360) &&
         (table.channel_count == 1 || table.channel_count == 3);
}

std::string format_merl(const HalfDiffTable& table) {
  if (!fits_merl(table))
    throw Error(fmt::format(
        "MERL table: expected 1 or 3 channels and a full circle of 360 entries or half a circle of "
        "others, found {} channels and {} of {} entries",
        table.channel_count, table.full_circle ? "a circle" : "half a circle", table.phi_d_count));
  const std::array<std::int32_t, 3> sizes = {table.theta_h_count, table.theta_d_count, table.phi_d_count};
  const std::size_t entries = table.entry_count();
  std::string bytes(kHeaderBytes + entries * 3 * sizeof(double), '\0');
  std::memcpy(bytes.data(), sizes.data(), kHeaderBytes);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < entries; ++i) {
      const float f = table.values[i * table.channel_count + (table.channel_count == 3 ? c : 0)];
      const double value = std::isnan(f) ? -1 : static_cast<double>(f) / kScale[c];
      std::memcpy(bytes.data() + kHeaderBytes + (c * entries + i) * sizeof(double), &value, sizeof(value));
    }
  return bytes;
}

void write_merl(const std::filesystem::path& path, BrdfRef source) {
  if (source.channels() != 1 && source.channels() != 3)
    throw Error::in_file(path.string(), "grey or RGB for a MERL file",
                         fmt::format("{} channels", source.channels()));
  if (!source.isotropic())
    throw Error::in_file(path.string(), "an isotropic source for a MERL file", "an anisotropic one");
  write_then_rename(path, format_merl(tabulate_half_diff(SymmetrizedBrdf(source), 90, 90, 180, false)));
}

}  // namespace burnish
